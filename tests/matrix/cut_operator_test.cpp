// Form factors as rows that are cut through a tree: what they multiply to, and what they state.
#include "matrix/cut_operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "cut_sample.h"
#include "matrix/cut_balance.h"
#include "operands.h"
#include "radiosity/base.h"

namespace radiosity {
namespace {

constexpr std::size_t kCutPatches = 300;

TEST(CutOperator, MultipliesAsItsRowsDo) {
  const CutOperator cut(test::randomCut(kCutPatches, 1));
  for (const int bands : {1, 3, 4, 7}) {
    const auto width = std::size_t(bands);
    const std::vector<double> x = test::randomVector(kCutPatches * width, 2);
    std::vector<double> y(x.size(), -1);
    cut.product(x, bands, y);
    for (std::size_t i = 0; i < kCutPatches; ++i) {
      const std::vector<double> row = cut.row(i);
      for (std::size_t b = 0; b < width; ++b) {
        double sum = 0;
        for (std::size_t j = 0; j < kCutPatches; ++j) sum += row[j] * x[j * width + b];
        // Of 300 products, with inverses of up to some hundreds.
        EXPECT_NEAR(y[i * width + b], sum, 1e-11) << i;
      }
    }
  }
}

TEST(CutOperator, SumsItsRowsToWhatTheirHitsCount) {
  CutParts parts = test::randomCut(kCutPatches, 3);
  for (std::size_t k = 0; k < parts.of_a_hit.size(); ++k) parts.tree.setCounts(k, 1);
  const CutOperator cut(parts);
  const std::vector<double> sums = cut.rowSums();
  for (std::size_t i = 0; i + 2 < kCutPatches; ++i) EXPECT_NEAR(sums[i], 0.9 + 0.0625, 1e-9) << i;
  EXPECT_NEAR(sums[kCutPatches - 2], double(kCutPatches - 2) / kCutPatches, 1e-6);
  EXPECT_EQ(sums[kCutPatches - 1], 0);
}

TEST(CutOperator, BoundsTheAbsoluteValuesOfItsRows) {
  const CutOperator cut(test::randomCut(kCutPatches, 4));
  EXPECT_FALSE(cut.isNonNegative());
  const std::vector<double> norms = cut.rowNorms();
  bool some_below_zero = false;
  for (std::size_t i = 0; i < kCutPatches; ++i) {
    double sum = 0;
    for (const double value : cut.row(i)) {
      sum += std::abs(value);
      some_below_zero = some_below_zero || value < 0;
    }
    EXPECT_GE(norms[i] * (1 + 1e-6), sum) << i;
  }
  EXPECT_TRUE(some_below_zero);
}

TEST(CutOperator, LeavesRowsThatAreNotWanted) {
  const CutOperator cut(test::randomCut(kCutPatches, 5));
  const std::vector<double> x = test::randomVector(kCutPatches, 6);
  std::vector<double> all(kCutPatches);
  cut.product(x, 1, all);
  std::vector<std::uint8_t> wanted(kCutPatches, 0);
  for (std::size_t i = 0; i < kCutPatches; i += 3) wanted[i] = 1;
  std::vector<double> some(kCutPatches, -5);
  cut.product(x, 1, some, wanted);
  for (std::size_t i = 0; i < kCutPatches; ++i) EXPECT_EQ(some[i], wanted[i] ? all[i] : -5);
}

TEST(CutOperator, HasTheSameBitsForAnyThreads) {
  // More than a thread's share of the tree.
  const CutOperator cut(test::randomCut(4500, 7));
  const std::vector<double> x = test::randomVector(4500 * 3, 8);
  std::vector<double> first(x.size());
  setThreads(1);
  cut.product(x, 3, first);
  const std::optional<double> error = cut.relativeError(x, 3);
  setThreads(0);
  std::vector<double> second(x.size());
  cut.product(x, 3, second);
  EXPECT_EQ(first, second);
  EXPECT_EQ(error, cut.relativeError(x, 3));
}

TEST(CutOperator, StatesHalfTheDifferenceOfItsTwoSetsOfRays) {
  CutParts parts = test::randomCut(kCutPatches, 9);
  parts.bias = 0;
  // Where the first set counts all of it, the two differ by twice the whole.
  for (CutRows& block : parts.blocks) {
    for (CutRows::Hits& hits : block.hits) hits = {hits[1], 0};
  }
  parts.pairs.reset();
  const std::vector<double> x = test::randomVector(kCutPatches, 10);
  EXPECT_NEAR(CutOperator(parts).relativeError(x, 1).value(), 1, 1e-12);
  parts.bias = 0.75;
  EXPECT_NEAR(CutOperator(parts).relativeError(x, 1).value(), 1.25, 1e-12);
  EXPECT_FALSE(CutOperator(parts).relativeError(std::vector<double>(kCutPatches, 0.0), 1));
}

TEST(CutOperator, IsBalancedByScaling) {
  // Rows with all patches in them, so that each can be balanced; the known ones stay as they are.
  CutParts parts = test::randomCut(kCutPatches, 12);
  for (std::size_t k = 0; k < parts.of_a_hit.size(); ++k) parts.tree.setCounts(k, 1);
  const std::vector<double> sums(parts.of_a_hit.size(), 0.9);
  const CutBalance balance = balanceCut(parts, sums, *std::make_unique<Progress>());
  EXPECT_GT(balance.before, 0.1);
  EXPECT_LT(balance.after, 0.2 * balance.before);
  parts.pairs.reset();
  const CutOperator cut(parts);
  const std::vector<double> rows = cut.rowSums();
  std::vector<double> columns(kCutPatches, 0.0);
  double power = 0;
  for (std::size_t i = 0; i + 2 < kCutPatches; ++i) {
    EXPECT_NEAR(rows[i], 0.9, 1e-9);
    const std::vector<double> row = cut.row(i);
    for (std::size_t j = 0; j < kCutPatches; ++j) columns[j] += parts.area[i] * row[j];
    power += parts.area[i] * 0.9;
  }
  double off = 0;
  for (std::size_t j = 0; j + 2 < kCutPatches; ++j)
    off += std::abs(columns[j] - 0.9 * parts.area[j]);
  EXPECT_NEAR(off / power, balance.after, 1e-9);
}

TEST(CutOperator, RefusesPartsThatDoNotFit) {
  const CutParts whole = test::randomCut(kCutPatches, 11);
  CutParts parts = whole;
  parts.of_a_hit.pop_back();
  EXPECT_THROW(CutOperator{parts}, InputError);
  parts = whole;
  parts.blocks[1].nodes.back() = Index(parts.tree.nodes().size());
  EXPECT_THROW(CutOperator{parts}, InputError);
  parts = whole;
  parts.blocks[0].hits.pop_back();
  EXPECT_THROW(CutOperator{parts}, InputError);
  parts = whole;
  parts.area.resize(20);
  EXPECT_THROW(CutOperator{parts}, InputError);
}

}  // namespace
}  // namespace radiosity
