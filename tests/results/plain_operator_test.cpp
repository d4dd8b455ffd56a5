// Form factors that store no pairs: what solvers, heat and tables do with an operator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "radiosity/heat.h"
#include "radiosity/matrix_functions.h"
#include "radiosity/results.h"
#include "solve/solve_systems.h"

namespace radiosity {
namespace {

/// The least that an operator has: sizes, areas, a product, a row.
class PlainOperator final : public ExchangeOperator {
 public:
  explicit PlainOperator(const ExchangeOperator& other)
      : ExchangeOperator({other.area().begin(), other.area().end()}, other.isSymmetric()),
        values_(other.dense()) {}
  std::vector<double> row(std::size_t i) const override {
    const auto first = values_.begin() + std::ptrdiff_t(i * size());
    return {first, first + std::ptrdiff_t(size())};
  }
  std::size_t bytes() const override { return values_.size() * sizeof(double); }

 private:
  void multiply(std::span<const double> x, int bands, std::span<double> y,
                std::span<const std::uint8_t> wanted) const override {
    const auto width = std::size_t(bands);
    for (std::size_t i = 0; i < size(); ++i) {
      if (!wanted.empty() && wanted[i] == 0) continue;
      for (std::size_t b = 0; b < width; ++b) {
        double sum = 0;
        for (std::size_t j = 0; j < size(); ++j) sum += values_[i * size() + j] * x[j * width + b];
        y[i * width + b] = sum;
      }
    }
  }

  std::vector<double> values_;
};

constexpr std::size_t kPatches = 300;  // more than kFewUnknowns

/// Reciprocal, rows summing to less than 1.
FormFactors storedFactors(bool symmetric) {
  test::Random random(3);
  std::vector<double> area = random.vector(kPatches, 0.5, 2.0);
  test::Matrix f(kPatches, kPatches);
  for (Eigen::Index i = 0; i < f.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double exchange = i == j ? 0.0 : random(0.0, 1.0) / double(kPatches);
      f(i, j) = exchange / area[std::size_t(i)];
      f(j, i) = exchange / area[std::size_t(j)];
    }
  }
  return symmetric ? test::symmetricFactorsFrom(f, area) : test::factorsFrom(f, area);
}

FormFactors plainFactors(const FormFactors& stored) {
  FormFactors plain = stored;
  plain.matrix = std::make_shared<PlainOperator>(*stored.matrix);
  return plain;
}

double largestDifference(std::span<const double> a, std::span<const double> b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

TEST(PlainOperator, IsSolvedByAllSolversWithoutASweep) {
  test::Random random(5);
  const std::vector<double> rho = random.vector(kPatches, 0.2, 0.8);
  const std::vector<double> emission = random.vector(kPatches, 0.0, 1.0);
  Progress quiet;
  for (const bool symmetric : {false, true}) {
    const FormFactors stored = storedFactors(symmetric);
    const FormFactors plain = plainFactors(stored);
    for (const Solver solver : test::solversOf(stored)) {
      const SolveOptions options = test::options(solver, 1e-12);
      if (solver == Solver::gauss_seidel) {
        EXPECT_THROW(solve(plain, rho, emission, 1, options, quiet), InputError);
        continue;
      }
      const Solution expected = solve(stored, rho, emission, 1, options, quiet);
      const Solution found = solve(plain, rho, emission, 1, options, quiet);
      EXPECT_EQ(found.summary.solver, expected.summary.solver);
      EXPECT_TRUE(found.summary.usable()) << found.summary.message;
      EXPECT_TRUE(found.summary.error_bound.has_value());
      EXPECT_LT(largestDifference(found.radiosity, expected.radiosity), 1e-11);
    }
  }
}

TEST(PlainOperator, ExchangesHeat) {
  const FormFactors stored = storedFactors(true);
  std::vector<HeatCondition> conditions(2);
  conditions[0].name = "hot";
  conditions[0].emissivity = {{{}, {0.8}}};
  conditions[0].temperature = 400;
  conditions[1].name = "adiabatic";
  conditions[1].emissivity = {{{}, {0.5}}};
  conditions[1].flux = 0;
  std::vector<Index> of_row(kPatches);
  for (Index i = 0; i < kPatches; ++i) of_row[i] = i % 2;
  Progress quiet;
  const HeatRows rows{conditions, of_row, {}};
  const HeatSolution expected = solveHeat(stored, rows, {}, quiet);
  const HeatSolution found = solveHeat(plainFactors(stored), rows, {}, quiet);
  EXPECT_LT(largestDifference(found.temperature, expected.temperature), 1e-6);
}

TEST(PlainOperator, IsSummedOverGroups) {
  constexpr std::size_t kGroups = 37;  // more than a product serves
  std::vector<Index> group_of(kPatches);
  for (Index i = 0; i < kPatches; ++i) group_of[i] = i % kGroups;
  Progress quiet;
  for (const bool symmetric : {false, true}) {
    const FormFactors stored = storedFactors(symmetric);
    const auto expected = aggregated(*stored.matrix, group_of, kGroups, quiet);
    const auto found = aggregated(*plainFactors(stored).matrix, group_of, kGroups, quiet);
    EXPECT_EQ(found->isSymmetric(), symmetric);
    EXPECT_LT(largestDifference(found->dense(), expected->dense()), 1e-15);
  }
}

TEST(PlainOperator, HasNoPairsToList) {
  const FormFactors plain = plainFactors(storedFactors(true));
  Results results;
  results.factors = {plain, "key"};
  Progress quiet;
  EXPECT_THROW(writeResults(testing::TempDir() + "plain.h5", results, quiet), InputError);
  EXPECT_THROW(pairsOf(*plain.matrix), InputError);
  EXPECT_EQ(plain.matrix->at(3, 4), plain.matrix->row(3)[4]);
}

}  // namespace
}  // namespace radiosity
