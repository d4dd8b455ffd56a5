// The vector kernels of the visibility of occluded pairs: the same bits on every instruction set,
// and the scalar target against the exact clipper, which shares nothing with it but the formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "base/aligned_buffer.h"
#include "formfactor/exact/error_model.h"
#include "formfactor/exact/occluded/target_rows.h"
#include "occluder_builder.h"
#include "support/simd_targets.h"
#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/visible_part.h"

namespace radiosity {
namespace {

template <class Check>
void forEveryClipTarget(const Check& check) {
  test::onEveryTarget([] { return clipKernels(true); }, check);
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

GroupTarget groupTarget(const std::vector<Vec3>& outline) {
  const Vec3 middle = 0.25 * (outline[0] + outline[1] + outline[2] + outline[3]);
  const auto corner = [&](std::size_t k) { return outline[k]; };
  GroupTarget target;
  const Vec3 normal = glm::normalize(vectorArea(outline.size(), corner));
  target.setOutline(outline, makeFrame(middle, normal, axisAcross(normal)));
  return target;
}

/// The arrays of an Arena, and the kernels' results.
template <class T>
struct Lanes {
  explicit Lanes(const Arena& setup) {
    std::vector<GroupTarget> targets;
    targets.reserve(setup.targets.size());
    for (const std::vector<Vec3>& outline : setup.targets) targets.push_back(groupTarget(outline));
    std::vector<const GroupTarget*> pointers;
    pointers.reserve(targets.size());
    for (const GroupTarget& one : targets) pointers.push_back(&one);
    rows.fill(pointers, Vec3(0.0));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      eye.position[axis] = T(setup.eye[int(axis)]);
      eye.normal[axis] = T(setup.normal[int(axis)]);
    }
    addPlane({Vec3(0.0), 1}, 0);
    addPlane({Vec3(0.0), -1}, 0);
    for (std::size_t k = 0; k < setup.cone.planes.size(); ++k) {
      const ClipPlane& side = setup.cone.planes[k];
      const double length = glm::length(side.normal);
      addPlane({side.normal / length, side.offset / length}, std::uint32_t(12345 + 7919 * k));
    }
    label.resize(label.size() + kMostPlanes);
    for (AlignedBuffer<LaneIndex<T>>* buffer : {&target, &eyes, &first, &count}) {
      buffer->reserve(kLanes);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // Any order will do.
      target.data()[lane] = LaneIndex<T>(kLanes - 1 - lane);
      eyes.data()[lane] = 0;
      first.data()[lane] = 2;
      count.data()[lane] = LaneIndex<T>(setup.cone.planes.size());
    }
    whole.reserve(kLanes);
    hidden.reserve(kLanes);
    common.reserve(kLanes);
    shape.reserve(kLanes);
    cut_low.reserve(kLanes);
    cut_high.reserve(kLanes);
  }
  void addPlane(const ClipPlane& p, std::uint32_t name) {
    plane[0].push_back(T(p.normal.x));
    plane[1].push_back(T(p.normal.y));
    plane[2].push_back(T(p.normal.z));
    plane[3].push_back(T(p.offset));
    label.push_back(name);
  }
  void run(const ClipFunctions<T>& clip) {
    clip.whole(rows.lanes(), eye, whole.data());
    const EyePoints<T> points = {{eye.position, eye.position + 1, eye.position + 2},
                                 {eye.normal[0], eye.normal[1], eye.normal[2]}};
    const ConePlanes<T> planes = {
        {plane[0].data(), plane[1].data(), plane[2].data()}, plane[3].data(), label.data()};
    const ClipItems<T> items = {kLanes, target.data(), eyes.data()};
    clip.hidden(rows.lanes(), points, planes, items, first.data(), count.data(),
                {hidden.data(), shape.data(), cut_low.data(), cut_high.data()});
    // The same planes, named one by one.
    std::vector<AlignedBuffer<LaneIndex<T>>> own(plane[0].size() - 2);
    std::vector<const LaneIndex<T>*> names;
    for (std::size_t p = 0; p < own.size(); ++p) {
      own[p].reserve(kLanes);
      std::fill_n(own[p].data(), kLanes, LaneIndex<T>(p + 2));
      names.push_back(own[p].data());
    }
    clip.common(rows.lanes(), points, planes, items, names.data(), count.data(), common.data());
    for (std::size_t lane = 0; lane < kLanes; ++lane) parts.push_back(quarters(clip, lane));
  }
  /// A target's form factor from its triangles about the middle: its own edges, and inner edges
  /// that cancel.
  T quarters(const ClipFunctions<T>& clip, std::size_t lane) {
    const TargetLanes<T>& all = rows.lanes();
    std::array<AlignedBuffer<T>, 4> edges;
    for (AlignedBuffer<T>& row : edges) {
      row.reserve(kLaneAlignment);
      std::fill_n(row.data(), kLaneAlignment, T(0));
    }
    std::size_t next = 0;
    const auto add = [&](T u0, T v0, T u1, T v1) {
      edges[0].data()[next] = u0;
      edges[1].data()[next] = v0;
      edges[2].data()[next] = u1;
      edges[3].data()[next++] = v1;
    };
    for (std::size_t k = 0; k < all.corners; ++k) {
      const std::size_t m = (k + 1) % all.corners;
      const T u0 = all.corner[k][0][lane];
      const T v0 = all.corner[k][1][lane];
      const T u1 = all.corner[m][0][lane];
      const T v1 = all.corner[m][1][lane];
      add(u0, v0, u1, v1);
      add(u1, v1, 0, 0);
      add(0, 0, u0, v0);
    }
    return clip.parts(
        all, lane, eye,
        {kLaneAlignment, {edges[0].data(), edges[1].data()}, {edges[2].data(), edges[3].data()}});
  }
  /// The item of a target.
  static std::size_t item(std::size_t lane) { return kLanes - 1 - lane; }

  TargetRows<T> rows;
  EyePoint<T> eye;
  std::array<std::vector<T>, 4> plane;
  std::vector<ShapeWord<T>> label;
  AlignedBuffer<LaneIndex<T>> target, eyes, first, count;
  AlignedBuffer<T> whole;
  AlignedBuffer<T> hidden;
  AlignedBuffer<T> common;
  std::vector<T> parts;  ///< by target
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
void expectSameBits(const ClipFunctions<T>& scalar, const ClipFunctions<T>& vectors,
                    const Arena& setup) {
  Lanes<T> expected(setup);
  expected.run(scalar);
  Lanes<T> found(setup);
  found.run(vectors);
  const auto bits = [](const AlignedBuffer<T>& values, std::size_t lane) {
    return std::bit_cast<ShapeWord<T>>(values.data()[lane]);
  };
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    ASSERT_EQ(bits(expected.whole, lane), bits(found.whole, lane));
    ASSERT_EQ(bits(expected.hidden, lane), bits(found.hidden, lane));
    ASSERT_EQ(bits(expected.common, lane), bits(found.common, lane));
    ASSERT_EQ(std::bit_cast<ShapeWord<T>>(expected.parts[lane]),
              std::bit_cast<ShapeWord<T>>(found.parts[lane]));
    ASSERT_EQ(expected.shape.data()[lane], found.shape.data()[lane]);
    ASSERT_EQ(expected.cut_low.data()[lane], found.cut_low.data()[lane]);
    ASSERT_EQ(expected.cut_high.data()[lane], found.cut_high.data()[lane]);
  }
}

template <class T>
void expectSameBits(const ClipKernelSet& kernels, const Arena& setup) {
  const ClipKernelSet scalar = clipKernels(false);
  expectSameBits<T>(of<T>(scalar).near, of<T>(kernels).near, setup);
  expectSameBits<T>(of<T>(scalar).far, of<T>(kernels).far, setup);
}

TEST(ClipKernels, EveryTargetAgreesToTheBit) {
  forEveryClipTarget([](const ClipKernelSet& kernels) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const Arena setup = randomSetup(seed, seed % 4 == 0 ? 0.5 : 0.03, seed % 5 == 0);
      expectSameBits<float>(kernels, setup);
      expectSameBits<double>(kernels, setup);
    }
  });
}

