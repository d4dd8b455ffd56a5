// The vector kernels of partial visibility: every instruction set against the scalar twin, bit for
// bit, and the twin against the exact clipper, which shares nothing with it but the formula.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "formfactor/aligned_buffer.h"
#include "formfactor/exact/clip_kernels.h"
#include "formfactor/exact/visible_part.h"
#include "occluder_builder.h"
#include "simd_targets.h"

namespace radiosity {
namespace {

template <class Check>
int forEveryTarget(const Check& check) {
  return test::onEveryTarget(simdClipKernels, check);
}

constexpr std::size_t kLanes = 256;

/// An eye below, targets above it, one body between: everything random, some of it degenerate.
struct Arena {
  Vec3 eye;
  Vec3 normal;
  std::vector<std::vector<Vec3>> targets;
  Occluder body;
  BlockingCone cone;
};

Arena randomSetup(std::uint64_t seed, double size, bool with_faces) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&](double reach) {
    return reach * Vec3(uniform(random), uniform(random), uniform(random));
  };
  Arena setup;
  setup.eye = vector(0.1);
  setup.normal = glm::normalize(Vec3(0.2 * uniform(random), 0.2 * uniform(random), 1));
  // A turned box; or one along the axes, whose edges are those of the targets' own directions.
  const bool turned = seed % 2 == 0;
  const Vec3 u = turned ? Vec3(0.3, 0.1, 0) : Vec3(0.3, 0, 0);
  const Vec3 v = turned ? Vec3(-0.1, 0.3, 0) : Vec3(0, 0.3, 0);
  setup.body = seed % 3 == 0 ? test::flatRectangle(Vec3(-0.1, -0.2, 0.5), u, v)
                             : test::boxOccluder(Vec3(-0.1, -0.2, 0.4), u, v, Vec3(0, 0, 0.3));
  EXPECT_TRUE(blockingCone(setup.body, setup.eye, with_faces, setup.cone));
  while (setup.targets.size() < kLanes) {
    const Vec3 low(uniform(random), uniform(random), 0.9 + 0.1 * uniform(random));
    const Vec3 a = turned ? size * Vec3(1, 0.1 * uniform(random), 0) : size * Vec3(1, 0, 0);
    const Vec3 b = turned ? size * Vec3(0, 1, 0.1 * uniform(random)) : size * Vec3(0, 1, 0);
    std::vector<Vec3> outline = {low, low + b, low + a + b, low + a};
    if (setup.targets.size() % 5 == 0) outline[2] = outline[3];  // a triangle
    setup.targets.push_back(outline);
  }
  return setup;
}

/// The arrays of a Arena.
template <class T>
struct Lanes {
  explicit Lanes(const Arena& setup) {
    for (AlignedBuffer<T>& row : rows) row.reserve(kLanes);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::vector<Vec3>& outline = setup.targets[lane];
      const Vec3 middle = 0.25 * (outline[0] + outline[1] + outline[2] + outline[3]);
      for (int axis = 0; axis < 3; ++axis) {
        rows[std::size_t(axis)].data()[lane] = T(middle[axis]);
        for (std::size_t k = 0; k < 4; ++k) {
          rows[3 + 3 * k + std::size_t(axis)].data()[lane] = T(outline[k][axis] - middle[axis]);
        }
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      targets.middle[axis] = rows[axis].data();
      for (std::size_t k = 0; k < 4; ++k) targets.corner[k][axis] = rows[3 + 3 * k + axis].data();
      eye.position[axis] = T(setup.eye[int(axis)]);
      eye.normal[axis] = T(setup.normal[int(axis)]);
    }
    targets.corners = 4;
    targets.count = kLanes;
    for (std::size_t k = 0; k < setup.cone.planes.size(); ++k) {
      const ClipPlane& plane = setup.cone.planes[k];
      const double length = glm::length(plane.normal);
      const Vec3 n = plane.normal / length;
      planes.push_back(
          {{T(n.x), T(n.y), T(n.z)}, T(plane.offset / length), std::uint32_t(12345 + 7919 * k)});
    }
    whole.reserve(kLanes);
    hidden.reserve(kLanes);
    shape.reserve(kLanes);
    cut_low.reserve(kLanes);
    cut_high.reserve(kLanes);
  }
  void run(const ClipKernels<T>& kernels) {
    kernels.whole(targets, eye, whole.data());
    kernels.hidden(targets, eye, planes.data(), planes.size(),
                   {hidden.data(), shape.data(), cut_low.data(), cut_high.data()});
  }
  std::array<AlignedBuffer<T>, 15> rows;
  TargetLanes<T> targets;
  EyePoint<T> eye;
  std::vector<ConePlane<T>> planes;
  AlignedBuffer<T> whole;
  AlignedBuffer<T> hidden;
  AlignedBuffer<ShapeWord<T>> shape;
  AlignedBuffer<ShapeWord<T>> cut_low;
  AlignedBuffer<ShapeWord<T>> cut_high;
};

