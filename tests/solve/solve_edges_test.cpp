// White rooms, darkness, extreme scales, refusals, cancelling.
#include <gtest/gtest.h>

#include <cmath>

#include "solve_systems.h"

namespace radiosity {
namespace {

using test::kSolvers;
using test::Matrix;

/// Two cubes side by side that do not see each other: patches 0 to 5 and 6 to 11.
Matrix twoCubes() {
  Matrix f = Matrix::Zero(12, 12);
  f.topLeftCorner(6, 6) = test::cube();
  f.bottomRightCorner(6, 6) = test::cube();
  return f;
}

const std::vector<Index> kGroup{0, 1, 1, 1, 1, 1, 2, 3, 3, 3, 3, 3};
const std::vector<std::string> kNames{"cellar/floor", "cellar/wall", "attic/floor", "attic/wall"};

struct TwoRooms {
  FormFactors factors = test::factorsFrom(twoCubes(), std::vector<double>(12, 1.0));
  std::vector<double> rho = std::vector<double>(12, 0.5);
  std::vector<double> emission = std::vector<double>(12, 0.0);

  TwoRooms() {
    // The accounts of a closed scene have no sky; the helper's is rounding of the row sums.
    factors.sky.assign(12, 0.0);
    emission[0] = emission[6] = 1.0;
  }
  Solution solve(Solver solver = Solver::automatic, double tolerance = 1e-10) const {
    Progress quiet;
    return radiosity::solve(factors, rho, emission, 1, test::options(solver, tolerance, 2000),
                            quiet, kGroup, kNames);
  }
  void whitenAttic() { std::fill(rho.begin() + 6, rho.end(), 1.0); }
};

TEST(SolveSingular, AWhiteClosedRoomIsRefusedByName) {
  TwoRooms rooms;
  rooms.whitenAttic();
  for (const Solver solver : kSolvers) {
    const Solution s = rooms.solve(solver);
    EXPECT_EQ(s.summary.status, SolveStatus::singular);
    EXPECT_FALSE(s.summary.usable());
    EXPECT_TRUE(s.radiosity.empty());
    EXPECT_NE(s.summary.message.find("attic/floor, attic/wall"), std::string::npos)
        << s.summary.message;
    EXPECT_EQ(s.summary.message.find("cellar"), std::string::npos) << s.summary.message;
  }
}

TEST(SolveSingular, OneAbsorberWindowOrBackMakesASolution) {
  TwoRooms absorber;
  absorber.whitenAttic();
  absorber.rho[9] = 0.5;
  EXPECT_EQ(absorber.solve().summary.status, SolveStatus::converged);
  // Power in = power absorbed by the one patch: 1 = (1 - rho) H.
  EXPECT_NEAR(absorber.solve().irradiance[9], 2.0, 1e-8);  // residual over 1 - rho / 6
  TwoRooms window;
  window.whitenAttic();
  Matrix open = twoCubes();
  open.bottomRows(6) *= 0.8;
  window.factors.matrix = test::factorsFrom(open, std::vector<double>(12, 1.0)).matrix;
  for (Index j = 6; j < 12; ++j) {
    (j % 2 == 0 ? window.factors.sky : window.factors.backs)[j] = 0.2;
  }
  const Solution s = window.solve();
  EXPECT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
  EXPECT_NEAR(s.summary.energy.to_sky[0] + s.summary.energy.on_backs[0], 1.0, 1e-8);
}

// The white patches of rows 0 and 1 see each other alone. Patch 2 absorbs, but only sees them.
TEST(SolveSingular, AnUnseenAbsorberDoesNotHelp) {
  Matrix f(3, 3);
  f << 0.5, 0.5, 0.0, 1.0, 0.0, 0.0, 0.5, 0.5, 0.0;
  const auto factors = test::factorsFrom(f, {1.0, 1.0, 1.0});
  Progress quiet;
  const std::vector<double> rho{1.0, 1.0, 0.2};
  const std::vector<double> lit{1.0, 0.0, 0.0};
  const auto summary = solve(factors, rho, lit, 1, {}, quiet).summary;
  EXPECT_EQ(summary.status, SolveStatus::singular);
  EXPECT_NE(summary.message.find("patch 0, patch 1"), std::string::npos) << summary.message;
  // Light outside the white pair never comes in: it is dark, and the rest has a solution.
  const std::vector<double> outside{0.0, 0.0, 1.0};
  const Solution s = solve(factors, rho, outside, 1, {}, quiet);
  EXPECT_EQ(s.summary.status, SolveStatus::converged);
  EXPECT_EQ(s.radiosity, outside);
}

TEST(SolveSingular, AWhiteRoomWithoutLightStaysDark) {
  TwoRooms rooms;
  rooms.whitenAttic();
  rooms.emission[6] = 0;
  for (const Solver solver : kSolvers) {
    const Solution s = rooms.solve(solver);
    EXPECT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    for (std::size_t i = 6; i < 12; ++i) EXPECT_EQ(s.radiosity[i], 0.0);
    EXPECT_GT(s.radiosity[3], 0.1);
  }
}

TEST(SolveSingular, OnlyAWhiteAndLitBandIsSingular) {
  const TwoRooms rooms;
  std::vector<double> rho(36, 0.5);
  std::vector<double> emission(36, 0.0);
  for (std::size_t i = 6; i < 12; ++i) rho[i * 3 + 2] = 1.0;
  emission[0] = emission[18] = 1.0;  // band 0 in both rooms
  Progress quiet;
  EXPECT_EQ(solve(rooms.factors, rho, emission, 3, {}, quiet).summary.status,
            SolveStatus::converged);
  emission[20] = 1.0;  // band 2 in the attic
  const auto summary = solve(rooms.factors, rho, emission, 3, {}, quiet).summary;
  EXPECT_EQ(summary.status, SolveStatus::singular);
  EXPECT_NE(summary.message.find("band 2"), std::string::npos) << summary.message;
}

// rho = 1 - 1e-9 in a furnace takes 1e10 sweeps of Jacobi: the limit comes first and is reported as
// such; the true residual after k sweeps is rho^(k). Others find B = E / (1 - rho) = 1e9, to the
// rounding of 1 - rho (1e-16 of 1e-9) and of the rows' sums.
TEST(SolveSingular, ANearlyWhiteRoomIsSolvedOrReported) {
  TwoRooms rooms;
  std::fill(rooms.rho.begin(), rooms.rho.end(), 1 - 1e-9);
  std::fill(rooms.emission.begin(), rooms.emission.end(), 1.0);
  const auto jacobi = rooms.solve(Solver::jacobi).summary;
  EXPECT_EQ(jacobi.status, SolveStatus::no_convergence);
  EXPECT_GT(jacobi.residual, 0.99);
  EXPECT_FALSE(jacobi.usable());
  for (const Solver solver : {Solver::gmres, Solver::direct}) {
    const Solution s = rooms.solve(solver, 1e-6);  // 1e-16 of B = 1e9 is 1e-7 of E
    EXPECT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    for (const double b : s.radiosity) EXPECT_NEAR(b, 1e9, 1e9 * 1e-6);
  }
}

TEST(SolveEdges, AnUnlitRoomIsDark) {
  TwoRooms rooms;
  std::fill(rooms.emission.begin(), rooms.emission.end(), 0.0);
  std::fill(rooms.rho.begin(), rooms.rho.end(), 1.0);
  const Solution s = rooms.solve();
  EXPECT_EQ(s.summary.status, SolveStatus::no_light);
  EXPECT_TRUE(s.summary.usable());
  EXPECT_EQ(s.summary.iterations, 0);
  EXPECT_EQ(s.radiosity, std::vector<double>(12, 0.0));
  EXPECT_EQ(s.irradiance, std::vector<double>(12, 0.0));
  Progress quiet;
  EXPECT_EQ(solve(test::factorsFrom(Matrix(), {}), {}, {}, 3, {}, quiet).summary.status,
            SolveStatus::no_light);
}

// A dark band is exactly 0 and the lit ones are as if alone.
TEST(SolveEdges, DarkBandsCostNothingAndChangeNothing) {
  test::Random random(4);
  const auto f = random.rows(30, [&](auto) { return random(0.5, 1.0); });
  const auto factors = test::factorsFrom(f, std::vector<double>(30, 1.0));
  const auto rho = random.vector(30, 0.2, 0.9);
  const auto emission = random.vector(30, 0.0, 1.0);
  std::vector<double> wide_rho(90, 0.7);
  std::vector<double> wide_emission(90, 0.0);
  for (std::size_t i = 0; i < 30; ++i) {
    wide_rho[i * 3 + 1] = rho[i];
    wide_emission[i * 3 + 1] = emission[i];
  }
  for (const Solver solver : kSolvers) {
    Progress quiet;
    const auto alone = solve(factors, rho, emission, 1, test::options(solver, 1e-8), quiet);
    const auto wide =
        solve(factors, wide_rho, wide_emission, 3, test::options(solver, 1e-8), quiet);
    EXPECT_EQ(wide.summary.iterations, alone.summary.iterations);
    EXPECT_EQ(wide.summary.error_bound, alone.summary.error_bound);
    for (std::size_t k = 0; k < 90; ++k) {
      EXPECT_EQ(wide.radiosity[k], k % 3 == 1 ? alone.radiosity[k / 3] : 0.0);
      EXPECT_EQ(wide.irradiance[k], k % 3 == 1 ? alone.irradiance[k / 3] : 0.0);
    }
  }
}

// All stopping is relative: powers of two change no bit, other scales only rounding.
TEST(SolveEdges, EmissionMayHaveAnyScale) {
  test::Random random(6);
  const auto f = random.rows(40, [&](auto) { return random(0.5, 1.0); });
  const auto factors = test::factorsFrom(f, std::vector<double>(40, 1.0));
  const auto rho = random.vector(120, 0.2, 0.9);
  const auto emission = random.vector(120, 0.0, 1.0);
  for (const Solver solver : kSolvers) {
    Progress quiet;
    const auto reference = solve(factors, rho, emission, 3, test::options(solver, 1e-9), quiet);
    for (const double factor : {std::ldexp(1.0, 40), std::ldexp(1.0, -40), 1e12, 1e-12}) {
      auto scaled = emission;
      for (double& e : scaled) e *= factor;
      const auto s = solve(factors, rho, scaled, 3, test::options(solver, 1e-9), quiet);
      EXPECT_EQ(s.summary.iterations, reference.summary.iterations);
      int exponent = 0;
      const bool power_of_two = std::frexp(factor, &exponent) == 0.5;
      for (std::size_t k = 0; k < 120; ++k) {
        const double expected = reference.radiosity[k] * factor;
        // 40 additions and about 50 sweeps that forget earlier rounding.
        EXPECT_NEAR(s.radiosity[k], expected, power_of_two ? 0.0 : 1e-13 * expected);
      }
    }
  }
}

TEST(SolveEdges, ThreadsAndStorageDoNotChangeABit) {
  test::Random random(7);
  const auto f = random.rows(300, [&](auto) { return random(0.5, 1.0); });
  const auto dense =
      test::factorsFrom(f, std::vector<double>(300, 1.0), 0, Precision::single_precision);
  // Padded with patches that see nothing, the same rows are stored sparse.
  Matrix padded = Matrix::Zero(900, 900);
  padded.topLeftCorner(300, 300) = f;
  const auto sparse =
      test::factorsFrom(padded, std::vector<double>(900, 1.0), 0, Precision::single_precision);
  ASSERT_GT(dynamic_cast<const RowMatrix&>(*dense.matrix).denseRows(), 200u);
  ASSERT_EQ(dynamic_cast<const RowMatrix&>(*sparse.matrix).denseRows(), 0u);
  auto rho = random.vector(900, 0.2, 0.9);
  auto emission = random.vector(900, 0.0, 1.0);
  auto wide_rho = rho;
  auto wide_emission = emission;
  wide_rho.resize(2700, 0.0);
  wide_emission.resize(2700, 0.0);
  for (const Solver solver : test::kIterations) {
    Progress quiet;
    const auto reference = solve(dense, rho, emission, 3, {.solver = solver}, quiet);
    setThreads(1);
    const auto one_thread = solve(dense, rho, emission, 3, {.solver = solver}, quiet);
    setThreads(0);
    EXPECT_EQ(one_thread.radiosity, reference.radiosity);
    EXPECT_EQ(one_thread.irradiance, reference.irradiance);
    auto wide = solve(sparse, wide_rho, wide_emission, 3, {.solver = solver}, quiet);
    wide.radiosity.resize(900);
    EXPECT_EQ(wide.radiosity, reference.radiosity);
  }
}

TEST(SolveEdges, BlackAndSinglePatchesKeepTheirEmission) {
  const auto alone = test::factorsFrom(Matrix::Zero(1, 1), {2.0});
  const std::vector<double> one{1.0};
  const std::vector<double> cube_emission{1, 2, 3, 4, 5, 6};
  const auto factors = test::factorsFrom(test::cube(), std::vector<double>(6, 1.0));
  for (const Solver solver : kSolvers) {
    Progress quiet;
    const auto single = solve(alone, one, one, 1, {.solver = solver}, quiet);
    EXPECT_EQ(single.summary.status, SolveStatus::converged) << single.summary.message;
    EXPECT_EQ(single.radiosity, one);
    EXPECT_EQ(single.summary.energy.to_sky[0], 2.0);
    const auto black =
        solve(factors, std::vector<double>(6, 0.0), cube_emission, 1, {.solver = solver}, quiet);
    EXPECT_EQ(black.summary.iterations, 1);
    EXPECT_EQ(black.radiosity, cube_emission);
    EXPECT_EQ(black.summary.residual, 0.0);
  }
}

// A cave, one patch that sees itself alone: Gauss-Seidel solves its row for B_0, all bounces at
// once, and needs a second sweep only to notice. Jacobi halves the residual a sweep.
TEST(SolveEdges, GaussSeidelSolvesTheDiagonal) {
  const auto cave = test::factorsFrom(Matrix::Ones(1, 1), {1.0});
  const std::vector<double> rho{0.5};
  const std::vector<double> emission{1.0};
  Progress quiet;
  const auto seidel = solve(cave, rho, emission, 1, {.solver = Solver::gauss_seidel}, quiet);
  EXPECT_EQ(seidel.radiosity[0], 2.0);
  EXPECT_EQ(seidel.summary.iterations, 2);
  const auto jacobi = solve(cave, rho, emission, 1, {.solver = Solver::jacobi}, quiet);
  EXPECT_EQ(jacobi.summary.iterations, 20);  // 2^-20 is the first power below 1e-6
}

/// The message with which solve() refuses.
std::string refusal(const std::vector<double>& rho, const std::vector<double>& emission, int bands,
                    const SolveOptions& options = {}) {
  const TwoRooms rooms;
  Progress quiet;
  try {
    solve(rooms.factors, rho, emission, bands, options, quiet, kGroup, kNames);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SolveEdges, RefusesBadInputByPatchAndSurface) {
  const std::vector<double> good(12, 0.5);
  EXPECT_EQ(refusal(good, good, 1), "");
  for (const double bad : {-0.1, 1.0000001, std::nan(""), double(INFINITY)}) {
    auto rho = good;
    rho[7] = bad;
    EXPECT_NE(refusal(rho, good, 1).find("patch 7 of surface \"attic/wall\": reflectance"),
              std::string::npos);
  }
  for (const double bad : {-0.1, std::nan(""), double(INFINITY)}) {
    auto emission = good;
    emission[0] = bad;
    EXPECT_NE(refusal(good, emission, 1).find("patch 0 of surface \"cellar/floor\": emission"),
              std::string::npos);
  }
  EXPECT_NE(refusal(good, good, 3).find("12 reflectance values where 36"), std::string::npos);
  EXPECT_NE(refusal(good, good, 0).find("0 bands"), std::string::npos);
  for (const double tolerance : {0.0, -1.0, 1.0, std::nan("")}) {
    EXPECT_NE(refusal(good, good, 1, {.tolerance = tolerance}).find("tolerance"),
              std::string::npos);
  }
  EXPECT_NE(refusal(good, good, 1, {.max_iterations = 0}).find("max_iterations"),
            std::string::npos);
  EXPECT_NO_THROW(SolveOptions{}.validate());
}

TEST(SolveEdges, CancelsBetweenSweeps) {
  struct CancelAtOnce : Progress {
    void begin(const std::string&, std::size_t, const std::string&, std::size_t) override {
      cancel();
    }
  };
  const TwoRooms rooms;
  for (const Solver solver : kSolvers) {
    CancelAtOnce progress;
    EXPECT_THROW(solve(rooms.factors, rooms.rho, rooms.emission, 1, {.solver = solver}, progress),
                 Cancelled);
  }
}

}  // namespace
}  // namespace radiosity