/// Against VisiblePart, lane by lane: errors relative to the whole polygon's form factor, of which
/// `tolerance` is allowed.
template <class T>
void expectAccurate(const ClipFunctions<T>& clip, double size, double tolerance) {
  std::size_t cut = 0;
  std::size_t all = 0;
  VisiblePart exact;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const bool with_faces = seed % 5 == 0;
    const Arena setup = randomSetup(seed, size, with_faces);
    Lanes<T> lanes(setup);
    lanes.run(clip);
    const std::vector<Blocker> blocker = {{&setup.body, 0, with_faces}};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      std::vector<Vec3> outline = setup.targets[lane];
      if (outline[2] == outline[3]) outline.pop_back();
      const PointView view = exact.look(setup.eye, setup.normal, outline, blocker);
      const std::size_t item = lanes.item(lane);
      const double whole = double(lanes.whole.data()[lane]);
      const double hidden = double(lanes.hidden.data()[item]);
      ASSERT_NEAR(whole, view.whole, tolerance * view.whole) << seed << ' ' << lane;
      // Three times the edges, each rounded.
      ASSERT_NEAR(double(lanes.parts[lane]), view.whole, 3 * tolerance * view.whole);
      const double visible = hidden == kHiddenWhole ? 0 : whole - hidden;
      ASSERT_NEAR(visible, view.visible, tolerance * view.whole) << seed << ' ' << lane;
      if (hidden != kHiddenWhole) {
        ASSERT_NEAR(double(lanes.common.data()[item]), hidden, tolerance * whole);
      }
      all += hidden == kHiddenWhole;
      cut += view.visible > 0.01 * view.whole && view.visible < 0.99 * view.whole;
      // A shape is given only if the cone's edge is seen before the polygon.
      if (visible > 1e-3 * whole && visible < 0.999 * whole) {
        ASSERT_NE(lanes.shape.data()[item], 0u);
      }
      if (hidden == kHiddenWhole || hidden == 0) {
        ASSERT_EQ(lanes.shape.data()[item], 0u);
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
  const ClipFunctions<float> clip = clipKernels(false).single.near;
  expectAccurate<float>(clip, 0.5, 6e-6);
  expectAccurate<float>(clip, 0.1, 3e-5);
  expectAccurate<float>(clip, 0.01, 3e-4);
}

TEST(ClipKernels, DoublePrecisionKeepsItsAccuracy) {
  const ClipFunctions<double> clip = clipKernels(false).exact.near;
  expectAccurate<double>(clip, 0.5, 3e-14);
  expectAccurate<double>(clip, 0.1, 1.5e-13);
  expectAccurate<double>(clip, 0.01, 1.5e-12);
}

TEST(ClipKernels, FarKernelsKeepTheirAccuracy) {
  // kFarError (h/r)^3, h half a diagonal of the quadrilaterals, at r 0.9 and more.
  for (const double size : {0.1, 0.05, 0.02, 0.01}) {
    const double h_over_r = 0.75 * size / 0.9;
    const double tolerance = kFarError * std::pow(h_over_r, 3);
    expectAccurate<double>(clipKernels(false).exact.far, size, tolerance);
    // In single precision the shift of a shadow's edge by a rounded plane comes on top.
    expectAccurate<float>(clipKernels(false).single.far, size, tolerance + 2e-6 / h_over_r);
  }
}

ConePoints conePoints(std::span<const Vec3> eyes) {
  ConePoints points;
  points.count = eyes.size();
  for (std::size_t q = 0; q < kLaneAlignment; ++q) {
    const Vec3& eye = eyes[std::min(q, eyes.size() - 1)];
    for (int axis = 0; axis < 3; ++axis) points.position[axis][q] = eye[axis];
  }
  return points;
}

struct ConeMemory {
  explicit ConeMemory(const Occluder& body) : above(body.planes.size()) {
    heights.reserve(body.planes.size() * kLaneAlignment);
  }
  ConeScratch scratch() { return {heights.data(), above.data()}; }
  AlignedBuffer<double> heights;
  std::vector<std::uint32_t> above;
};

/// One body's cones.
template <class T>
struct Sides {
  Sides(const Occluder& body, std::span<const Vec3> eyes, const ClipKernels<T>& kernels) {
    ConeMemory memory(body);
    all.resize(body.edges.size() + body.planes.size());
    all.resize(kernels.cones(body, conePoints(eyes), true, memory.scratch(), all.data()));
  }
  std::vector<ConeSide<T>> all;
};

/// A box and a rectangle, and eyes: within the box, too, and in the rectangle's plane.
template <class Check>
void forEveryBody(const Check& check) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vec3 origin(-0.3, -0.2, -0.4);
  const Occluder box = test::boxOccluder(origin, {0.8, 0.1, 0}, {-0.1, 0.5, 0}, {0, 0.1, 0.5});
  const Occluder flat = test::flatRectangle(origin, {0.8, 0, 0}, {-0.1, 0.5, 0});
  for (std::size_t k = 0; k < 100; ++k) {
    std::vector<Vec3> eyes(1 + k % kLaneAlignment);
    for (Vec3& eye : eyes) eye = Vec3(uniform(random), uniform(random), uniform(random));
    check(box, eyes);
    for (std::size_t q = 0; q < eyes.size(); q += 3) eyes[q].z = origin.z;
    check(flat, eyes);
  }
}

