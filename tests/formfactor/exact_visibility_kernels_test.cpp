// Every instruction set gives the scalar twin's bits.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "formfactor/exact/visibility/kernels.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

template <class Check>
int forEveryTarget(const Check& check) {
  return test::onEveryTarget(simdVisibilityKernels, check);
}

TEST(ExactVisibilityKernels, TargetsAgreeWithTheScalarTwin) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr std::size_t kPlanes = 23;
  std::vector<ShadowPlane> planes(kPlanes);
  const VisibilityKernels scalar = scalarVisibilityKernels();
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
    const std::size_t above = scalar.findAbove(planes.data(), bits, shape, bound, below);
    const std::size_t crossed = scalar.findCrossed(planes.data(), kPlanes, start, shape, bound);
    found += above != kPlaneBits;
    forEveryTarget([&](const VisibilityKernels& kernels) {
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
