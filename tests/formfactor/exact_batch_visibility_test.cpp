// The visible parts of targets past several occluders from all points of a cell at once: against
// one point and target after the other in double precision, and in batches with other targets.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "formfactor/exact/occluded/batch_visibility.h"
#include "occluder_builder.h"

namespace radiosity {
namespace {

constexpr Vec3 kReceiverNormal(0, 0, 1);

SampleCell cell() {
  return {{Vec3(-0.05, -0.05, 0), Vec3(0.05, -0.05, 0), Vec3(0.05, 0.05, 0), Vec3(-0.05, 0.05, 0)}};
}

/// Targets overhead, each past some of the bodies.
struct Scene {
  std::vector<Occluder> bodies;
  std::vector<std::vector<Vec3>> outlines;
  std::vector<std::vector<Blocker>> blockers;
  std::vector<GroupTarget> targets;
};

Occluder disc(const Vec3& centre, double radius, std::size_t sides) {
  std::vector<Vec3> loop;
  for (std::size_t k = 0; k < sides; ++k) {
    const double angle = 2 * M_PI * double(k) / double(sides);
    loop.push_back(centre + radius * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  return test::flatOccluder(loop);
}

/// Boxes, and special cases: a sheet in the plane of a column of points, a box about the middle
/// point, a disc of more sides than kernels take.
std::vector<Occluder> bodies(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Occluder> bodies;
  for (int k = 0; k < 8; ++k) {
    const Vec3 at(0.5 * uniform(random), 0.5 * uniform(random), 0.9 + 0.4 * uniform(random));
    const double turn = uniform(random);
    const Vec3 u = 0.3 * Vec3(std::cos(turn), std::sin(turn), 0);
    const Vec3 v = 0.3 * Vec3(-std::sin(turn), std::cos(turn), 0);
    bodies.push_back(test::boxOccluder(at - 0.5 * (u + v), u, v, {0, 0, 0.2}));
  }
  const SamplePoints points = cell().points(3);
  const double x = points.point[0].position.x;
  bodies.push_back(test::flatRectangle({x, -0.4, 0.6}, {0, 0.8, 0}, {0, 0, 0.5}));
  const Vec3 middle = points.point[4].position;
  const double e = 0.01;
  bodies.push_back(
      test::boxOccluder(middle - Vec3(e), {2 * e, 0, 0}, {0, 2 * e, 0}, {0, 0, 2 * e}));
  bodies.push_back(disc({0.1, -0.1, 1}, 0.25, kMostPlanes + 10));
  return bodies;
}

Scene randomScene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Scene scene;
  scene.bodies = bodies(random);
  for (int k = 0; k < 40; ++k) {
    const Vec3 low(0.8 * uniform(random), 0.8 * uniform(random), 2);
    const Vec3 a(0.2, 0.05 * uniform(random), 0);
    const Vec3 b(0, 0.2, 0);
    std::vector<Vec3> outline = {low, low + b, low + a + b, low + a};
    if (k % 5 == 0) outline.pop_back();
    scene.outlines.push_back(outline);
    std::vector<Blocker> past;
    for (Index id = 0; id < scene.bodies.size(); ++id) {
      // Few past the box about a point: from there nothing is seen.
      const double share = id == 9 ? -0.8 : 0;
      if (uniform(random) < share) past.push_back({&scene.bodies[id], id, id % 2 == 0});
    }
    scene.blockers.push_back(past);
  }
  for (std::size_t k = 0; k < scene.outlines.size(); ++k) {
    GroupTarget target;
    const Vec3 middle = 0.5 * (scene.outlines[k][0] + scene.outlines[k][2]);
    target.setOutline(scene.outlines[k],
                      makeFrame(middle, -kReceiverNormal, axisAcross(kReceiverNormal)));
    target.blockers = scene.blockers[k];
    scene.targets.push_back(target);
  }
  return scene;
}

std::vector<const GroupTarget*> pointers(const Scene& scene) {
  std::vector<const GroupTarget*> all;
  all.reserve(scene.targets.size());
  for (const GroupTarget& target : scene.targets) all.push_back(&target);
  return all;
}

/// Errors relative to the whole.
template <class T>
void expectAsExact(const ClipKernels<T>& kernels, double tolerance) {
  BatchVisibility<T> view(kernels);
  VisiblePart exact;
  const SamplePoints points = cell().points(3);
  std::size_t partly = 0;
  std::size_t hidden = 0;
  std::size_t open = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = randomScene(seed);
    view.look(points.all(), cell().middle(), kReceiverNormal, pointers(scene), false);
    for (std::size_t q = 0; q < points.count; ++q) {
      for (std::size_t k = 0; k < scene.targets.size(); ++k) {
        const PointView expected = exact.look(points.point[q].position, kReceiverNormal,
                                              scene.outlines[k], scene.blockers[k]);
        const double visible = double(view.visible(q)[k]);
        ASSERT_NEAR(double(view.whole(q)[k]), expected.whole, tolerance * expected.whole);
        ASSERT_NEAR(visible, expected.visible, tolerance * expected.whole)
            << seed << ' ' << q << ' ' << k;
        const auto shape = view.shape(q)[k];
        if (shape == BatchVisibility<T>::kAllHiddenShape) {
          ASSERT_EQ(visible, 0);
          ++hidden;
        } else if (shape == 0) {
          ASSERT_EQ(visible, double(view.whole(q)[k]));
          ++open;
        } else {
          ++partly;
        }
      }
    }
  }
  EXPECT_GT(partly, 1000u);
  EXPECT_GT(hidden, 100u);
  EXPECT_GT(open, 1000u);
}

// Targets have h about 0.14 at distance 2: one term is known to 14 times what the kernels claim,
// and inclusion and exclusion add up some ten.
TEST(BatchVisibility, DoublePrecisionEqualsPointByPointClipping) {
  expectAsExact<double>(clipKernels(true).exact, 10 * 14 * 1e-14);
}

TEST(BatchVisibility, SinglePrecisionEqualsPointByPointClipping) {
  expectAsExact<float>(clipKernels(true).single, 10 * 14 * 2e-6);
}

/// A triangle overhead whose edge lies in the side x = 0 of a box, with a corner in its middle: by
/// `back` before the side, the ends behind it.
template <class T>
void expectSeenBesideABox(const ClipKernels<T>& kernels, double back, double tolerance) {
  const Occluder box = test::boxOccluder({-0.5, -1, 1}, {0.5, 0, 0}, {0, 2, 0}, {0, 0, 2});
  const std::vector<Vec3> outline = {
      {-back, -0.1, 2}, {back, 0.01, 2}, {-back, 0.1, 2}, {0.2, 0, 2}};
  const Blocker past{&box, 0, true};
  GroupTarget target;
  target.setOutline(outline, makeFrame({0.1, 0, 2}, -kReceiverNormal, axisAcross(kReceiverNormal)));
  target.blockers = std::span(&past, 1);
  const GroupTarget* const targets[] = {&target};
  BatchVisibility<T> view(kernels);
  const SamplePoints points = cell().points(3);
  view.look(points.all(), cell().middle(), kReceiverNormal, targets, false);
  std::size_t beside = 0;
  for (std::size_t q = 0; q < points.count; ++q) {
    if (points.point[q].position.x <= 0) continue;  // in line with the side, or the box hides
    ++beside;
    const double whole = double(view.whole(q)[0]);
    EXPECT_NEAR(double(view.visible(q)[0]), whole, tolerance * whole) << q;
  }
  EXPECT_EQ(beside, 3u);
}

// Rounding far from the origin, and elements that are convex but for coincidence, leave corners
// behind the line of their neighbours.
TEST(BatchVisibility, ACornerMayLieBackFromTheLineOfItsNeighbours) {
  for (const double back : {0.0, 1e-15, 1e-13, 1e-11, 1e-9}) {
    expectSeenBesideABox<double>(clipKernels(true).exact, back, 10 * 14 * 1e-14 + 100 * back);
  }
  for (const double back : {1e-9, 1e-7, 1e-6, 3e-6}) {
    expectSeenBesideABox<float>(clipKernels(true).single, back, 10 * 14 * 2e-6 + 100 * back);
  }
}

TEST(BatchVisibility, OtherTargetsOfTheBatchChangeNothing) {
  BatchVisibility<float> together(clipKernels(true).single);
  BatchVisibility<float> alone(clipKernels(true).single);
  for (const std::size_t side : {2, 3}) {
    const SamplePoints points = cell().points(side);
    const Scene scene = randomScene(side);
    const std::vector<const GroupTarget*> all = pointers(scene);
    together.look(points.all(), cell().middle(), kReceiverNormal, all, false);
    for (std::size_t k = 0; k < all.size(); ++k) {
      alone.look(points.all(), cell().middle(), kReceiverNormal, std::span(all).subspan(k, 1),
                 false);
      for (std::size_t q = 0; q < points.count; ++q) {
        EXPECT_EQ(together.whole(q)[k], alone.whole(q)[0]);
        EXPECT_EQ(together.visible(q)[k], alone.visible(q)[0]);
        EXPECT_EQ(together.shape(q)[k], alone.shape(q)[0]);
      }
    }
  }
}

}  // namespace
}  // namespace radiosity
