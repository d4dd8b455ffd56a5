// Form factors in 16 bits, of matrices made for it.
#include "page/factor_codes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "radiosity/symmetric_matrix.h"

namespace radiosity {
namespace {

using page::encodeFactors;
using page::FactorCodes;

/// Patches of equal area whose pairs k apart exchange factors[k], 0 being a patch with itself.
SymmetricMatrix banded(std::size_t n, const std::vector<double>& factors) {
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index(0));
  SymmetricMatrix matrix =
      SymmetricMatrix(std::vector<double>(n, 1.0), order, Precision::double_precision);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t count = std::min(factors.size(), n - k);
    matrix.setUpperRow(k, std::span(factors).first(count));
  }
  return matrix;
}

double decoded(const FactorCodes& codes, std::size_t k) {
  return std::exp(codes.quantisation.lowest + codes.quantisation.step * codes.code[k]);
}

TEST(FactorCodes, SmallestAndLargestAreExact) {
  Progress progress;
  const FactorCodes codes = encodeFactors(banded(3, {0.25, 1e-6}), progress);
  EXPECT_EQ(codes.pairs, 5u);
  EXPECT_EQ(codes.code, (std::vector<std::uint16_t>{65535, 1, 0, 65535, 1, 65535}));
  EXPECT_TRUE(codes.column.empty());  // 5 of 6 pairs
  EXPECT_EQ(codes.begin, (std::vector<std::uint32_t>{0, 3, 5, 6}));
  EXPECT_NEAR(decoded(codes, 0), 0.25, 1e-13);
  EXPECT_NEAR(decoded(codes, 1), 1e-6, 1e-18);
  EXPECT_LT(codes.quantisation.largest_row_error, 1e-12);
}

TEST(FactorCodes, FewPairsNameTheirColumns) {
  Progress progress;
  const FactorCodes codes = encodeFactors(banded(6, {0, 0.5, 0, 0.1}), progress);
  EXPECT_EQ(codes.begin, (std::vector<std::uint32_t>{0, 2, 4, 6, 7, 8, 8}));
  EXPECT_EQ(codes.column, (std::vector<std::uint32_t>{1, 3, 2, 4, 3, 5, 4, 5}));
}

TEST(FactorCodes, OneValueNeedsNoSteps) {
  Progress progress;
  const FactorCodes codes = encodeFactors(banded(4, {0, 0.3}), progress);
  EXPECT_EQ(codes.quantisation.step, 0);
  EXPECT_EQ(codes.quantisation.largest_relative_error, 0);
  for (std::size_t k = 0; k < codes.code.size(); ++k) {
    if (codes.code[k] == 0) continue;
    EXPECT_NEAR(decoded(codes, k), 0.3, 1e-15);
  }
}

TEST(FactorCodes, NegligibleFactorsAreLeftOutAndCounted) {
  Progress progress;
  // 1e-9 / 4 is the limit of each.
  const FactorCodes codes = encodeFactors(banded(4, {0.5, 1e-10, 1e-9, 1e-30}), progress);
  EXPECT_EQ(codes.quantisation.left_out, 4u);
  EXPECT_EQ(codes.pairs, 6u);
  // Rows 1 and 2 lose two of 1e-10 each.
  EXPECT_NEAR(codes.quantisation.largest_row_error, 2e-10, 1e-12);
}

/// A small patch in view of a large one: a factor near 0 one way counts the other way.
TEST(FactorCodes, SmallFactorsOfLargePatchesAreKept) {
  Progress progress;
  SymmetricMatrix matrix = SymmetricMatrix({1.0, 1e-12}, {0, 1}, Precision::double_precision);
  matrix.setUpperRow(0, std::vector<double>{0, 3e-13});
  matrix.setUpperRow(1, std::vector<double>{0});
  const FactorCodes codes = encodeFactors(matrix, progress);
  EXPECT_EQ(codes.pairs, 1u);
  EXPECT_EQ(codes.quantisation.left_out, 0u);
  EXPECT_EQ(codes.column, std::vector<std::uint32_t>{1});
  // F_10 = F_01 A_0 / A_1.
  EXPECT_NEAR(decoded(codes, 0) * 1.0 / 1e-12, 0.3, 1e-12);
}

TEST(FactorCodes, AnEmptyMatrixHasNoCodes) {
  Progress progress;
  for (const std::size_t n : {0, 3}) {
    const FactorCodes codes = encodeFactors(banded(n, {0}), progress);
    EXPECT_EQ(codes.begin, std::vector<std::uint32_t>(n + 1, 0));
    EXPECT_TRUE(codes.code.empty());
  }
}

TEST(FactorCodes, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(encodeFactors(banded(3, {0.25, 1e-6}), progress), Cancelled);
}

}  // namespace
}  // namespace radiosity
