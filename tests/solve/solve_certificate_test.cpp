// The bound that comes with a solution holds, is not idle, and is withheld where none exists.
#include <gtest/gtest.h>

#include <algorithm>

#include "solve_systems.h"

namespace radiosity {
namespace {

using test::kSolvers;
using test::Matrix;

// 300 systems, rows up to 1.1, some white patches, tolerances from 1e-1 to 1e-14 (below what
// rounding lets anyone know), by every solver: the bound is above the true error in each. A proof
// needs a solution of some accuracy: coarse ones of rows above 1 may go without.
TEST(Certificate, BoundsTheTrueError) {
  std::vector<double> slack;
  int withheld = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    test::Random random(1000 + seed);
    const auto n = std::size_t(random(6, 40));
    const double top = seed % 2 == 0 ? 1.0 : 1.1;
    const auto f = random.rows(Eigen::Index(n), [&](auto) { return random(0.6, top); });
    const auto factors = test::factorsFrom(f, random.vector(n, 0.5, 2.0));
    auto rho = random.vector(n * 2, 0.1, 0.95);
    if (seed % 3 == 0) rho[0] = rho[1] = 1.0;
    auto emission = random.vector(n * 2, 0.0, 1.0);
    if (seed % 5 == 0) {
      for (double& e : emission) e *= 1e-9;
    }
    const double tolerance = std::pow(10.0, -random(1, 14));
    const auto truth = test::direct(f, rho, emission, 2);
    for (const Solver solver : kSolvers) {
      Progress quiet;
      const Solution s = solve(factors, rho, emission, 2, test::options(solver, tolerance), quiet);
      ASSERT_EQ(s.summary.status, SolveStatus::converged) << seed << ": " << s.summary.message;
      if (!s.summary.error_bound) {
        EXPECT_TRUE(tolerance > 1e-2 && top > 1) << seed;
        ++withheld;
        continue;
      }
      const double error = test::largestDifference(s.radiosity, truth);
      EXPECT_LE(error, *s.summary.error_bound) << "seed " << seed << ", n " << n;
      if (tolerance > 1e-10 && error > 0) slack.push_back(*s.summary.error_bound / error);
    }
  }
  EXPECT_LE(withheld, 3 * int(std::size(kSolvers)));  // 1% of the systems
  std::sort(slack.begin(), slack.end());
  // Not idle: 1 - max rho rowsum is about 0.05 to 0.1 here and the mean is about 0.5.
  EXPECT_LT(slack[slack.size() / 2], 20.0);
}

// Iterated until rounding stops it, the computed residual is 0 or about a last digit and says less
// than it should; the bound includes what rounding may have hidden.
TEST(Certificate, CoversRounding) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    test::Random random(2000 + seed);
    const std::size_t n = 30;
    const auto f = random.rows(Eigen::Index(n), [](auto) { return 1.0; });
    const auto factors = test::factorsFrom(f, std::vector<double>(n, 1.0));
    const auto rho = random.vector(n, 0.5, 0.9);
    const auto emission = random.vector(n, 0.0, 1.0);
    Progress quiet;
    for (const Solver solver : kSolvers) {
      const auto options = test::options(solver, 1e-300, 500);
      const Solution s = solve(factors, rho, emission, 1, options, quiet);
      EXPECT_LT(s.summary.residual, 1e-14);
      const double bound = s.summary.error_bound.value_or(0.0);
      EXPECT_LE(test::largestDifference(s.radiosity, test::direct(f, rho, emission, 1)), bound);
      EXPECT_LT(bound, 1e-11);  // 1e-14 of rounding over 1 - rho, on B of about 3
    }
  }
}

// The all-ones vector fails (row 0 sums to 1.2 and reflects all of it), the rough solve succeeds.
TEST(Certificate, SurvivesRowsAboveOne) {
  Matrix f(3, 3);
  f << 0.0, 0.6, 0.6, 0.3, 0.0, 0.5, 0.4, 0.4, 0.0;
  const auto factors = test::factorsFrom(f, {1.0, 1.0, 1.0});
  const std::vector<double> rho{1.0, 0.5, 0.5};
  const std::vector<double> emission{1.0, 0.0, 0.0};
  Progress quiet;
  const Solution s = solve(factors, rho, emission, 1, test::options(Solver::jacobi, 1e-3), quiet);
  const double bound = s.summary.error_bound.value_or(0.0);
  const double error = test::largestDifference(s.radiosity, test::direct(f, rho, emission, 1));
  EXPECT_GT(error, 0.0);
  EXPECT_GE(bound, error);
  EXPECT_LT(bound, 0.1);
}

// rho F = 1.05 times a stochastic matrix: no w > 0 has (I - rho F) w > 0, and nothing converges.
TEST(Certificate, NoneWhereTheIterationDiverges) {
  test::Random random(3);
  const auto f = random.rows(12, [](auto) { return 1.05; });
  const auto factors = test::factorsFrom(f, std::vector<double>(12, 1.0));
  const std::vector<double> rho(12, 1.0);
  std::vector<double> emission(12, 1.0);
  for (const Solver solver : kSolvers) {
    for (const int sweeps : {20, 10000}) {  // before and after it shows
      Progress quiet;
      const auto factors_open = [&] {
        auto open = factors;
        open.sky[0] = 0.01;  // so that it is not refused as singular
        return open;
      }();
      const auto summary =
          solve(factors_open, rho, emission, 1, test::options(solver, 1e-6, sweeps), quiet).summary;
      EXPECT_EQ(summary.status, SolveStatus::no_convergence);
      EXPECT_FALSE(summary.error_bound.has_value());
      EXPECT_FALSE(summary.usable());
      EXPECT_NE(summary.message.find("no certificate"), std::string::npos) << summary.message;
      EXPECT_LT(summary.iterations, 2000);  // it gives up once the residual is out of bounds
    }
  }
}

TEST(Certificate, AnUnconvergedSolutionIsStillBounded) {
  const auto factors = test::factorsFrom(test::cube(), std::vector<double>(6, 1.0));
  const std::vector<double> rho(6, 0.9);
  const std::vector<double> emission{1, 0, 0, 0, 0, 0};
  const auto expected = test::direct(test::cube(), rho, emission, 1);
  for (const Solver solver : test::kIterations) {
    Progress quiet;
    const Solution s = solve(factors, rho, emission, 1, test::options(solver, 1e-9, 3), quiet);
    EXPECT_EQ(s.summary.status, SolveStatus::no_convergence);
    EXPECT_EQ(s.summary.iterations, 3);
    const double bound = s.summary.error_bound.value_or(0.0);
    EXPECT_GT(bound, 0.0);
    EXPECT_LE(test::largestDifference(s.radiosity, expected), bound);
    EXPECT_NE(s.summary.message.find("not usable"), std::string::npos);
  }
}

}  // namespace
}  // namespace radiosity
