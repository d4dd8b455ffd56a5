// Occluders by place: finds those that may reach into the space between two spheres.
#pragma once

#include <limits>
#include <vector>

#include "radiosity/base.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

struct Sphere {
  Vec3 centre{0.0};
  double radius = 0;
};

/// The convex hull of two spheres.
class SphereHull {
 public:
  SphereHull(const Sphere& a, const Sphere& b);
  bool meets(const Sphere& ball) const;

 private:
  Vec3 start_, axis_;
  double radius_, slope_;  ///< at the start, and its growth towards the end
  double square_ = 0;      ///< of the axis; 0: one sphere holds the other, radius_ is the larger's
  double inverse_square_ = 0, tilt_ = 0;
};

/// A half-space dot(normal, x) > offset.
struct HalfSpace {
  Vec3 normal{0.0};
  double offset = 0;
};

/// A half-space that holds everything.
inline constexpr HalfSpace kAnywhere{{0.0, 0.0, 0.0}, -1.0};

/// A binary tree of bounding spheres.
class OccluderTree {
 public:
  explicit OccluderTree(const std::vector<Occluder>& occluders);

  /// Appends the occluders that may reach into the hull of two spheres on the fronts of two planes;
  /// not sorted. Adds the spheres looked at to `tests`. Ends once more than `most` are found.
  void query(const Sphere& a, const Sphere& b, const HalfSpace& front_of_a,
             const HalfSpace& front_of_b, std::vector<Index>& found, std::size_t& tests,
             std::size_t most = std::numeric_limits<std::size_t>::max()) const;

 private:
  struct Node {
    Sphere bound;
    Index first = 0;  ///< child (the second follows it), or into order_
    Index count = 0;  ///< occluders of a leaf; 0: inner node
  };
  void build(Index node, Index first, Index count);

  const std::vector<Occluder>& occluders_;
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

}  // namespace radiosity
