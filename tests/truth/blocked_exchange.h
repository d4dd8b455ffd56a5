// How much of an exchange area blockers take away.
#pragma once

#include <cstddef>
#include <vector>

#include "shaft.h"

namespace radiosity::truth {

struct BlockedExchange {
  double blocked = 0;  ///< m^2; 0 <= blocked <= the unoccluded exchange area
  /// The difference of two embedded rules, well above the true error, and the possible miss of
  /// triangles that looked clear or hidden without proof; m^2.
  double error = 0;
  std::size_t points = 0;  ///< points looked from
  bool clear = false;      ///< no blocker seen to touch the exchange
  bool hidden = false;     ///< nothing of the target seen from any point
};

/// Integral over `source` of the blocked part of the form factor to `target`, both convex. The
/// source is cut along the critical lines; on each cell, as triangles, Gauss rules with 4 x 4 and
/// 6 x 6 points are set against each other, and the worst triangle is halved until the errors sum
/// to less than `tolerance` (m^2) or `most_points` were looked from. Triangles that no blocker can
/// touch cost nothing.
BlockedExchange blockedExchange(const Sheet& source, const Sheet& target,
                                const std::vector<const Blocker*>& blockers, double coincidence,
                                double tolerance, std::size_t most_points);

/// Whether one single blocker cuts every line from `a` to `b`: it does if it cuts those between
/// corners, as the shadow of a convex blocker is convex.
bool hiddenByOne(const Sheet& a, const Sheet& b, const std::vector<const Blocker*>& blockers);

}  // namespace radiosity::truth
