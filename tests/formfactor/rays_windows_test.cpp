// Windows of directions that rays are aimed into: they hold all that can be met, and values by rays
// into them are those of rays everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "formfactor/computed_factors.h"
#include "formfactor/contour_reference.h"
#include "formfactor/rays/ray_scene.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using std::numbers::pi;

FormFactorOptions byRays(double tolerance, std::uint64_t seed) {
  FormFactorOptions options;
  options.method = FormFactorMethod::rays;
  options.tolerance = tolerance;
  options.seed = seed;
  return options;
}

TEST(DirectionWindow, SharesAreThoseOfCosineDistributedDirections) {
  // A cone of 30 degrees around the normal, as a disc seen from a point on its axis: sin^2.
  const DirectionWindow cone{0.75, 1, 0, pi};
  EXPECT_NEAR(cone.share(), 0.25, 1e-15);
  // A sixth of it.
  const DirectionWindow slice{0.75, 1, 2, pi / 6};
  EXPECT_NEAR(slice.share(), 0.25 / 6, 1e-15);
  EXPECT_TRUE(cone.contains(slice));
  EXPECT_FALSE(slice.contains(cone));
  EXPECT_EQ(DirectionWindow().share(), 0);
}

TEST(DirectionWindow, GrowsTheShorterWayRound) {
  const DirectionWindow before{0.1, 0.2, pi - 0.1, 0.05};
  const DirectionWindow behind{0.3, 0.4, 0.1 - pi, 0.05};
  DirectionWindow both;
  both.add(before);
  both.add(behind);
  EXPECT_TRUE(both.contains(before));
  EXPECT_TRUE(both.contains(behind));
  EXPECT_NEAR(both.half, 0.15, 1e-12);
  EXPECT_EQ(both.low, 0.1);
  EXPECT_EQ(both.high, 0.4);
  both.add({0.3, 0.3, 0, 3});
  EXPECT_EQ(both.half, pi);
}

/// Random triangles around, before and behind random patches of all sizes.
TEST(RayWindows, HoldEveryDirectionInWhichSomethingCanBeMet) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto place = [&](double reach) {
    return reach * Vec3(2 * unit(random) - 1, 2 * unit(random) - 1, 2 * unit(random) - 1);
  };
  int windows = 0;
  int directions = 0;
  for (int run = 0; run < 120; ++run) {
    const double unit_length = std::pow(10.0, std::floor(7 * unit(random)) - 3);
    const double from_size = unit_length * std::pow(0.1, std::floor(4 * unit(random)));
    const double to_size = unit_length * std::pow(0.1, std::floor(4 * unit(random)));
    const std::array<Vec3, 3> from{place(from_size), place(from_size), place(from_size)};
    const Vec3 away = place(unit_length);
    const std::array<Vec3, 3> to{away + place(to_size), away + place(to_size),
                                 away + place(to_size)};
    test::MeshBuilder builder;
    builder.polygon("from", {{from[0], from[1], from[2]}});
    builder.polygon("to", {{to[0], to[1], to[2]}});
    const PatchMesh mesh = builder.build();
    const RayCaster caster(mesh);
    const RayOrigins origins = caster.origins(0);
    const auto found = RayWindows(caster.embree()).of(origins);
    if (!found) continue;
    const DirectionWindow& window = *found;
    ++windows;
    const auto pointOf = [&](const std::array<Vec3, 3>& triangle) {
      const double root = std::sqrt(unit(random));
      const double v = unit(random);
      return triangle[0] +
             root * ((1 - v) * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]));
    };
    const RayFrame& frame = origins.frame();
    for (int k = 0; k < 200; ++k) {
      const Vec3 along = glm::normalize(pointOf(to) - pointOf(from));
      const double height = glm::dot(along, Vec3(frame.z));
      if (height < 1e-6) continue;  // behind, or in the plane to the precision of rays
      const double azimuth =
          std::atan2(glm::dot(along, Vec3(frame.y)), glm::dot(along, Vec3(frame.x)));
      EXPECT_TRUE(window.contains({height * height, height * height, azimuth, 0}))
          << "run " << run << ": " << height << " " << azimuth;
      ++directions;
    }
  }
  EXPECT_GT(windows, 40);
  EXPECT_GT(directions, 2000);
}

TEST(RayWindows, AreOnlyForViewsThatHoldLittle) {
  test::MeshBuilder room;
  room.box("room", {0, 0, 0}, {4, 3, 2}, 2, true, false);
  const PatchMesh mesh = room.build();
  const RayCaster caster(mesh);
  const RayWindows windows(caster.embree());
  for (std::size_t i = 0; i < mesh.size(); ++i) EXPECT_FALSE(windows.of(caster.origins(i)));
}

