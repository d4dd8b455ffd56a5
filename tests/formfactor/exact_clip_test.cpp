// Clipping to the cones of occluders, from one point: against closed forms and against rays.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "occluder_builder.h"
#include "visibility/clipping/convex_polygon.h"
#include "visibility/clipping/silhouette.h"
#include "visibility/clipping/visible_part.h"

namespace radiosity {
namespace {

using test::boxOccluder;
using test::flatRectangle;

/// Sums of a few arcs of size 1: some units in the last place.
constexpr double kRounding = 1e-14;

constexpr Vec3 kUp(0, 0, 1);

/// [x0, x1] x [y0, y1] at height z, front down: it faces eyes below.
std::vector<Vec3> above(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

double formFactor(std::span<const Vec3> outline, const Vec3& eye, const Vec3& normal) {
  ConvexPolygon polygon;
  polygon.assign(outline, eye);
  return lambert(polygon, normal);
}

/// Rays and boxes along the axes (Kay & Kajiya 1986): nothing in common with cones.
bool boxHides(const Vec3& low, const Vec3& high, const Vec3& eye, const Vec3& p) {
  double enter = 0;
  double leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double t0 = (low[axis] - eye[axis]) / (p[axis] - eye[axis]);
    const double t1 = (high[axis] - eye[axis]) / (p[axis] - eye[axis]);
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter < leave;
}

PointView look(const Vec3& eye, const Vec3& normal, std::span<const Vec3> target,
               const std::vector<Occluder>& bodies, bool cuts_target = false) {
  std::vector<Blocker> blockers;
  for (Index k = 0; k < bodies.size(); ++k) blockers.push_back({&bodies[k], k, cuts_target});
  VisiblePart eye_scratch;
  return eye_scratch.look(eye, normal, target, blockers);
}

TEST(Lambert, MatchesClosedFormsOfTheCatalogue) {
  // Howell's catalogue, B-3 and B-4 with all sides 1.
  EXPECT_NEAR(formFactor(above(0, 1, 0, 1, 1), Vec3(0.0), kUp), 0.138531605994893, kRounding);
  const std::vector<Vec3> wall = {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}};
  EXPECT_NEAR(formFactor(wall, Vec3(0.0), kUp), 0.0557341970025535, kRounding);
}

TEST(Lambert, SmallAndFarPolygonsKeepTheirDigits) {
  // A square of side h at distance 1 overhead: h^2 / pi (1 - h^2 / 3 * 2 / 2 ...), to h^4.
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    const double f = formFactor(above(-h / 2, h / 2, -h / 2, h / 2, 1), Vec3(0.0), kUp);
    const double expected = h * h / M_PI * (1 - h * h / 3);
    // Each of the four arcs is known to 1e-16 of its length h, their sum is h^2; the series stops
    // at h^4.
    EXPECT_NEAR(f / expected, 1, 1e-15 / h + h * h * h * h) << h;
  }
}

TEST(Split, PartsAddUp) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int cut = 0;
  for (int k = 0; k < 2000; ++k) {
    ConvexPolygon polygon;
    polygon.assign(above(-1, 0.5, -0.7, 1, 0.4), Vec3(0.1 * uniform(random), 0, 0));
    const ClipPlane plane{Vec3(uniform(random), uniform(random), uniform(random)),
                          0.2 * uniform(random)};
    ConvexPolygon inside;
    ConvexPolygon outside;
    const PlaneSide side = split(polygon, plane, 16, &inside, &outside);
    for (const Vec3& p : polygon.corners) {
      if (side == PlaneSide::inside) {
        EXPECT_GT(plane.distance(p), -kRounding);
      }
      if (side == PlaneSide::outside) {
        EXPECT_LT(plane.distance(p), kRounding);
      }
    }
    if (side != PlaneSide::both) continue;
    ++cut;
    EXPECT_NEAR(lambert(inside, kUp) + lambert(outside, kUp), lambert(polygon, kUp), kRounding);
    EXPECT_GT(lambert(inside, kUp), 0);
    EXPECT_GT(lambert(outside, kUp), 0);
  }
  EXPECT_GT(cut, 500);
}

TEST(Silhouette, HidesExactlyThePointsBlockedForRays) {
  // Eyes all round a box, targets before, behind and beside it.
  const Vec3 low(-0.3, -0.2, -0.4), high(0.5, 0.3, 0.1);
  const Vec3 size = high - low;
  const Occluder box = boxOccluder(low, {size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z});
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int hidden = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec3 eye(uniform(random), uniform(random), uniform(random));
    const Vec3 p(uniform(random), uniform(random), uniform(random));
    BlockingCone cone;
    const bool blocks = blockingCone(box, eye, true, cone);
    ASSERT_TRUE(blocks);
    bool inside = true;
    for (const ClipPlane& plane : cone.planes) inside &= plane.distance(p - eye) >= 0;
    EXPECT_EQ(inside, boxHides(low, high, eye, p)) << k;
    EXPECT_EQ(cone.inside, boxHides(low, high, eye, eye + 1e-9 * size)) << k;
    hidden += inside;
  }
  EXPECT_GT(hidden, 2000);
}

TEST(Silhouette, FlatBodySeenFromItsOwnPlaneHidesNothing) {
  const Occluder sheet = flatRectangle({0, 0, 0.5}, {1, 0, 0}, {0, 1, 0});
  BlockingCone cone;
  EXPECT_FALSE(blockingCone(sheet, {2, 0.5, 0.5}, false, cone));
  EXPECT_TRUE(blockingCone(sheet, {2, 0.5, 0.4}, false, cone));
  EXPECT_EQ(cone.planes.size(), 4u);
}