/// All sides of blockingCone() in their order, and no others.
template <class T>
void expectCones(const Occluder& body, std::span<const Vec3> eyes, double tolerance) {
  const Sides<T> found(body, eyes, of<T>(clipKernels(false)));
  for (std::size_t q = 0; q < eyes.size(); ++q) {
    BlockingCone expected;
    blockingCone(body, eyes[q], true, expected);
    std::size_t next = 0;
    for (const ConeSide<T>& side : found.all) {
      if ((side.points >> q & 1) == 0) continue;
      ASSERT_LT(next, expected.planes.size());
      EXPECT_EQ(side.label, expected.labels[next]);
      const ClipPlane& plane = expected.planes[next++];
      const double length = glm::length(plane.normal);
      const Vec3 normal(side.normal[0][q], side.normal[1][q], side.normal[2][q]);
      EXPECT_LE(glm::distance(normal, plane.normal / length), tolerance);
      EXPECT_NEAR(double(side.offset[q]), plane.offset / length, tolerance);
    }
    EXPECT_EQ(next, expected.planes.size());
  }
}

TEST(ClipKernels, ConesOfManyPointsEqualThoseOfSinglePoints) {
  forEveryBody([](const Occluder& body, std::span<const Vec3> eyes) {
    // Unit normals and offsets below 2: a rounding or two to T each.
    expectCones<float>(body, eyes, 2e-7);
    expectCones<double>(body, eyes, 4e-16);
  });
}

