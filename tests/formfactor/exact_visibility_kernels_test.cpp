// The kernels of visibility on every instruction set, against their definition.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "support/simd_targets.h"
#include "visibility/shadows/kernels.h"

namespace radiosity {
namespace {

template <class Check>
void forEveryVisibilityTarget(const Check& check) {
  test::onEveryTarget([] { return visibilityKernels(true); }, check);
}

/// How many corners are `bound` or more above a plane, and how many are more.
struct Heights {
  int reach = 0;
  int exceed = 0;
  Heights(const ShadowPlane& p, const ShapeCorners& shape, double bound) {
    for (std::size_t k = 0; k < 4; ++k) {
      const double height = p.x * shape.x[k] + p.y * shape.y[k] + p.z * shape.z[k] - p.offset;
      reach += height >= bound ? 1 : 0;
      exceed += height > bound ? 1 : 0;
    }
  }
};

TEST(ExactVisibilityKernels, EveryInstructionSetAnswersByTheDefinition) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr std::size_t kPlanes = 23;
  std::vector<ShadowPlane> planes(kPlanes);
  std::size_t found = 0;
  for (int round = 0; round < 3000; ++round) {
    for (ShadowPlane& plane : planes) {
      plane = {unit(random), unit(random), unit(random), unit(random)};
    }
    ShapeCorners shape{};
    for (std::size_t k = 0; k < 4; ++k) {
      shape.x[k] = unit(random);
      shape.y[k] = unit(random);
      shape.z[k] = unit(random);
    }
    const std::uint64_t bits = ((std::uint64_t(random()) << 32) | random()) & ((1u << kPlanes) - 1);
    // The bound is one corner's very height, so that a difference of one bit shows.
    const ShadowPlane& p = planes[std::size_t(round) % kPlanes];
    const double bound = p.x * shape.x[1] + p.y * shape.y[1] + p.z * shape.z[1] - p.offset;
    const std::size_t start = std::size_t(round) % kPlanes;
    std::uint64_t below = 0;
    std::size_t above = kPlaneBits;
    for (std::size_t k = 0; k < kPlanes && above == kPlaneBits; ++k) {
      if ((bits >> k & 1) == 0) continue;
      const Heights heights(planes[k], shape, bound);
      if (heights.reach == 4) above = k;
      if (heights.reach == 0) below |= std::uint64_t(1) << k;
    }
    std::size_t crossed = kPlanes;
    for (std::size_t n = 0; n < kPlanes && crossed == kPlanes; ++n) {
      const std::size_t k = (start + n) % kPlanes;
      if (Heights(planes[k], shape, bound).exceed > 0) crossed = k;
    }
    found += above != kPlaneBits;
    forEveryVisibilityTarget([&](const VisibilityKernels& kernels) {
      std::uint64_t its_below = 0;
      EXPECT_EQ(kernels.findAbove(planes.data(), bits, shape, bound, its_below), above);
      EXPECT_EQ(its_below, below);
      EXPECT_EQ(kernels.findCrossed(planes.data(), kPlanes, start, shape, bound), crossed);
    });
    if (HasFailure()) return;
  }
  EXPECT_GT(found, 300u);
}

}  // namespace
}  // namespace radiosity
