// Curved bodies of many faces: their occluders, the time to find them, finite values, and
// interruption.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>
#include <random>
#include <thread>

#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {
namespace {

using test::MeshBuilder;
using RadiusAt = std::function<double(int ring, int sector)>;

/// A ball of triangles about `middle`, fronts outward: 2 sectors (rings - 1) of them.
std::size_t addBall(MeshBuilder& builder, const Vec3& middle, int rings, int sectors,
                    const RadiusAt& radius) {
  const auto corner = [&](int ring, int sector) {
    const bool pole = ring == 0 || ring == rings;
    const int s = pole ? 0 : sector % sectors;
    const double polar = std::numbers::pi * ring / rings;
    const double turn = 2 * std::numbers::pi * s / sectors;
    const double across = pole ? 0 : std::sin(polar);
    return middle + radius(ring, s) *
                        Vec3(across * std::cos(turn), across * std::sin(turn), std::cos(polar));
  };
  std::size_t faces = 0;
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const Vec3 a = corner(r, s);
      const Vec3 b = corner(r + 1, s);
      const Vec3 c = corner(r + 1, s + 1);
      const Vec3 d = corner(r, s + 1);
      if (r + 1 < rings) builder.polygon("ball", {{a, b, c}});
      if (r > 0) builder.polygon("ball", {{a, c, d}});
      faces += (r + 1 < rings ? 1 : 0) + (r > 0 ? 1 : 0);
    }
  }
  return faces;
}

PatchMesh roomWithBall(int rings, int sectors, const RadiusAt& radius, std::size_t& faces) {
  MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 2, true);
  faces = addBall(builder, {0.5, 0.45, 0.4}, rings, sectors, radius);
  return builder.build();
}

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Of all threads, so that other work on the machine counts little.
double processorSecondsOf(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(ExactBodies, AConvexBodyOfManyFacesIsOneSolid) {
  std::size_t faces = 0;
  const PatchMesh mesh = roomWithBall(
      24, 48, [](int, int) { return 0.25; }, faces);
  const ElementSet elements(mesh);
  const OccluderSet set(mesh, elements);
  ASSERT_EQ(set.solids, 1u);
  EXPECT_EQ(set.occluders.size(), 1u);  // of the room's walls none can block
  const Occluder& ball = set.occluders[0];
  // Two triangles between rings lie on one plane, but for the 48 at each pole.
  EXPECT_EQ(ball.planes.size(), faces / 2 + 48);
  EXPECT_EQ(ball.facets.size(), faces);
  EXPECT_EQ(ball.corners.size() + ball.planes.size(), ball.edges.size() + 2);
  for (const Occluder::Plane& plane : ball.planes) {
    for (const Vec3& corner : ball.corners) {
      ASSERT_LE(glm::dot(plane.normal, corner), plane.offset + elements.coincidence);
    }
  }
}

TEST(ExactBodies, ADentedBodyBlocksByItsFaces) {
  std::size_t faces = 0;
  const auto dented = [](int r, int s) { return r == 12 && s == 5 ? 0.2 : 0.25; };
  const PatchMesh mesh = roomWithBall(24, 48, dented, faces);
  const OccluderSet set(mesh, ElementSet(mesh));
  EXPECT_EQ(set.solids, 0u);
  EXPECT_GT(set.occluders.size(), faces / 2);
}

/// Growth as n log n is 2.2 to 2.3 for twice the faces; growth as n^2 would be 4. The bound lies
/// between, with room for a busy machine.
TEST(ExactBodies, OccludersTakeLittleMoreThanLinearTime) {
  for (const bool bumpy : {false, true}) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0.24, 0.25);
    const auto seconds = [&](int rings) {
      std::size_t faces = 0;
      const auto radius = [&](int, int) { return bumpy ? any(random) : 0.25; };
      std::vector<std::vector<double>> fixed(std::size_t(rings) + 1);
      for (auto& row : fixed) {
        for (int s = 0; s < 2 * rings; ++s) row.push_back(radius(0, s));
      }
      const PatchMesh mesh = roomWithBall(
          rings, 2 * rings, [&](int r, int s) { return fixed[std::size_t(r)][std::size_t(s)]; },
          faces);
      const ElementSet elements(mesh);
      double least = HUGE_VAL;
      for (int run = 0; run < 3; ++run) {
        least = std::min(least, processorSecondsOf([&] { const OccluderSet set(mesh, elements); }));
      }
      return least;
    };
    const double few = seconds(24);
    const double many = seconds(48);  // four times the faces
    EXPECT_LT(many, 3.2 * 3.2 * few) << (bumpy ? "bumpy " : "smooth ") << few << " s, " << many;
  }
}

/// Bumpy bodies, whose patches touch each other's planes in corners, with thin triangles among
/// them.
TEST(ExactBodies, AllValuesAreFinite) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(0.15, 0.3);
    std::vector<double> radius(8 * 13);
    for (double& r : radius) r = any(random);
    if (seed % 2 == 0) {  // thin ones: neighbours all but alike
      for (std::size_t k = 0; k + 1 < radius.size(); k += 3) radius[k + 1] = radius[k] + 1e-9;
    }
    std::size_t faces = 0;
    const PatchMesh mesh = roomWithBall(
        7, 12, [&](int r, int s) { return radius[std::size_t(r) * 12 + std::size_t(s)]; }, faces);
    FormFactorOptions options;
    options.method = FormFactorMethod::exact;
    options.tolerance = 1e-2;
    Progress silent;
    const FormFactors f = computeFormFactors(mesh, options, silent);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      ASSERT_TRUE(std::isfinite(f.error[i])) << seed << " " << i;
      pairsOf(*f.matrix).forRow(
          i, [&](Index, double value) { ASSERT_TRUE(value >= 0) << seed << " " << i; });
      // Rows of a room sum to 1 within their figures: errors of either sign in these many entries,
      // most of them occluded.
      EXPECT_NEAR(f.fronts[i] + f.backs[i], 1.0, 20 * f.error[i] + 1e-4) << seed << " " << i;
    }
  }
}

TEST(ExactBodies, CanBeInterrupted) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0.15, 0.3);
  std::vector<double> radius(41 * 80);
  for (double& r : radius) r = any(random);
  std::size_t faces = 0;
  const PatchMesh mesh = roomWithBall(
      40, 80, [&](int r, int s) { return radius[std::size_t(r) * 80 + std::size_t(s)]; }, faces);
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  for (const int milliseconds : {5, 50, 500, 2000}) {
    Progress progress;
    double answered = 0;
    const double all = secondsOf([&] {
      std::thread signal([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        progress.cancel();
      });
      EXPECT_THROW(computeFormFactors(mesh, options, progress), Cancelled);
      signal.join();
    });
    answered = all - 1e-3 * milliseconds;
    // Half a second on a quiet machine; tests run several at a time.
    EXPECT_LT(answered, 5) << "after " << milliseconds << " ms";
  }
}

}  // namespace
}  // namespace radiosity
