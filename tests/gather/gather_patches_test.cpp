// The gather method at patch centres: pass by pass it is Jacobi's iteration on the matrix of the
// same hemicubes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "gather_scenes.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::Room;

GatherOptions atPatches(int passes, int resolution = 64) {
  GatherOptions options;
  options.at = GatherAt::patches;
  options.passes = passes;
  options.tolerance = 1e-12;  // out of reach in floats: all passes are made
  options.resolution = resolution;
  return options;
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// E + rho F B, all bands, or with F's transpose in F's place.
std::vector<double> jacobiStep(const Room& room, const ExchangeMatrix& matrix,
                               const std::vector<double>& b, bool transposed = false) {
  std::vector<double> h(b.size(), 0.0);
  for (std::size_t i = 0; i < room.mesh.size(); ++i) {
    matrix.forRow(i, [&](Index j, double f) {
      const std::size_t to = transposed ? j : i;
      const std::size_t from = transposed ? i : j;
      for (std::size_t k = 0; k < 3; ++k) h[3 * to + k] += f * b[3 * from + k];
    });
  }
  for (std::size_t k = 0; k < h.size(); ++k) {
    h[k] = room.materials.emission[k] + room.materials.reflectance[k] * h[k];
  }
  return h;
}

FormFactors matrixOf(const Room& room, int resolution) {
  Progress quiet;
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  options.precision = Precision::double_precision;
  return computeFormFactors(room.mesh, options, quiet);
}

double worst(const std::vector<float>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t k = 0; k < b.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

TEST(GatherAtPatches, EveryPassIsAJacobiIterate) {
  // The same eyes, turns and pixels differ only by the rounding of radiosities to 32 bits, 6e-8 of
  // each a pass, which rho < 0.9 keeps below 10 times that: 1e-6 of the largest emission.
  for (const char* scene : {"cornell-box-closed", "cornell-box", "two-rooms", "blocked-plates"}) {
    const Room room = test::loadRoom(scene, 250);
    const FormFactors factors = matrixOf(room, 64);
    const double scale = largest(room.materials.emission);
    std::vector<double> b = room.materials.emission;
    for (int passes = 1; passes <= 4; ++passes) {
      b = jacobiStep(room, pairsOf(*factors.matrix), b);
      const Gathered gathered = test::gathered(room, atPatches(passes));
      ASSERT_EQ(gathered.summary.passes.size(), std::size_t(passes));
      EXPECT_LE(worst(gathered.radiosity, b), 1e-6 * scale) << scene << " pass " << passes;
    }
  }
}

TEST(GatherAtPatches, DiffersFromTheTransposedMatrix) {
  // Gathering with F_ji is invisible while all areas are equal; here they are not, and the first
  // pass already differs by far more than the 1e-6 the test above allows.
  const Room room = test::loadRoom("cornell-box-closed", 250);
  const FormFactors factors = matrixOf(room, 64);
  const std::vector<double> wrong =
      jacobiStep(room, pairsOf(*factors.matrix), room.materials.emission, true);
  const Gathered gathered = test::gathered(room, atPatches(1));
  EXPECT_GT(worst(gathered.radiosity, wrong), 1e-2 * largest(room.materials.emission));
}

TEST(GatherAtPatches, EnergyOfEveryPassIsAccountedFor) {
  const Room room = test::loadRoom("cornell-box", 250);
  const Gathered gathered = test::gathered(room, atPatches(12));
  double before = HUGE_VAL;
  for (const GatherPass& pass : gathered.summary.passes) {
    const EnergyAccount& e = pass.energy;
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NEAR(e.emitted[b],
                  e.absorbed[b] + e.to_sky[b] + e.on_backs[b] + pass.in_flight[b] + e.imbalance[b],
                  1e-12 * e.emitted[b]);
      // One-point rows are not reciprocal; the matrix of these hemicubes is as far off.
      EXPECT_LT(std::abs(e.imbalance[b]), 0.05 * e.emitted[b]);
    }
    EXPECT_GT(pass.in_flight[0], 0);
    EXPECT_LT(pass.in_flight[0], before);  // each bounce loses some
    before = pass.in_flight[0];
  }
  // After the first pass the reflected light of the lamp is in flight: B_1 - E.
  const Gathered once = test::gathered(room, atPatches(1));
  double reflected = 0;
  for (std::size_t i = 0; i < room.mesh.size(); ++i) {
    reflected +=
        room.mesh.area[i] * (double(once.radiosity[3 * i]) - float(room.materials.emission[3 * i]));
  }
  EXPECT_NEAR(once.summary.passes[0].in_flight[0], reflected, 1e-12 * reflected);
}

TEST(GatherAtPatches, BacksAreAccountedForBySurface) {
  // A cube whose floor is turned over: the five others see its back. By the same hemicubes the
  // matrix says how much; at vertices it is the area value, 1/6 of a sixth five times over.
  test::MeshBuilder builder;
  builder.box("room", Vec3(0), Vec3(1), 6, true, false);
  builder.grid("floor", Vec3(0), {0, 1, 0}, {1, 0, 0}, 6, 6);
  Room room{builder.build(), {}};
  test::makeUniform(room, 0.5, 1.0);
  const FormFactors factors = matrixOf(room, 64);
  const Gathered gathered = test::gathered(room, atPatches(2));
  ASSERT_EQ(gathered.backs_by_surface.size(), 2U);
  EXPECT_EQ(gathered.backs_by_surface[0], 0);
  // Five sixths of the area see a fifth of the view each.
  EXPECT_NEAR(gathered.backs_by_surface[1], 5.0 / 6 * 0.2, 2e-3);
  EXPECT_NEAR(gathered.backs_by_surface[1], factors.backs_by_surface[1], 1e-12);  // rounding
  GatherOptions at_vertices = atPatches(1);
  at_vertices.at = GatherAt::vertices;
  const Gathered from_vertices = test::gathered(room, at_vertices);
  EXPECT_EQ(from_vertices.backs_by_surface[0], 0);
  // Points on a grid of six for the area: some per cent.
  EXPECT_NEAR(from_vertices.backs_by_surface[1], 5.0 / 6 * 0.2, 1e-2);
  // The shares by surface add up to those by eye.
  double sum = 0;
  double area = 0;
  for (std::size_t k = 0; k < from_vertices.area.size(); ++k) {
    sum += from_vertices.area[k] * from_vertices.backs[k];
    area += from_vertices.area[k];
  }
  EXPECT_NEAR(from_vertices.backs_by_surface[1], sum / area, 1e-7);  // backs by eye are floats
}

TEST(GatherAtPatches, TheBoundIsWithinAHundredTimesTheError) {
  const Room room = test::loadRoom("cornell-box-closed", 250);
  const Gathered limit = test::gathered(room, atPatches(120));
  for (const int passes : {1, 3, 8, 20}) {
    const Gathered gathered = test::gathered(room, atPatches(passes));
    double error = 0;
    for (std::size_t k = 0; k < limit.radiosity.size(); ++k) {
      error = std::max(error, std::abs(double(limit.radiosity[k]) - gathered.radiosity[k]));
    }
    const GatherPass& last = gathered.summary.passes.back();
    ASSERT_TRUE(last.bound);
    EXPECT_LE(error, *last.bound) << passes;
    // The largest reflectance stands for all of them: it may cost a factor of some ten.
    EXPECT_GT(error, 0.01 * *last.bound) << passes;
  }
}

TEST(GatherAtPatches, StopsOnTheBoundOrOnThePasses) {
  const Room room = test::loadRoom("furnace-cube", 96);
  GatherOptions options = atPatches(1000);
  options.tolerance = 1e-3;
  const Gathered converged = test::gathered(room, options);
  EXPECT_EQ(converged.summary.status, GatherStatus::converged);
  EXPECT_LT(converged.summary.passes.size(), 40u);
  const double wanted = 1e-3 * largest(room.materials.emission);
  const std::optional<double> last = converged.summary.passes.back().bound;
  const std::optional<double> before = converged.summary.passes.rbegin()[1].bound;
  ASSERT_TRUE(last && before);
  EXPECT_LE(*last, wanted);
  EXPECT_GT(*before, wanted);
  options.passes = 3;
  const Gathered limited = test::gathered(room, options);
  EXPECT_EQ(limited.summary.status, GatherStatus::pass_limit);
  EXPECT_EQ(limited.summary.passes.size(), 3u);
  EXPECT_NE(limited.summary.message.find("3 passes as limited"), std::string::npos);
}

TEST(GatherAtPatches, NoBoundIsClaimedInAWhiteRoom) {
  Room room = test::loadRoom("furnace-cube", 96);
  for (double& rho : room.materials.reflectance) rho = 1;
  const Gathered gathered = test::gathered(room, atPatches(5));
  EXPECT_EQ(gathered.summary.status, GatherStatus::pass_limit);
  for (const GatherPass& pass : gathered.summary.passes) EXPECT_FALSE(pass.bound);
  // Nothing is absorbed: after k passes B = (k + 1) E, to the rounding of floats.
  for (std::size_t k = 0; k < gathered.radiosity.size(); ++k) {
    const double e = room.materials.emission[k];
    EXPECT_NEAR(gathered.radiosity[k], 6 * e, 1e-5 * e);
  }
}

TEST(GatherAtPatches, DarkScenesAreReportedAndBadInputIsRefused) {
  Room room = test::loadRoom("furnace-cube", 96);
  Progress quiet;
  Room dark = room;
  for (double& e : dark.materials.emission) e = 0;
  const Gathered black = test::gathered(dark, atPatches(5));
  EXPECT_EQ(black.summary.status, GatherStatus::no_light);
  EXPECT_TRUE(black.summary.closed) << "whether it is lit or not";
  EXPECT_EQ(*std::max_element(black.radiosity.begin(), black.radiosity.end()), 0.0F);
  room.materials.reflectance[3 * 7 + 1] = 1.5;
  try {
    test::gathered(room, atPatches(1));
    FAIL() << "a reflectance of 1.5 was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("patch 7"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(GatherOptions().validate());
  for (auto spoil :
       {+[](GatherOptions& o) { o.passes = 0; }, +[](GatherOptions& o) { o.tolerance = 1; },
        +[](GatherOptions& o) { o.resolution = 17; }, +[](GatherOptions& o) { o.crease = -1; },
        +[](GatherOptions& o) { o.inset = 0; }}) {
    GatherOptions options;
    spoil(options);
    EXPECT_THROW(options.validate(), InputError);
  }
}

}  // namespace
}  // namespace radiosity
