// The edges of a coarse complex and where they are cut: once for all polygons that share them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "mesh/complex.h"
#include "mesh/union_find.h"

namespace radiosity {

/// An edge as a polygon runs through it.
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

/// Every distinct edge (of loops and inner edges) of a complex. cut() divides each into equal
/// pieces. Opposite edges of four-sided polygons get the same number of pieces, so that these
/// polygons can become grids.
class EdgeCuts {
 public:
  explicit EdgeCuts(const CoarseComplex& complex);

  /// Pieces no longer than `size` (ceil) or as near to `size` as can be (round). Throws InputError
  /// where that makes more than kMostPatches pieces.
  enum class Rounding { at_most, nearest };
  void cut(double size, Rounding rounding);

  /// Points of the current cut: ids below vertexCount() are the complex's vertices, the others are
  /// points inside edges.
  Vec3 point(Index id) const;
  std::size_t pointCount() const { return complex_.vertices.size() + edge_points_.size(); }
  std::span<const Vec3> edgePoints() const { return edge_points_; }

  /// Appends the ids of the points of a directed edge, its first end included, its last end not.
  void append(DirectedEdge edge, std::vector<Index>& ids) const;

  /// The edges of loop `loop` of polygon `polygon`, in order.
  std::span<const DirectedEdge> loop(std::size_t polygon, std::size_t loop) const {
    return loops_[polygon][loop];
  }
  DirectedEdge find(Index from, Index to) const;
  Index lastOf(DirectedEdge e) const { return ends_[e.edge][e.reversed ? 0 : 1]; }
  std::size_t pieces(Index edge) const { return pieces_[edge]; }
  double length(Index edge) const { return length_[edge]; }

  /// Set where the polygon is a convex quadrilateral, opposite sides nearly alike, without holes
  /// or inner edges.
  const std::optional<FourSides>& fourSides(std::size_t polygon) const {
    return four_sides_[polygon];
  }

 private:
  DirectedEdge add(Index from, Index to);
  void join(Index a, Index b);
  void joinOpposite(const FourSides& sides);

  const CoarseComplex& complex_;
  std::unordered_map<std::uint64_t, Index> index_;
  std::vector<std::array<Index, 2>> ends_;  ///< lower vertex first
  std::vector<double> length_;
  std::vector<std::vector<std::vector<DirectedEdge>>> loops_;  ///< polygon, loop
  std::vector<std::optional<FourSides>> four_sides_;
  UnionFind classes_{0};                ///< edges that are cut alike
  std::vector<double> class_shortest_;  ///< of a class's root
  std::vector<double> class_longest_;
  std::vector<std::size_t> pieces_;
  std::vector<std::size_t> first_point_;  ///< edge -> into edge_points_
  std::vector<Vec3> edge_points_;
};

/// More patches than this are refused: their indices and form factors could not be handled.
inline constexpr double kMostPatches = 20e6;

}  // namespace radiosity
