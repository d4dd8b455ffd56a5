// The inner loops of visibility, behind plain pointers: one set per instruction set, Highway's
// scalar target among them. Every set gives the same bits: the kernels only add, multiply and
// compare, and nothing is contracted to a fused multiply-add.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "radiosity/base.h"

namespace radiosity {

/// Four corners of a planar convex shape (a triangle's fourth repeats its third), by coordinate.
struct ShapeCorners {
  std::array<double, 4> x, y, z;
  Vec3 at(std::size_t k) const { return {x[k], y[k], z[k]}; }
};

/// Height of a point: x p.x + y p.y + z p.z - offset.
struct ShadowPlane {
  double x, y, z, offset;
};

inline constexpr std::size_t kPlaneBits = 64;

struct VisibilityKernels {
  std::string target;  ///< instruction set, by Highway's name
  /// The first of the planes whose bits are set that all corners are `least` or more above;
  /// kPlaneBits if there is none. `below` gets the bits of those looked at that no corner reaches.
  std::size_t (*findAbove)(const ShadowPlane* planes, std::uint64_t bits, const ShapeCorners& shape,
                           double least, std::uint64_t& below);
  /// The first of `count` planes that some corner is more than `most` above, beginning with plane
  /// `start` (below count) and going round; `count` if there is none.
  std::size_t (*findCrossed)(const ShadowPlane* planes, std::size_t count, std::size_t start,
                             const ShapeCorners& shape, double most);
};

/// The best instruction set of this machine; `simd` false: Highway's scalar target, the same bits.
VisibilityKernels visibilityKernels(bool simd);

}  // namespace radiosity
