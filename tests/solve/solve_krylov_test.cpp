// Conjugate gradients: few products however bright the walls, dark rooms right, and no answer if
// there is none.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"
#include "solve/iteration.h"
#include "solve_systems.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::Matrix;

Matrix denseOf(const ExchangeOperator& matrix) {
  const auto n = Eigen::Index(matrix.size());
  Matrix f = Matrix::Zero(n, n);
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    pairsOf(matrix).forRow(
        i, [&](Index j, double value) { f(Eigen::Index(i), Eigen::Index(j)) = value; });
  }
  return f;
}

/// A box of 4 x 3 x 2.5 m, lamp in the ceiling; form factors by the exact method.
FormFactors boxFactors(std::size_t patches, PatchMesh& mesh) {
  test::SceneBuilder builder;
  const double w = 4, d = 3, h = 2.5;
  const Index wall = builder.surface("wall", 0.5);
  builder.face(wall, {{0, 0, 0}, {w, 0, 0}, {w, d, 0}, {0, d, 0}});
  builder.face(wall, {{0, 0, h}, {0, d, h}, {w, d, h}, {w, 0, h}});
  builder.face(wall, {{0, 0, 0}, {0, d, 0}, {0, d, h}, {0, 0, h}});
  builder.face(wall, {{w, 0, 0}, {w, 0, h}, {w, d, h}, {w, d, 0}});
  builder.face(wall, {{0, 0, 0}, {0, 0, h}, {w, 0, h}, {w, 0, 0}});
  builder.face(wall, {{0, d, 0}, {w, d, 0}, {w, d, h}, {0, d, h}});
  Progress quiet;
  MeshOptions options;
  options.patches = patches;
  mesh = meshScene(builder.scene(), options, quiet).mesh;
  return computeFormFactors(mesh, {}, quiet);
}

// Jacobi takes 1,373 products at 0.99 and 13,808 at 0.999.
TEST(ConjugateGradients, SolveABrightBoxWithinFifteenProducts) {
  PatchMesh mesh;
  const FormFactors factors = boxFactors(600, mesh);
  const std::size_t n = factors.matrix->size();
  ASSERT_GT(n, 500u);
  ASSERT_TRUE(factors.matrix->isSymmetric());
  const Matrix f = denseOf(*factors.matrix);
  for (const double rho : {0.5, 0.9, 0.99, 0.999}) {
    const std::vector<double> reflectance(n * 3, rho);
    std::vector<double> emission(n * 3, 0.0);
    for (std::size_t k = 0; k < 12; ++k) emission[k] = double(k % 3 + 1);
    Progress quiet;
    const Solution s =
        solve(factors, reflectance, emission, 3, test::options(Solver::cg, 1e-6), quiet);
    ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    EXPECT_EQ(s.summary.solver, Solver::cg);
    EXPECT_LE(s.summary.iterations, 15) << rho;
    EXPECT_EQ(s.summary.rows, std::size_t(s.summary.iterations) * n) << "all bands in each product";
    const auto expected = test::direct(f, reflectance, emission, 3);
    const double largest = *std::max_element(expected.begin(), expected.end());
    EXPECT_LE(test::largestDifference(s.radiosity, expected), 1e-6 * largest) << rho;
  }
}

