// Finds the nearest point of a surface that faces a given way.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/geometry/box.h"
#include "radiosity/base.h"

namespace radiosity {

struct NearestPoint {
  std::size_t triangle = 0;
  Vec3 weights{0.0};  ///< barycentric
  double distance = 0;
};

/// Barycentric weights of the point of triangle abc nearest to p, by the region of the plane p
/// projects into (Ericson, "Real-Time Collision Detection", 2005, section 5.1.5).
Vec3 nearestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// A tree of boxes over triangles (median splits).
class SurfaceIndex {
 public:
  /// Keeps both by reference.
  SurfaceIndex(std::span<const Vec3> vertices, std::span<const std::array<Index, 3>> triangles);

  static constexpr double kFacingAlike = 0.5;  ///< the cosine of 60 degrees

  /// The nearest point within `reach` of a triangle whose normal's cosine with `normal` is
  /// `least_cosine` or more. Of equally near points it is that of the first triangle.
  std::optional<NearestPoint> nearest(const Vec3& point, const Vec3& normal, double reach,
                                      double least_cosine = kFacingAlike) const;

 private:
  struct Node {
    Box3 box;
    std::uint32_t begin =
        0;  ///< leaf: into order_; inner node: its second child (the first is next)
    std::uint32_t count = 0;  ///< 0: inner node
  };

  void build(std::size_t begin, std::size_t end);
  double distance2(const Node& node, const Vec3& point) const;
  std::array<Vec3, 3> cornersOf(std::size_t triangle) const;

  std::span<const Vec3> vertices_;
  std::span<const std::array<Index, 3>> triangles_;
  std::vector<Vec3> normal_;  ///< unit; 0 for a degenerate triangle
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace radiosity
