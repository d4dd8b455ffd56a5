// How far shadows move across one element of a pair while the other one is crossed.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/geometry/plane_frame.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

/// A value for each end of a pair.
struct BothEnds {
  double row = 0, column = 0;
};

/// How far the edges of shadows move across the far element, in its sizes, from end to end of the
/// near one, which is sampled: by similar triangles with their tips on the occluders' edges, for
/// the edge for which this is most. What counts is the elements' widths across the plane of an edge
/// and the eye: between the slats of a blind, or past a row of columns, shadows of edges that are
/// parallel to long and narrow elements come and go within a fraction of the way that the elements'
/// lengths suggest. Holds scratch memory: one a thread.
class ShadowChange {
 public:
  explicit ShadowChange(const ElementSet& elements) : elements_(elements) {}

  /// Begins with the next pair.
  void begin(Index row, Index column);
  /// `distance2`: squares of the distances of the centroids from the body's nearest edge.
  void add(const Occluder& body, const BothEnds& distance2);
  /// The square of the change with the points on one end or the other.
  BothEnds squared() const { return {row_ * row_, column_ * column_}; }

 private:
  /// A point along the line from centroid to centroid: `depth` from the row's.
  struct Seen {
    Vec2 across{0.0};
    double depth = 0;
  };
  /// An element about its centroid, across that line.
  struct Outline {
    std::array<Vec2, 4> corners;
    std::size_t count = 0;
    double radius = 0;
    /// Half of its width in a direction, times the direction's length.
    double width(const Vec2& direction) const;
  };
  /// The largest values of an edge's change with the points on one end or the other, and of the
  /// quotient of the elements' widths over that of their radii.
  struct EdgeChanges {
    BothEnds moved;
    BothEnds narrow{1, 1};
  };
  Seen see(const Vec3& p) const;
  Outline outlineOf(Index element) const;
  void addEdge(const Seen& from, const Seen& to, EdgeChanges& most) const;

  const ElementSet& elements_;
  PlaneFrame frame_;  ///< across the line
  double length_ = 0;
  Outline of_row_, of_column_;
  std::vector<Seen> corners_;  ///< of a body
  double row_ = 0, column_ = 0;
};

}  // namespace radiosity