template <class T>
void expectSameCones(const Occluder& body, std::span<const Vec3> eyes,
                     const ClipKernelSet& kernels) {
  const Sides<T> expected(body, eyes, of<T>(clipKernels(false)));
  const Sides<T> found(body, eyes, of<T>(kernels));
  ASSERT_EQ(expected.all.size(), found.all.size());
  for (std::size_t k = 0; k < found.all.size(); ++k) {
    const ConeSide<T>& a = expected.all[k];
    const ConeSide<T>& b = found.all[k];
    ASSERT_EQ(a.label, b.label);
    ASSERT_EQ(a.points, b.points);
    for (std::size_t q = 0; q < eyes.size(); ++q) {
      if ((a.points >> q & 1) == 0) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(std::bit_cast<ShapeWord<T>>(a.normal[axis][q]),
                  std::bit_cast<ShapeWord<T>>(b.normal[axis][q]));
      }
      ASSERT_EQ(std::bit_cast<ShapeWord<T>>(a.offset[q]), std::bit_cast<ShapeWord<T>>(b.offset[q]));
    }
  }
}

TEST(ClipKernels, ConesAgreeToTheBit) {
  forEveryClipTarget([](const ClipKernelSet& kernels) {
    forEveryBody([&](const Occluder& body, std::span<const Vec3> eyes) {
      expectSameCones<float>(body, eyes, kernels);
      expectSameCones<double>(body, eyes, kernels);
    });
  });
}

