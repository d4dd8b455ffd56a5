// The edges of a coarse complex and their cuts, which all polygons at an edge share.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "mesh/cells/edge_classes.h"
#include "mesh/cells/edge_gaps.h"
#include "mesh/cells/edge_grading.h"
#include "mesh/polygons/complex.h"

namespace radiosity {

/// An edge in the direction in which a polygon runs through it.
struct DirectedEdge {
  Index edge = kNone;
  bool reversed = false;
};

/// A polygon with four corners whose opposite sides may be cut alike: the edges of each side, in
/// the order of the loop, starting at corner 0.
struct FourSides {
  std::array<std::vector<DirectedEdge>, 4> edges;
  std::array<Index, 4> corners;
};

/// Every distinct edge (of loops and inner edges) of a complex, cut once for all polygons. Pieces
/// are equal, with two exceptions: beside narrow parts of polygons, and where a piece would be more
/// than three times as long as its neighbour along the outline of a polygon that cannot be a grid.
/// That would force flat triangles on it, so pieces grow by steps there. Opposite edges of
/// four-sided polygons are cut alike, so that these can become grids.
class EdgeCuts {
 public:
  explicit EdgeCuts(const CoarseComplex& complex);

  /// Cuts edges into pieces no longer than `size`, or as near to it as possible. An edge at a sharp
  /// corner gets fewer pieces if its first point would lie on the other edge (within the
  /// coincidence). Throws InputError if that makes more than kMostPatches pieces. After
  /// findOpposites(), edges are also cut opposite of vertices across parts of a polygon narrower
  /// than a quarter of the size: patches then go straight across instead of fanning out to far
  /// points. Such cuts keep a distance of `spacing` times the width there.
  void cut(double size, Rounding rounding, double spacing);

  /// Finds the vertices opposite of each edge across narrow parts of polygons that are no grids,
  /// for sizes up to `largest`.
  void findOpposites(double largest);
  bool hasOpposites() const;

  /// Keeps the edges of a polygon whole in later cuts.
  void keepWhole(std::size_t polygon);

  /// Whether the current cut leaves all edges of a polygon whole, inner ones included.
  bool isUncut(std::size_t polygon) const;

  /// A point of the current cut. Ids below the number of the complex's vertices are these vertices,
  /// the others are points inside edges.
  Vec3 point(Index id) const;
  std::size_t pointCount() const { return complex_.vertices.size() + edge_points_.size(); }

  /// Appends the ids of the points of a directed edge, its first end included, its last end not.
  void append(DirectedEdge edge, std::vector<Index>& ids) const;

  /// The edges of loop `loop` of polygon `polygon`, in order.
  std::span<const DirectedEdge> loop(std::size_t polygon, std::size_t loop) const {
    return loops_[polygon][loop];
  }
  DirectedEdge find(Index from, Index to) const;
  Index lastOf(DirectedEdge e) const { return ends_[e.edge][e.reversed ? 0 : 1]; }

  /// Set if the polygon is a convex quadrilateral with nearly equal opposite sides, without holes
  /// or inner edges.
  const std::optional<FourSides>& fourSides(std::size_t polygon) const {
    return four_sides_[polygon];
  }

 private:
  DirectedEdge add(Index from, Index to);
  void joinOpposite(const FourSides& sides);
  void limitAtSharpCorners();
  void lowerCoincidence(std::size_t polygon);
  void noteGaps(DirectedEdge edge, const std::vector<Gap>& gaps);
  std::vector<double> stopsFor(Index cls, double size, double spacing) const;
  void countPieces(Rounding rounding);
  bool isGrid(std::size_t polygon) const;
  void gradeTowardsShortPieces(Rounding rounding);
  void wantAtEnd(DirectedEdge edge, bool at_last, double size);

  const CoarseComplex& complex_;
  std::unordered_map<std::uint64_t, Index> index_;
  std::vector<std::array<Index, 2>> ends_;  ///< lower vertex first
  std::vector<double> length_;
  std::vector<double> coincidence_;        ///< by edge
  std::vector<double> class_coincidence_;  ///< by class, the least of its edges'
  std::vector<std::vector<std::vector<DirectedEdge>>> loops_;  ///< polygon, loop
  std::vector<std::optional<FourSides>> four_sides_;
  EdgeClasses classes_{{}};
  std::vector<EdgeSize> wanted_;  ///< by class
  struct Opposite {
    double place;  ///< as a share of the length, in the direction of the class
    double gap;    ///< metres, at the longest edge of the class
  };
  std::vector<std::vector<Opposite>> opposites_;  ///< by class, narrowest first
  std::vector<double> least_start_;  ///< by class: first piece at a sharp corner, metres
  std::vector<char> whole_;          ///< by edge: never cut
  std::vector<std::size_t> pieces_;
  std::vector<std::size_t> first_point_;  ///< edge -> into edge_points_
  std::vector<Vec3> edge_points_;
};

}  // namespace radiosity