// Two rooms that exchange a thousandth of each one's inner exchange: Gauss-Seidel takes 582 sweeps
// at 0.99.
TEST(ConjugateGradients, SolveTwoRoomsWithinFifteenProducts) {
  const std::size_t n = 300;
  test::Random random(11);
  test::Reciprocal rooms{Matrix(n, n), random.vector(n, 0.5, 2.0)};
  for (Eigen::Index i = 0; i < Eigen::Index(n); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const bool together = (i < Eigen::Index(n / 2)) == (j < Eigen::Index(n / 2));
      rooms.f(i, j) = rooms.f(j, i) = i == j ? 0 : random(0.8, 1.0) * (together ? 1 : 0.001);
    }
  }
  const Eigen::Map<const Eigen::ArrayXd> area(rooms.area.data(), Eigen::Index(n));
  for (int k = 0; k < 200; ++k) {  // Sinkhorn: exchange areas of row i to A_i
    const Eigen::ArrayXd d = (area / rooms.f.rowwise().sum().array()).sqrt();
    rooms.f = d.matrix().asDiagonal() * rooms.f * d.matrix().asDiagonal();
  }
  for (Eigen::Index i = 0; i < Eigen::Index(n); ++i) rooms.f.row(i) /= area[i];
  const FormFactors factors = test::symmetricFactorsFrom(rooms.f, rooms.area);
  std::vector<double> emission(n, 0.0);
  emission[0] = 1;
  for (const double rho : {0.99, 0.999}) {
    const std::vector<double> reflectance(n, rho);
    Progress quiet;
    const Solution s =
        solve(factors, reflectance, emission, 1, test::options(Solver::cg, 1e-6), quiet);
    ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    EXPECT_LE(s.summary.iterations, 15) << rho;
    const auto expected = test::direct(rooms.f, reflectance, emission, 1);
    const double largest = *std::max_element(expected.begin(), expected.end());
    EXPECT_LE(test::largestDifference(s.radiosity, expected), 1e-6 * largest) << rho;
  }
}

// A lamp of a million in one room, a pinhole of 1e-6 to the next: its light there is 1e-12 of the
// lamp, and right all the same.
TEST(ConjugateGradients, SolveADarkRoomBehindAPinhole) {
  const std::size_t n = 120;
  test::Random random(3);
  auto [f, area] = test::reciprocal(n, random);
  const auto half = Eigen::Index(n / 2);
  f.topRightCorner(half, half).setZero();
  f.bottomLeftCorner(half, half).setZero();
  f(0, half) = 1e-6;
  f(half, 0) = 1e-6 * area[0] / area[n / 2];
  f *= 0.999;
  const auto rho = random.vector(n, 0.3, 0.9);
  std::vector<double> emission(n, 0.0);
  emission[5] = 1e6;
  const auto expected = test::direct(f, rho, emission, 1);
  for (const Solver solver : {Solver::cg, Solver::gmres, Solver::direct}) {
    const FormFactors factors =
        solver == Solver::gmres ? test::factorsFrom(f, area) : test::symmetricFactorsFrom(f, area);
    Progress quiet;
    const Solution s = solve(factors, rho, emission, 1, test::options(solver, 1e-6), quiet);
    ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    for (std::size_t i = n / 2; i < n; ++i) {
      ASSERT_LT(expected[i], 1.0);
      // A residual of 1e-4 of each patch's own light, bounced ten times at a reflectance of 0.9.
      EXPECT_NEAR(s.radiosity[i], expected[i], 1e-3 * expected[i]) << i;
    }
  }
}

// A body a kilometre away gets less light than rounding of the lamp leaves: its own light cannot be
// settled to a share of itself, and need not be.
TEST(ConjugateGradients, ConvergeWithABodyThatHardlyAnyLightReaches) {
  const std::size_t n = 60;
  test::Random random(5);
  auto [f, area] = test::reciprocal(n, random);
  const auto last = Eigen::Index(n - 1);
  f.row(last) *= 1e-11;
  f.col(last) *= 1e-11;
  f(last, last) = 0;
  f *= 0.999;
  const auto rho = random.vector(n, 0.3, 0.9);
  std::vector<double> emission(n, 0.0);
  emission[5] = 1e6;
  for (const Solver solver : {Solver::cg, Solver::gmres}) {
    const FormFactors factors =
        solver == Solver::gmres ? test::factorsFrom(f, area) : test::symmetricFactorsFrom(f, area);
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
      Progress quiet;
      const Solution s = solve(factors, rho, emission, 1, test::options(solver, tolerance), quiet);
      EXPECT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    }
  }
}