/// A triangle, a quadrilateral or a pentagon in some plane.
std::vector<Vec3> randomPolygon(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  const Vec3 centre = vector();
  const Vec3 u = 0.2 * vector();
  const Vec3 v = 0.2 * vector();
  const std::size_t corners = 3 + random() % 3;
  std::vector<Vec3> outline;
  for (std::size_t k = 0; k < corners; ++k) {
    const double angle = 2 * M_PI * double(k) / double(corners);
    outline.push_back(centre + std::cos(angle) * u + std::sin(angle) * v);
  }
  return outline;
}

TEST(ClipKernels, APolygonIsMissedIfOneSideOfTheConeExcludesIt) {
  const ClipKernels<double> kernels = clipKernels(false).exact;
  std::mt19937_64 random(11);
  std::size_t missed_by = 0;
  std::size_t not_missed_by = 0;
  forEveryBody([&](const Occluder& body, std::span<const Vec3> eyes) {
    ConeMemory memory(body);
    const std::vector<Vec3> outline = randomPolygon(random);
    std::size_t edge = random() % body.edges.size();
    const std::uint32_t missed = kernels.missed(body, conePoints(eyes), outline.data(),
                                                outline.size(), memory.scratch(), edge);
    ASSERT_LT(edge, body.edges.size());
    for (std::size_t q = 0; q < eyes.size(); ++q) {
      BlockingCone cone;
      blockingCone(body, eyes[q], false, cone);
      // No polygon here touches a side: its distance from zero is well above rounding.
      const bool expected =
          std::any_of(cone.planes.begin(), cone.planes.end(), [&](const ClipPlane& plane) {
            return std::all_of(outline.begin(), outline.end(),
                               [&](const Vec3& p) { return plane.distance(p - eyes[q]) <= 0; });
          });
      ASSERT_EQ((missed >> q & 1) != 0, expected);
      (expected ? missed_by : not_missed_by) += 1;
    }
  });
  EXPECT_GT(missed_by, 100u);
  EXPECT_GT(not_missed_by, 100u);
}

TEST(ClipKernels, MissedPolygonsAgreeOnEveryTargetAndFromEveryEdge) {
  forEveryClipTarget([](const ClipKernelSet& kernels) {
    std::mt19937_64 random(12);
    forEveryBody([&](const Occluder& body, std::span<const Vec3> eyes) {
      ConeMemory memory(body);
      const ConePoints points = conePoints(eyes);
      const std::vector<Vec3> outline = randomPolygon(random);
      std::size_t edge = 0;
      const std::uint32_t expected = clipKernels(false).single.missed(
          body, points, outline.data(), outline.size(), memory.scratch(), edge);
      for (std::size_t first = 0; first < body.edges.size(); ++first) {
        edge = first;
        ASSERT_EQ(kernels.single.missed(body, points, outline.data(), outline.size(),
                                        memory.scratch(), edge),
                  expected);
      }
    });
  });
}

}  // namespace
}  // namespace radiosity
