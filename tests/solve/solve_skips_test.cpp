// Work that a scene does not need: counted, and without effect on the results.
#include <gtest/gtest.h>

#include <cmath>

#include "solve_systems.h"

namespace radiosity {
namespace {

constexpr std::size_t kPatches = 150;

/// A reciprocal room in both storage forms; every third patch is to be black.
struct Room {
  test::Random random{3};
  test::Reciprocal room = test::reciprocal(kPatches, random);
  std::vector<FormFactors> forms = {test::factorsFrom(room.f, room.area),
                                    test::symmetricFactorsFrom(room.f, room.area)};
  std::vector<double> rho = random.vector(kPatches, 0.2, 0.9);
  std::vector<double> emission = random.vector(kPatches, 0.0, 2.0);
  std::size_t black = 0;

  Room() {
    for (std::size_t i = 0; i < kPatches; i += 3, ++black) rho[i] = 0;
    for (std::size_t i = 0; i < kPatches; i += 6) emission[i] = 0;  // black and dark
  }
};

/// Runs a fixed number of sweeps, so that a second band does not change when the first one stops.
SolveOptions sweeps(Solver solver, int count) { return test::options(solver, 1e-300, count); }

// A second band in which every patch reflects makes every row needed.
TEST(SolveSkips, BlackPatchesNeedNoRow) {
  const Room room;
  std::vector<double> wide_rho(2 * kPatches, 0.5);
  std::vector<double> wide_emission(2 * kPatches, 1.0);
  for (std::size_t i = 0; i < kPatches; ++i) {
    wide_rho[2 * i] = room.rho[i];
    wide_emission[2 * i] = room.emission[i];
  }
  for (const FormFactors& factors : room.forms) {
    for (const Solver solver : test::iterationsOf(factors)) {
      Progress quiet;
      const auto skipping = solve(factors, room.rho, room.emission, 1, sweeps(solver, 7), quiet);
      const auto full = solve(factors, wide_rho, wide_emission, 2, sweeps(solver, 7), quiet);
      EXPECT_EQ(skipping.summary.skipped.black_patches, room.black);
      EXPECT_EQ(skipping.summary.rows, 7 * (kPatches - room.black));
      EXPECT_EQ(full.summary.skipped.black_patches, 0u);
      EXPECT_EQ(full.summary.rows, 7 * kPatches);
      for (std::size_t i = 0; i < kPatches; ++i) {
        EXPECT_EQ(skipping.radiosity[i], full.radiosity[2 * i]);
        EXPECT_EQ(skipping.irradiance[i], full.irradiance[2 * i]);
        if (room.rho[i] == 0) {
          EXPECT_EQ(skipping.radiosity[i], room.emission[i]);
        }
        EXPECT_GT(skipping.irradiance[i], 0.0);  // black patches are lit, too
      }
    }
  }
}

// Black in the red band alone is not black.
TEST(SolveSkips, BlackPatchesAreBlackInEveryBandSolved) {
  const Room room;
  std::vector<double> rho(3 * kPatches, 0.5);
  std::vector<double> emission(3 * kPatches, 1.0);
  for (std::size_t i = 0; i < kPatches; ++i) rho[3 * i] = room.rho[i];
  Progress quiet;
  const auto blackPatches = [&] {
    return solve(room.forms[1], rho, emission, 3, {}, quiet).summary.skipped.black_patches;
  };
  EXPECT_EQ(blackPatches(), 0u);
  for (std::size_t i = 0; i < kPatches; ++i) emission[3 * i + 1] = emission[3 * i + 2] = 0;
  EXPECT_EQ(blackPatches(), room.black);  // green and blue are dark: only red is solved
}

TEST(SolveSkips, EqualBandsAreSolvedOnceAndDarkOnesNot) {
  const Room room;
  std::vector<double> rho(5 * kPatches);
  std::vector<double> emission(5 * kPatches, 0.0);
  for (std::size_t i = 0; i < kPatches; ++i) {
    const double other = 0.5 * room.rho[i];
    const double bands[] = {room.rho[i], other, room.rho[i], room.rho[i], other};
    std::copy(std::begin(bands), std::end(bands), &rho[5 * i]);
    for (const std::size_t b : {0, 1, 3, 4}) emission[5 * i + b] = room.emission[i];  // 2 is dark
  }
  emission[4] *= 2;  // so that band 4 is not band 1
  emission[5 * 7 + 4] += 1;
  for (const FormFactors& factors : room.forms) {
    for (const Solver solver : test::iterationsOf(factors)) {
      Progress quiet;
      const auto alone = solve(factors, room.rho, room.emission, 1, sweeps(solver, 6), quiet);
      const auto all = solve(factors, rho, emission, 5, sweeps(solver, 6), quiet);
      EXPECT_EQ(all.summary.skipped.dark_bands, 1);
      EXPECT_EQ(all.summary.skipped.equal_bands, 1);
      EXPECT_EQ(alone.summary.skipped.dark_bands, 0);
      EXPECT_EQ(alone.summary.skipped.equal_bands, 0);
      for (std::size_t i = 0; i < kPatches; ++i) {
        for (const std::size_t b : {0, 3}) {
          EXPECT_EQ(all.radiosity[5 * i + b], alone.radiosity[i]);
          EXPECT_EQ(all.irradiance[5 * i + b], alone.irradiance[i]);
        }
        EXPECT_EQ(all.radiosity[5 * i + 2], 0.0);
        EXPECT_EQ(all.irradiance[5 * i + 2], 0.0);
      }
      EXPECT_NE(all.radiosity[5 * 7 + 1], all.radiosity[5 * 7 + 4]);
    }
  }
}

TEST(SolveSkips, DarkScenesReadNoRows) {
  const Room room;
  Progress quiet;
  const auto dark =
      solve(room.forms[0], room.rho, std::vector<double>(kPatches, 0.0), 1, {}, quiet);
  EXPECT_EQ(dark.summary.status, SolveStatus::no_light);
  EXPECT_EQ(dark.summary.skipped.dark_bands, 1);
  EXPECT_EQ(dark.summary.skipped.black_patches, 0u);
  EXPECT_EQ(dark.summary.rows, 0u);
}

TEST(SolveSkips, ThreadsDoNotChangeABit) {
  const Room room;
  for (const FormFactors& factors : room.forms) {
    for (const Solver solver : test::iterationsOf(factors)) {
      Progress quiet;
      const auto reference = solve(factors, room.rho, room.emission, 1, {.solver = solver}, quiet);
      for (const int threads : {1, 2, 4}) {
        setThreads(threads);
        const auto other = solve(factors, room.rho, room.emission, 1, {.solver = solver}, quiet);
        EXPECT_EQ(other.radiosity, reference.radiosity);
        EXPECT_EQ(other.irradiance, reference.irradiance);
        EXPECT_EQ(other.summary.error_bound, reference.summary.error_bound);
      }
      setThreads(0);
    }
  }
}

}  // namespace
}  // namespace radiosity