/// Nothing lies before the faces of a convex body: they see the sky, without a ray and an error.
TEST(RayWindows, FacesOfABodyAloneAreProvedToSeeNothing) {
  test::MeshBuilder builder;
  builder.box("body", {0, 0, 0}, {4, 3, 2}, 3);
  const FormFactors f = test::computed(builder.build(), byRays(1e-3, 1));
  for (std::size_t i = 0; i < f.sky.size(); ++i) {
    EXPECT_EQ(f.sky[i], 1);
    EXPECT_LT(f.error[i], 1e-20);
  }
  for (const Note& note : f.report.notes) {  // that no surface sees another is said
    EXPECT_EQ(note.text.find("next to nothing"), std::string::npos) << note.text;
  }
  EXPECT_EQ(f.report.rays.rounds, 1);
}

struct FarPair {
  double size;      ///< of the one, m
  double other;     ///< of the other
  double distance;  ///< m
  double tilt;      ///< of both against the line between them, rad
  Vec3 moved;
};

/// Two small squares far apart see 10^-4 to 10^-9 of each other.
TEST(AimedRays, FindSmallThingsFarAway) {
  const std::vector<FarPair> pairs{{0.1, 0.1, 10, 0, Vec3(0)},
                                   {0.01, 0.02, 100, 0.5, {7, -3, 2}},
                                   {1, 0.001, 2, 0.2, {1000, 0, 0}},
                                   {100, 100, 1e5, 1.4, Vec3(0)},
                                   {1e-5, 1e-5, 0.1, -0.9, Vec3(0)}};
  constexpr double kTolerance = 1e-2;
  int runs = 0;
  int outside = 0;
  for (const FarPair& pair : pairs) {
    const Vec3 across(0, 1, 0);
    const Vec3 up(std::sin(pair.tilt), 0, std::cos(pair.tilt));
    const Vec3 corner = pair.moved - 0.5 * pair.size * (across + up);
    const Vec3 end = pair.moved + Vec3(pair.distance, 0, 0);
    const Vec3 other_up(-up.x, 0, up.z);
    const Vec3 other_corner = end - 0.5 * pair.other * (across + other_up);
    const double s = pair.size;
    const double o = pair.other;
    const std::array<Vec3, 4> a{corner, corner + s * across, corner + s * (across + up),
                                corner + s * up};
    const std::array<Vec3, 4> b{other_corner, other_corner + o * other_up,
                                other_corner + o * (across + other_up), other_corner + o * across};
    test::MeshBuilder builder;
    builder.polygon("a", {{a.begin(), a.end()}});
    builder.polygon("b", {{b.begin(), b.end()}});
    const PatchMesh mesh = builder.build();
    // G ~ s^2 o^2 cos^2 / (pi d^2), in which the reference, to 1e-18 of the size squared, is good
    // to 1e-6 and better; the series beyond is (s / d)^2.
    const double cosine = std::cos(pair.tilt);
    const double far = s * s * o * o * cosine * cosine / (pi * pair.distance * pair.distance);
    const double exact =
        s / pair.distance < 2e-3 && o / pair.distance < 2e-3 ? far : test::referenceExchange(a, b);
    EXPECT_NEAR(exact, far, 0.2 * far);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const FormFactors f = test::computed(mesh, byRays(kTolerance, seed));
      // The row of the smaller one: to a large one that is near, the other may be anywhere.
      const std::size_t small = o <= s ? 1 : 0;
      const double truth = exact / std::min(s * s, o * o);
      const double factor = f.matrix->at(small, 1 - small);
      ++runs;
      outside += std::abs(factor - truth) > f.error[small] ? 1 : 0;
      EXPECT_NEAR(factor, truth, 4 * kTolerance * truth) << "seed " << seed;
      EXPECT_LT(f.error[small], 6 * kTolerance * factor);
      EXPECT_LT(f.report.rays.rays, 1e7);
      EXPECT_EQ(f.report.rays.short_rows, 0u);
      EXPECT_NEAR(f.sky[small], 1 - factor, 1e-7);
    }
  }
  EXPECT_LE(outside, runs / 100 + 2);  // 99% are stated; two more of 100 by chance
}