TEST(VisiblePart, ShadowOfASheetIsTheSheet) {
  // A sheet wholly in front of a large target takes away its own form factor.
  const std::vector<Vec3> target = above(-5, 5, -5, 5, 1);
  const Vec3 eye(0.1, -0.2, 0);
  const std::vector<Occluder> sheet = {flatRectangle({0, 0, 0.4}, {0.5, 0, 0}, {0, 0.3, 0})};
  const PointView view = look(eye, kUp, target, sheet);
  EXPECT_NEAR(view.whole, formFactor(target, eye, kUp), kRounding);
  EXPECT_NEAR(view.visible, view.whole - formFactor(above(0, 0.5, 0, 0.3, 0.4), eye, kUp),
              kRounding);
}

TEST(VisiblePart, OverlappingSheetsCountOnce) {
  // Two sheets of one height that overlap, a third one elsewhere, a fourth one below it.
  const std::vector<Vec3> target = above(-5, 5, -5, 5, 1);
  const Vec3 eye(0.1, -0.2, 0);
  const std::vector<Occluder> sheets = {flatRectangle({0, 0, 0.4}, {0.5, 0, 0}, {0, 0.3, 0}),
                                        flatRectangle({0.2, 0.1, 0.4}, {0.6, 0, 0}, {0, 0.7, 0}),
                                        flatRectangle({-1, -1, 0.5}, {0.6, 0, 0}, {0, 0.7, 0}),
                                        flatRectangle({0, 0, 0.2}, {0.1, 0, 0}, {0, 0.1, 0})};
  const double hidden = formFactor(above(0, 0.5, 0, 0.3, 0.4), eye, kUp) +
                        formFactor(above(0.2, 0.8, 0.1, 0.8, 0.4), eye, kUp) -
                        formFactor(above(0.2, 0.5, 0.1, 0.3, 0.4), eye, kUp) +
                        formFactor(above(-1, -0.4, -1, -0.3, 0.5), eye, kUp);
  const std::vector<Occluder> three(sheets.begin(), sheets.begin() + 3);
  const PointView view = look(eye, kUp, target, three);
  EXPECT_NEAR(view.whole - view.visible, hidden, kRounding);
  // Only the part of the fourth outside the first one's shadow, on the plane z = 0.4, is new:
  // [-0.1, 0.1] x [0.2, 0.4], less [0, 0.1] x [0.2, 0.3].
  const double more = formFactor(above(-0.1, 0.1, 0.2, 0.4, 0.4), eye, kUp) -
                      formFactor(above(0, 0.1, 0.2, 0.3, 0.4), eye, kUp);
  const PointView all = look(eye, kUp, target, sheets);
  EXPECT_NEAR(all.whole - all.visible, hidden + more, kRounding);
}

TEST(VisiblePart, PavementOfSheetsHidesEverything) {
  // 5 x 5 sheets edge to edge: no cracks between them, and nothing twice.
  std::vector<Occluder> sheets;
  sheets.reserve(25);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      const Vec3 origin(-0.5 + 0.2 * column, -0.5 + 0.2 * row, 0.3);
      sheets.push_back(flatRectangle(origin, {0.2, 0, 0}, {0, 0.2, 0}));
    }
  }
  const PointView view = look({0.03, 0.02, 0}, kUp, above(-0.5, 0.5, -0.5, 0.5, 1), sheets);
  EXPECT_GT(view.whole, 0.2);
  EXPECT_LT(view.visible, kRounding);
}

TEST(VisiblePart, BodyThroughTheTargetHidesByThePartInFrontOnly) {
  // A post through the target hides its section with the target's plane and the shadow of its lower
  // part, not that of its upper part.
  const std::vector<Vec3> target = above(-1, 1, -1, 1, 1);
  const Vec3 eye(-0.4, 0.05, 0);
  const std::vector<Occluder> post = {
      boxOccluder({0, 0, 0.6}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 9})};
  const std::vector<Occluder> lower = {
      boxOccluder({0, 0, 0.6}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.4})};
  const double hidden = look(eye, kUp, target, lower).visible;
  EXPECT_NEAR(look(eye, kUp, target, post, true).visible, hidden, kRounding);
  EXPECT_GT(hidden, look(eye, kUp, target, post).visible + 1e-3);
}

TEST(VisiblePart, ManyShadowsSideBySideHideTheirSum) {
  const std::vector<Vec3> target = above(-0.5, 0.5, -0.5, 0.5, 1);
  const Vec3 eye(0.1, 0.05, 0);
  std::vector<Occluder> slats;
  double hidden = 0;
  for (int k = 0; k < 40; ++k) {
    const double x = -0.19 + 0.012 * k;
    slats.push_back(flatRectangle({x, -2, 0.5}, {0.004, 0, 0}, {0, 4, 0}));
    const double x0 = std::max(-0.5, 2 * (x - eye.x) + eye.x);
    const double x1 = std::min(0.5, 2 * (x + 0.004 - eye.x) + eye.x);
    if (x0 < x1) hidden += formFactor(above(x0, x1, -0.5, 0.5, 1), eye, kUp);
  }
  const PointView view = look(eye, kUp, target, slats);
  EXPECT_NEAR(view.visible, view.whole - hidden, kRounding);
}

}  // namespace
}  // namespace radiosity