template <class T>
const ClipKernels<T>& of(const ClipKernelSet& set) {
  if constexpr (sizeof(T) == 4) {
    return set.single;
  } else {
    return set.exact;
  }
}

template <class T>
void expectSameBits(const Arena& setup, const ClipKernelSet& kernels) {
  Lanes<T> expected(setup);
  expected.run(of<T>(scalarClipKernels()));
  Lanes<T> found(setup);
  found.run(of<T>(kernels));
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    ASSERT_EQ(std::bit_cast<ShapeWord<T>>(expected.whole.data()[lane]),
              std::bit_cast<ShapeWord<T>>(found.whole.data()[lane]));
    ASSERT_EQ(std::bit_cast<ShapeWord<T>>(expected.hidden.data()[lane]),
              std::bit_cast<ShapeWord<T>>(found.hidden.data()[lane]));
    ASSERT_EQ(expected.shape.data()[lane], found.shape.data()[lane]);
  }
}

TEST(ClipKernels, EveryTargetAgreesToTheBit) {
  const int targets = forEveryTarget([](const ClipKernelSet& kernels) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const Arena setup = randomSetup(seed, seed % 4 == 0 ? 0.5 : 0.03, seed % 5 == 0);
      expectSameBits<float>(setup, kernels);
      expectSameBits<double>(setup, kernels);
    }
  });
  EXPECT_GE(targets, 1);
}

/// Against VisiblePart, lane by lane: errors relative to the whole polygon's form factor.
template <class T>
void expectAccurate(double size, double tolerance) {
  std::size_t cut = 0;
  std::size_t all = 0;
  VisiblePart exact;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const bool with_faces = seed % 5 == 0;
    const Arena setup = randomSetup(seed, size, with_faces);
    Lanes<T> lanes(setup);
    lanes.run(of<T>(scalarClipKernels()));
    const std::vector<Blocker> blocker = {{&setup.body, 0, with_faces}};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      std::vector<Vec3> outline = setup.targets[lane];
      if (outline[2] == outline[3]) outline.pop_back();
      const PointView view = exact.look(setup.eye, setup.normal, outline, blocker, Vec2(0.5));
      const double whole = double(lanes.whole.data()[lane]);
      const double hidden = double(lanes.hidden.data()[lane]);
      ASSERT_NEAR(whole, view.whole, tolerance * view.whole) << seed << ' ' << lane;
      const double visible = hidden == kHiddenWhole ? 0 : whole - hidden;
      ASSERT_NEAR(visible, view.visible, tolerance * view.whole) << seed << ' ' << lane;
      all += hidden == kHiddenWhole;
      cut += view.visible > 0.01 * view.whole && view.visible < 0.99 * view.whole;
      // A shape is given where the cone's edge is seen before the polygon, and only there.
      if (visible > 1e-3 * whole && visible < 0.999 * whole) {
        ASSERT_NE(lanes.shape.data()[lane], 0u);
      }
      if (hidden == kHiddenWhole || hidden == 0) {
        ASSERT_EQ(lanes.shape.data()[lane], 0u);
      }
    }
  }
  EXPECT_GT(cut, 100u);
  if (size < 0.1) {
    EXPECT_GT(all, 100u);
  }
}

TEST(ClipKernels, SinglePrecisionKeepsItsAccuracy) {
  // The header's 2e-6 r/h, at r about 1.5.
  expectAccurate<float>(0.5, 6e-6);
  expectAccurate<float>(0.1, 3e-5);
  expectAccurate<float>(0.01, 3e-4);
}

TEST(ClipKernels, DoublePrecisionKeepsItsAccuracy) {
  expectAccurate<double>(0.5, 3e-14);
  expectAccurate<double>(0.1, 1.5e-13);
  expectAccurate<double>(0.01, 1.5e-12);
}

}  // namespace
}  // namespace radiosity