/// A sphere of radius 1 around the origin, seen by an element of 1 mm at distance 5, and its facets
/// see the element: r^2 / h^2 for a round sphere.
TEST(AimedRays, AnElementAndASphereFindEachOther) {
  constexpr int kTurns = 24;
  constexpr int kRings = 12;
  test::MeshBuilder builder;
  const Vec3 eye(5, 0, 0);
  const double half = 0.0005;
  const std::vector<Vec3> element{eye + Vec3(0, -half, -half), eye + Vec3(0, -half, half),
                                  eye + Vec3(0, half, half), eye + Vec3(0, half, -half)};
  builder.polygon("element", {element});
  const auto at = [](int ring, int turn) {
    const double polar = pi * ring / kRings;
    const double azimuth = 2 * pi * (turn + 0.3) / kTurns;
    return Vec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                std::cos(polar));
  };
  double exchange = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int turn = 0; turn < kTurns; ++turn) {
      std::vector<Vec3> facet{at(ring, turn), at(ring + 1, turn), at(ring + 1, turn + 1),
                              at(ring, turn + 1)};
      if (ring == 0) facet = {Vec3(0, 0, 1), at(1, turn), at(1, turn + 1)};
      if (ring == kRings - 1) facet = {at(ring, turn), Vec3(0, 0, -1), at(ring, turn + 1)};
      builder.polygon("sphere", {facet});
      const Vec3 normal = glm::cross(facet[1] - facet[0], facet[2] - facet[0]);
      if (glm::dot(normal, eye - facet[0]) > 0) {
        exchange += test::referenceExchange(element, facet);
      }
    }
  }
  const double exact = exchange / (4 * half * half);
  EXPECT_NEAR(exact, 1.0 / 25, 0.03 / 25);  // facets cut off some of the sphere
  const PatchMesh mesh = builder.build();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const FormFactors f = test::computed(mesh, byRays(1e-2, seed));
    EXPECT_NEAR(f.fronts[0], exact, 1e-2 * exact) << "seed " << seed;
    EXPECT_LT(f.error[0], 0.1 * exact);
    // The four facets that see it at the smallest angle are hit by its rays, and hardly hit it.
    EXPECT_LE(f.report.rays.short_rows, 4u);
    EXPECT_TRUE(f.report.notes.empty());
  }
}

/// Perpendicular rectangles, 3 m apart, that see 1e-4 of each other past their horizons.
TEST(AimedRays, RowsThatSeeLittleGoOnToTheirTolerance) {
  test::MeshBuilder builder;
  builder.grid("a", {3, 0, 0}, {1, 0, 0}, {0, 1, 0}, 5, 5);
  builder.grid("b", {0, 0, 0.1}, {0, 1, 0}, {0, 0, 0.1}, 4, 1);
  const PatchMesh mesh = builder.build();
  const std::array<Vec3, 4> a{Vec3(3, 0, 0), {4, 0, 0}, {4, 1, 0}, {3, 1, 0}};
  const std::array<Vec3, 4> b{Vec3(0, 0, 0.1), {0, 1, 0.1}, {0, 1, 0.2}, {0, 0, 0.2}};
  const double exact = test::referenceExchange(a, b);
  EXPECT_NEAR(exact, 1.124e-4, 1e-6);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const FormFactors f = test::computed(mesh, byRays(3e-3, seed));
    double exchange = 0;
    for (std::size_t i = 0; i < 25; ++i) exchange += mesh.area[i] * f.fronts[i];
    EXPECT_NEAR(exchange, exact, 3e-3 * exact) << "seed " << seed;
    EXPECT_LT(f.report.error_figure, 3e-3);
    EXPECT_GT(f.report.error_figure, 1e-3);
    EXPECT_EQ(f.report.rays.short_rows, 0u);
  }
}

/// A plate that sees specks all around it from behind: it may see other fronts, too, as far as its
/// rays can tell.
TEST(AimedRays, ARowThatHasSeenNothingSaysUpToWhichFormFactor) {
  test::MeshBuilder builder;
  builder.grid("plate", {-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0});
  for (int k = 0; k < 5; ++k) {
    const double turn = 2 * pi * k / 5;
    const Vec3 away(std::cos(turn), std::sin(turn), k % 2 == 0 ? 0.5 : 1.0);
    const Vec3 u = 1e-4 * glm::normalize(glm::cross(away, Vec3(0, 0, 1)));
    const Vec3 v = 1e-4 * glm::normalize(glm::cross(away, u));
    // Its front is on the far side.
    const Vec3 at = 10.0 * away;
    if (glm::dot(glm::cross(u, v), away) > 0) {
      builder.grid("speck", at, u, v);
    } else {
      builder.grid("speck", at, v, u);
    }
  }
  const PatchMesh mesh = builder.build();
  ASSERT_EQ(mesh.surface_names[mesh.surface[0]], "plate");
  const FormFactors f = test::computed(mesh, byRays(1e-3, 1));
  EXPECT_EQ(f.fronts[0], 0);
  // No hit in n rays: F is below 4.6 / n in 99% of such rows.
  const double rays = double(f.report.rays.rays);
  EXPECT_GT(rays, 1e7);
  EXPECT_NEAR(f.error[0], 4.6 / rays, 0.05 * 4.6 / rays);
  EXPECT_EQ(f.report.error_figure, 1) << "all of it may have been missed";
  EXPECT_EQ(f.report.rays.short_rows, 1u);
  const auto note = std::ranges::find_if(f.report.notes, [](const Note& said) {
    return said.text.find("1 of 6 rows have seen next to nothing") != std::string::npos;
  });
  ASSERT_NE(note, f.report.notes.end());
  EXPECT_EQ(note->severity, Severity::warning);
  EXPECT_NE(note->text.find("method='exact'"), std::string::npos) << note->text;
}

}  // namespace
}  // namespace radiosity
