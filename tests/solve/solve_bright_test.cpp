// Bright walls: few sweeps, and a bound that costs no more than the solution.
#include <gtest/gtest.h>

#include "solve_systems.h"

namespace radiosity {
namespace {

/// A closed room of n patches; `coupling`: how much its two halves exchange, 1: as one room.
test::Reciprocal rooms(std::size_t n, double coupling) {
  test::Random random(7);
  test::Reciprocal out{test::Matrix(n, n), std::vector<double>(n, 1.0)};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const bool together = (i < n / 2) == (j < n / 2);
      out.f(Eigen::Index(i), Eigen::Index(j)) = out.f(Eigen::Index(j), Eigen::Index(i)) =
          i == j ? 0 : random(0.5, 1.0) * (together ? 1 : coupling);
    }
  }
  // Sinkhorn: rows of a symmetric matrix to 1.
  for (int k = 0; k < 200; ++k) {
    const Eigen::VectorXd d = out.f.rowwise().sum().cwiseSqrt().cwiseInverse();
    out.f = d.asDiagonal() * out.f * d.asDiagonal();
  }
  return out;
}

// Gauss-Seidel needs 6,905 sweeps at 0.999 in one room, and hundreds more where a second room
// hardly exchanges light with it.
TEST(BrightWalls, TakeAboutADozenSweeps) {
  const std::size_t n = 200;
  for (const double coupling : {1.0, 0.01, 0.0001}) {
    const auto [f, area] = rooms(n, coupling);
    const auto raw = test::factorsFrom(f, area);
    const auto symmetric = test::symmetricFactorsFrom(f, area);
    for (const double rho : {0.9, 0.99, 0.999, 0.999999}) {
      std::vector<double> emission(n, 0.0);
      emission[3] = 1;
      emission[5] = 0.5;
      const std::vector<double> reflectance(n, rho);
      // The true error: a direct solver's, in 64-bit mantissas.
      const auto expected = test::direct(f, reflectance, emission, 1);
      for (const Solver solver : {Solver::gmres, Solver::cg}) {
        Progress quiet;
        const Solution s = solve(solver == Solver::cg ? symmetric : raw, reflectance, emission, 1,
                                 test::options(solver, 1e-8), quiet);
        ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
        // A step a bounce pattern that survives, and one more for each room: 8 to 17.
        EXPECT_LE(s.summary.iterations, 20) << coupling << ' ' << rho;
        ASSERT_TRUE(s.summary.error_bound.has_value()) << s.summary.message;
        EXPECT_LE(test::largestDifference(s.radiosity, expected), *s.summary.error_bound);
      }
    }
  }
}

// The inside of a white body that nothing lights, whose rows sum to a rounding more than 1.
TEST(BrightWalls, OfADarkRoomAreLeftOut) {
  const std::size_t n = 200;
  auto [f, area] = rooms(n, 0);
  f.bottomRightCorner(n / 2, n / 2) *= 1 + 1e-7;
  std::vector<double> emission(n, 0.0);
  emission[3] = 1;
  std::vector<double> reflectance(n, 0.9);
  std::fill(reflectance.begin() + n / 2, reflectance.end(), 1.0);
  const auto expected = test::direct(f, reflectance, emission, 1);
  Progress quiet;
  const Solution s = solve(test::symmetricFactorsFrom(f, area), reflectance, emission, 1,
                           test::options(Solver::cg, 1e-8), quiet);
  ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
  // A residual of 1e-8 over 1 - rho.
  EXPECT_LE(test::largestDifference(s.radiosity, expected), 1e-7);
  for (std::size_t i = n / 2; i < n; ++i) EXPECT_EQ(s.radiosity[i], 0);
}

// No wall absorbs, one opening lets light out: the spectral radius is 1 but for the opening.
TEST(BrightWalls, OfReflectanceOneConvergeThroughAnOpening) {
  const std::size_t n = 200;
  auto [f, area] = rooms(n, 0.01);
  f.row(17) *= 0.9;
  f.col(17) *= 0.9;
  std::vector<double> emission(n, 0.0);
  emission[150] = 1;
  const std::vector<double> reflectance(n, 1.0);
  for (const Solver solver : {Solver::gmres, Solver::cg}) {
    const auto factors =
        solver == Solver::cg ? test::symmetricFactorsFrom(f, area) : test::factorsFrom(f, area);
    Progress quiet;
    const Solution s = solve(factors, reflectance, emission, 1, test::options(solver, 1e-6), quiet);
    ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    EXPECT_LE(s.summary.iterations, 20);
    for (std::size_t i = 0; i < n; ++i) EXPECT_GE(s.radiosity[i], emission[i]) << i;
  }
}

// Rows that sum to more than 1 need a vector of their own for the bound, and that takes sweeps:
// two, as many as the solution was given, are not enough.
TEST(BrightWalls, ABoundOutOfTimeIsReported) {
  test::Random random(5);
  const Eigen::Index n = 100;
  const auto factors = test::factorsFrom(
      random.rows(n, [](auto i) { return i % 2 == 0 ? 1.2 : 0.7; }), std::vector<double>(100, 1.0));
  const std::vector<double> emission(100, 1.0);
  const std::vector<double> reflectance(100, 1.0);
  const auto run = [&](int sweeps) {
    Progress quiet;
    return solve(factors, reflectance, emission, 1,
                 test::options(Solver::gauss_seidel, 1e-6, sweeps), quiet)
        .summary;
  };
  const SolveSummary short_run = run(2);
  EXPECT_FALSE(short_run.error_bound.has_value());
  EXPECT_NE(
      short_run.message.find(
          "no certificate: the error could not be bounded in the time that the solution took"),
      std::string::npos)
      << short_run.message;
  EXPECT_TRUE(run(1000).error_bound.has_value()) << "given its time, it is found";
}

}  // namespace
}  // namespace radiosity