TEST(ConjugateGradients, RefuseRowsThatAreNotSymmetric) {
  const auto factors = test::factorsFrom(test::cube(), std::vector<double>(6, 1.0));
  Progress quiet;
  try {
    solve(factors, std::vector<double>(6, 0.5), std::vector<double>(6, 1.0), 1,
          test::options(Solver::cg, 1e-6), quiet);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("solver cg"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("use gmres or auto"), std::string::npos);
  }
}

TEST(DirectSolver, RefusesMoreUnknownsThanItCanHold) {
  const std::size_t n = kMostDirectUnknowns + 1;
  FormFactors factors;
  factors.matrix =
      std::make_shared<RowMatrix>(std::vector<double>(n, 1.0), Precision::single_precision);
  test::setAccounts(factors, 0);
  Progress quiet;
  EXPECT_THROW(solve(factors, std::vector<double>(n, 0.5), std::vector<double>(n, 1.0), 1,
                     test::options(Solver::direct, 1e-6), quiet),
               InputError);
}

TEST(AutomaticSolver, PicksByTheMatrixAndGivesTheReason) {
  test::Random random(2);
  const auto [f, area] = test::reciprocal(kFewUnknowns + 1, random);
  const std::size_t n = area.size();
  const auto solveWith = [&](const FormFactors& factors, std::size_t size) {
    Progress quiet;
    return solve(factors, std::vector<double>(size, 0.5), std::vector<double>(size, 1.0), 1, {},
                 quiet)
        .summary;
  };
  const SolveSummary cg = solveWith(test::symmetricFactorsFrom(f, area), n);
  EXPECT_EQ(cg.solver, Solver::cg);
  EXPECT_NE(cg.message.find("conjugate gradients (auto: the matrix is symmetric)"),
            std::string::npos)
      << cg.message;
  const SolveSummary gmres = solveWith(test::factorsFrom(f, area), n);
  EXPECT_EQ(gmres.solver, Solver::gmres);
  EXPECT_NE(gmres.message.find("GMRES (auto: the matrix is not symmetric)"), std::string::npos)
      << gmres.message;
  const auto small = test::factorsFrom(test::cube(), std::vector<double>(6, 1.0));
  const SolveSummary direct = solveWith(small, 6);
  EXPECT_EQ(direct.solver, Solver::direct);
  EXPECT_NE(direct.message.find("(auto: few unknowns)"), std::string::npos) << direct.message;
}

// rho F of a spectral radius of at least 1.18: no B >= 0 exists.
TEST(ConjugateGradients, ReportGrowingLight) {
  const std::size_t n = 40;
  test::Random random(8);
  auto [f, area] = test::reciprocal(n, random);
  for (Eigen::Index i = 0; i < Eigen::Index(n); ++i) f.row(i) *= area[std::size_t(i)];
  f = 0.5 * (f + Matrix(f.transpose()));
  for (Eigen::Index i = 0; i < Eigen::Index(n); ++i) f.row(i) /= area[std::size_t(i)];
  f *= 1.2 / f.rowwise().sum().minCoeff();
  const auto factors = test::symmetricFactorsFrom(f, area);
  for (const Solver solver : {Solver::cg, Solver::direct}) {
    Progress quiet;
    const std::vector<double> nearly_white(n, 0.99);
    const auto summary = solve(factors, nearly_white, std::vector<double>(n, 1.0), 1,
                               test::options(solver, 1e-6), quiet)
                             .summary;
    EXPECT_EQ(summary.status, SolveStatus::no_convergence);
    EXPECT_NE(summary.message.find("it grows"), std::string::npos) << summary.message;
    EXPECT_FALSE(summary.error_bound.has_value());
  }
}

