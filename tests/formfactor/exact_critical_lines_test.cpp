// Lines between which the view changes smoothly: parts tile the polygon, and from all points of one
// the shadow is bounded by the same edges, as found by VisiblePart, which knows of no lines.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "formfactor/exact/occluded/critical_lines.h"
#include "occluder_builder.h"
#include "visibility/clipping/visible_part.h"

namespace radiosity {
namespace {

constexpr std::size_t kMostParts = 400;
constexpr double kCoincidence = 1e-7;
const Vec3 kPlaneNormal(0, 0, 1);

double areaOf(const CriticalLines::Part& part) {
  double sum = 0;
  for (std::size_t k = 2; k < part.size(); ++k) {
    sum += cross2(part[k - 1] - part[0], part[k] - part[0]);
  }
  return 0.5 * sum;
}

/// Of a convex part.
Vec2 pointIn(const CriticalLines::Part& part, std::mt19937& random) {
  std::exponential_distribution<double> weight(1);
  Vec2 point(0.0);
  double sum = 0;
  for (const Vec2& corner : part) {
    const double w = weight(random);
    point += w * corner;
    sum += w;
  }
  return point / sum;
}

/// Eyes on the floor, and a target above them that looks down.
struct Sight {
  std::vector<Vec3> eyes;
  std::vector<Vec3> target;
};

/// Expects one shape in each part; returns how many parts there are.
std::size_t countParts(const Sight& sight, const Occluder& body, std::mt19937& random) {
  const std::vector<Blocker> blockers = {{&body, 0, false}};
  CriticalLines lines;
  EXPECT_TRUE(
      lines.cut(sight.eyes, kPlaneNormal, sight.target, blockers, kCoincidence, kMostParts));
  VisiblePart view;
  double area = 0;
  for (const CriticalLines::Part& part : lines.parts()) {
    area += areaOf(part);
    const auto shape = [&] {
      return view.look(lines.lift(pointIn(part, random)), kPlaneNormal, sight.target, blockers)
          .shape;
    };
    const std::uint64_t first = shape();
    for (int sample = 0; sample < 20; ++sample) EXPECT_EQ(shape(), first);
  }
  const Vec3 whole = vectorArea(sight.eyes.size(), [&](std::size_t k) { return sight.eyes[k]; });
  EXPECT_NEAR(area, glm::length(whole), 1e-14);  // sums of some hundred areas below 1
  return lines.parts().size();
}

/// Numbers that put nothing in line with anything else.
class Jitter {
 public:
  explicit Jitter(std::mt19937& random) : random_(random) {}
  Vec3 at(double x, double y, double z) { return {x + next(), y + next(), z}; }
  double next() { return number_(random_); }

 private:
  std::mt19937& random_;
  std::uniform_real_distribution<double> number_{-0.1, 0.1};
};

Sight sightAbove(Jitter& jitter) {
  Sight sight;
  sight.eyes = {jitter.at(-0.4, -0.4, 0), jitter.at(0.4, -0.4, 0), jitter.at(0.4, 0.4, 0),
                jitter.at(-0.4, 0.4, 0)};
  sight.target = {jitter.at(-0.2, -0.2, 1.1), jitter.at(-0.2, 0.2, 1.2), jitter.at(0.2, 0.1, 1)};
  return sight;
}

TEST(CriticalLines, PartsPastASheetSeeOneShapeEach) {
  std::mt19937 random(1);
  std::size_t parts = 0;
  for (int trial = 0; trial < 30; ++trial) {
    Jitter jitter(random);
    const Sight sight = sightAbove(jitter);
    const Vec3 u(0.3, jitter.next(), jitter.next());
    const Vec3 v(jitter.next(), 0.3, jitter.next());
    parts += countParts(sight, test::flatRectangle(jitter.at(-0.1, -0.1, 0.5), u, v), random);
  }
  EXPECT_GT(parts, 30u * 10);  // there was something to cut
}

TEST(CriticalLines, PartsPastABoxSeeOneShapeEach) {
  std::mt19937 random(2);
  std::size_t parts = 0;
  for (int trial = 0; trial < 30; ++trial) {
    Jitter jitter(random);
    const Sight sight = sightAbove(jitter);
    const bool stands = trial % 2 == 0;
    const double tilt = stands ? 0 : jitter.next();
    const Occluder box =
        test::boxOccluder(jitter.at(-0.1, -0.1, stands ? 0 : 0.3), {0.3, jitter.next(), 0},
                          {jitter.next(), 0.3, 0}, {tilt, jitter.next(), 0.4});
    parts += countParts(sight, box, random);
  }
  EXPECT_GT(parts, 30u * 10);
}

TEST(CriticalLines, PartsOfAFloorBelowAWallSeeOneShapeEach) {
  std::mt19937 random(3);
  std::size_t parts = 0;
  for (int trial = 0; trial < 30; ++trial) {
    Jitter jitter(random);
    Sight sight;
    sight.eyes = {jitter.at(-0.7, -0.3, 0), jitter.at(-0.3, -0.3, 0), jitter.at(-0.3, 0.3, 0),
                  jitter.at(-0.7, 0.3, 0)};
    const double left = -0.2 + jitter.next();
    const double right = 0.2 + jitter.next();
    // Not upright: an upright edge is passed by the shadow of one all at once.
    sight.target = {
        {0.6, left, 0}, {0.6, left - 0.2, 0.5}, {0.6, right - 0.1, 0.4}, {0.6, right, 0}};
    const Occluder box = test::boxOccluder(jitter.at(0, -0.1, 0), {0.2, jitter.next(), 0},
                                           {jitter.next(), 0.2, 0}, {0, 0, 0.3});
    parts += countParts(sight, box, random);
  }
  EXPECT_GT(parts, 30u * 3);
}

TEST(CriticalLines, RefusesTooManyPartsOrEdges) {
  std::mt19937 random(4);
  Jitter jitter(random);
  const Sight sight = sightAbove(jitter);
  const Occluder box =
      test::boxOccluder(jitter.at(-0.1, -0.1, 0.3), {0.3, 0.01, 0}, {0.02, 0.3, 0}, {0, 0.01, 0.4});
  const std::vector<Blocker> blockers = {{&box, 0, false}};
  const std::size_t parts = countParts(sight, box, random);
  CriticalLines lines;
  EXPECT_TRUE(lines.cut(sight.eyes, kPlaneNormal, sight.target, blockers, kCoincidence, parts));
  EXPECT_EQ(lines.parts().size(), parts);
  EXPECT_FALSE(
      lines.cut(sight.eyes, kPlaneNormal, sight.target, blockers, kCoincidence, parts - 1));
  // Twelve edges each: too many to look for lines.
  const std::vector<Blocker> many(6, blockers[0]);
  EXPECT_FALSE(lines.cut(sight.eyes, kPlaneNormal, sight.target, many, kCoincidence, kMostParts));
}

}  // namespace
}  // namespace radiosity
