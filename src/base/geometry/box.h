// Boxes along the axes, in the plane and in space.
#pragma once

#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "radiosity/base.h"

namespace radiosity {

/// Empty until something is added: then both ends are infinite, the wrong way round. Ends belong to
/// the box.
template <class Vec>
struct BoxOf {
  static constexpr glm::length_t kAxes = Vec::length();

  Vec low{std::numeric_limits<double>::infinity()};
  Vec high{-std::numeric_limits<double>::infinity()};

  void add(const Vec& p) {
    for (glm::length_t k = 0; k < kAxes; ++k) {
      if (p[k] < low[k]) low[k] = p[k];
      if (p[k] > high[k]) high[k] = p[k];
    }
  }
  void add(const BoxOf& other) {
    add(other.low);
    add(other.high);
  }
  Vec size() const { return high - low; }
  Vec centre() const { return 0.5 * (low + high); }
  double diagonal() const { return glm::length(size()); }
  /// The axis of the longest side; of sides of one length the first.
  int longestAxis() const {
    const Vec sides = size();
    int longest = 0;
    for (int k = 1; k < kAxes; ++k) {
      if (sides[k] > sides[longest]) longest = k;
    }
    return longest;
  }
  /// The point at a share of each side, from the low end.
  Vec at(const Vec& share) const { return low + share * size(); }
  BoxOf grown(double by) const { return {low - Vec(by), high + Vec(by)}; }
  bool contains(const Vec& p) const { return meets({p, p}); }
  bool meets(const BoxOf& other) const {
    for (glm::length_t k = 0; k < kAxes; ++k) {
      if (!(low[k] <= other.high[k] && high[k] >= other.low[k])) return false;
    }
    return true;
  }
};

using Box2 = BoxOf<Vec2>;
using Box3 = BoxOf<Vec3>;

/// The box of some points; the box of the origin if there are none.
inline Box3 boxOf(std::span<const Vec3> points) {
  if (points.empty()) return {Vec3(0.0), Vec3(0.0)};
  Box3 box;
  for (const Vec3& p : points) box.add(p);
  return box;
}

}  // namespace radiosity