// Light of rays beyond means of clusters, or a heat flux taken out: a right-hand side of any sign.
TEST(ConjugateGradients, TakeAnySourceOfLight) {
  const std::size_t n = 90;
  test::Random random(12);
  const auto [f, area] = test::reciprocal(n, random);
  const auto rho = random.vector(n * 2, 0.0, 1.0);
  const auto source = random.vector(n * 2, -1.0, 1.0);
  const auto expected = test::direct(f, rho, source, 2);
  const FormFactors factors = test::symmetricFactorsFrom(f, area);
  const System system(*factors.matrix, 2, rho, source);
  for (const auto run : {conjugateGradients, gmres, direct, jacobi, gaussSeidel}) {
    Progress quiet;
    Convergence convergence(1e-12, 10000, "solving", quiet);
    const Fields fields = run(system, convergence);
    EXPECT_TRUE(convergence.converged());
    // The residual over the room's least loss: some of these rows sum to nearly 1.
    EXPECT_LT(test::largestDifference(fields.radiosity, expected), 1e-10);
  }
}

TEST(MatrixRooms, ArePatchesJoinedByLight) {
  const std::size_t n = 30;
  test::Random random(4);
  Matrix f = test::reciprocal(n, random).f;
  f = 0.5 * (f + Matrix(f.transpose()));
  for (Eigen::Index i = 0; i < Eigen::Index(n); ++i) {
    for (Eigen::Index j = 0; j < Eigen::Index(n); ++j) {
      if (i % 3 != j % 3) f(i, j) = 0;
    }
  }
  f.row(7).setZero();
  f.col(7).setZero();
  const FormFactors factors = test::symmetricFactorsFrom(f, std::vector<double>(n, 1.0));
  const ExchangeOperator::Rooms rooms = factors.matrix->rooms();
  EXPECT_EQ(rooms.count, 4u);  // and patch 7 alone
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const bool joined = (i % 3 == j % 3 && i != 7 && j != 7) || i == j;
      EXPECT_EQ(rooms.of_patch[i] == rooms.of_patch[j], joined) << i << ' ' << j;
    }
  }
}

// Most rows hold a long stretch of zeros and a single entry after it, so rooms grow entry by entry.
TEST(MatrixRooms, AreJoinedBySingleEntriesOfLongRows) {
  constexpr std::size_t kPatches = 2100;
  constexpr std::size_t kRooms = 7;
  std::vector<Index> order(kPatches);
  std::iota(order.begin(), order.end(), Index(0));
  auto matrix =
      SymmetricMatrix(std::vector<double>(kPatches, 1.0), order, Precision::single_precision);
  std::mt19937 random(19);
  for (std::size_t k = 0; k + kRooms < kPatches; ++k) {
    std::vector<double> row(kPatches - k, 0.0);
    const std::size_t last = (kPatches - 1 - k) / kRooms;  // of the room's patches that follow
    row[kRooms * std::uniform_int_distribution<std::size_t>(1, last)(random)] = 1e-3;
    matrix.setUpperRow(k, row);
  }
  const ExchangeOperator::Rooms rooms = matrix.rooms();
  EXPECT_EQ(rooms.count, kRooms);
  for (std::size_t i = 0; i < kPatches; ++i) EXPECT_EQ(rooms.of_patch[i], i % kRooms) << i;
}

// Rows whose zeros are stored between values: such zeros join nothing.
TEST(MatrixRooms, AreNotJoinedByStoredZeros) {
  constexpr std::size_t kPatches = 1400;
  std::vector<Index> order(kPatches);
  std::iota(order.begin(), order.end(), Index(0));
  auto matrix =
      SymmetricMatrix(std::vector<double>(kPatches, 1.0), order, Precision::single_precision);
  for (std::size_t k = 0; k + 1 < kPatches; ++k) {
    std::vector<double> row(kPatches - k, 0.0);
    for (std::size_t m = 2; m < row.size(); m += 2) row[m] = 1e-4;
    matrix.setUpperRow(k, row);
  }
  const ExchangeOperator::Rooms rooms = matrix.rooms();
  EXPECT_EQ(rooms.count, 2u);
  for (std::size_t i = 0; i < kPatches; ++i) EXPECT_EQ(rooms.of_patch[i], i % 2) << i;
}

}  // namespace
}  // namespace radiosity
