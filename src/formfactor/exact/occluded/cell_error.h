// Estimates the error of a cell's mean from the values at its points.
#pragma once

#include <array>
#include <cstddef>

#include "formfactor/exact/occluded/cell_rule.h"

namespace radiosity {

/// Values of one target at the points of a cell.
struct CellValues {
  /// Visible minus fraction times whole form factor, by which the visible fraction's error is
  /// measured.
  std::array<double, SamplePoints::kMost> residual;
  std::size_t count = 0;
  double whole = 0;           ///< mean of the whole form factor
  double fraction = 0;        ///< visible share of it
  double side = 1;            ///< of the cell, in the sampled element's
  double change = 0;          ///< see changeIn
  bool may_cross = false;     ///< see SampledPair: shadows may end in a step
  bool one_shape = true;      ///< all points see shadows bounded by the same edges
  bool one_occluder = false;  ///< one alone comes between

  /// All points see nearly the same fraction, or all see everything or nothing, however much the
  /// whole form factor changes next to the target: a shadow's edge may have slipped between them.
  bool flat() const;
  /// Error of the mean as far as the values' differences show it.
  double seen() const;
  /// Error from edges of shadows that may have slipped between the points.
  double unseen() const;
};

/// How far shadows move across the target, in its sizes, while a cell `level` halvings below the
/// sampled element is crossed, from `change` for the whole of it (SampledPair): at most
/// kMostChange, for shadows that come and go faster are steps, seen or missed alike. Times the root
/// of the cell's share of the way: the chance that a kink is within it falls with its side.
double changeIn(int level, double change);

/// Estimates of the root mean square error of a cell's mean residual, from 4 or 9 points.
struct CellError {
  double cautious = 0;  ///< decides whether the cell is cut; one that is kept is not seen again
  double stated = 0;    ///< added to the error figures by a cell that is kept
};

/// Gauss points see a smooth integrand far better than any tolerance. They do not see a kink, where
/// an edge of a shadow passes a corner of the target. Its size goes with how much the
/// values change from point to point (2 x 2) or how much that changes (3 x 3), and, seen or not,
/// with how far shadows move across the target.
///
/// The cautious estimate is linear in that. The stated one tells more cells apart. A kink is weak
/// where shadows move little: an edge that reaches a corner turned against the target's sides
/// changes the slope only while it goes on, so that errors go with something between the movement
/// and its square. And a cell is flat for two reasons: nothing of a shadow is seen, which may have
/// slipped between the points; or all points see the edge of the one shadow there is well inside
/// the target, and it hardly moves.
///
/// The constants (error_model.h) are refitted and scored by tests/bench/error_model.py.
CellError meanError(const CellValues& values);

/// Better estimates than the `guessed` ones, once the points near the corners were looked from:
/// `residual` is the largest of theirs.
CellError meanErrorOutside(const CellError& guessed, double residual);

}  // namespace radiosity
