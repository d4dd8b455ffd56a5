// Sums over groups of patches against dense arithmetic: exchange areas, closure and reciprocity.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

constexpr std::size_t kSamplePatches = 60;
constexpr std::size_t kGroups = 13;
/// Of sums of some 60 x 60 / 13 doubles.
constexpr double kRounding = 1e-13;

using Dense = std::vector<std::vector<double>>;

/// Symmetric exchange areas, two thirds of them 0, of rows that sum to `sum` times the area.
struct GroupedSample {
  std::vector<double> area = std::vector<double>(kSamplePatches);
  std::vector<Index> order = std::vector<Index>(kSamplePatches);
  std::vector<Index> group_of = std::vector<Index>(kSamplePatches);
  Dense exchange = Dense(kSamplePatches, std::vector<double>(kSamplePatches, 0.0));

  explicit GroupedSample(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (std::size_t i = 0; i < kSamplePatches; ++i) {
      // The first patch of each group but the last, which stays empty; then at random.
      group_of[i] = Index(i < kGroups - 1 ? i : random() % (kGroups - 1));
      for (std::size_t j = 0; j <= i; ++j) {
        if (uniform(random) < 0.3) exchange[i][j] = exchange[j][i] = uniform(random);
      }
    }
    // A patch gives the rest to itself, as a bent one does: all rows sum to 1.
    for (std::size_t i = 0; i < kSamplePatches; ++i) {
      area[i] = 0.5 + std::accumulate(exchange[i].begin(), exchange[i].end(), 0.0);
      exchange[i][i] += 0.5;
    }
    std::iota(order.begin(), order.end(), Index(0));
    std::shuffle(order.begin(), order.end(), random);
  }

  RowMatrix rows() const {
    RowMatrix matrix(area, Precision::double_precision);
    for (std::size_t i = 0; i < kSamplePatches; ++i) {
      std::vector<Index> columns;
      std::vector<double> values;
      for (Index j = 0; j < kSamplePatches; ++j) {
        if (exchange[i][j] == 0) continue;
        columns.push_back(j);
        values.push_back(exchange[i][j] / area[i]);
      }
      matrix.setRow(i, columns, values);
    }
    return matrix;
  }

  SymmetricMatrix symmetric(Precision precision = Precision::double_precision) const {
    auto matrix = SymmetricMatrix(area, order, precision);
    for (std::size_t k = 0; k < kSamplePatches; ++k) {
      std::vector<double> upper;
      for (std::size_t later = k; later < kSamplePatches; ++later) {
        upper.push_back(exchange[order[k]][order[later]] / area[order[k]]);
      }
      matrix.setUpperRow(k, upper);
    }
    return matrix;
  }

  /// The definition: G_IJ is the sum of G_ij over i in I and j in J.
  Dense ofGroups() const {
    Dense sums(kGroups, std::vector<double>(kGroups, 0.0));
    for (std::size_t i = 0; i < kSamplePatches; ++i) {
      for (std::size_t j = 0; j < kSamplePatches; ++j) {
        sums[group_of[i]][group_of[j]] += exchange[i][j];
      }
    }
    return sums;
  }
};

void expectSums(const ExchangeMatrix& matrix, const GroupedSample& sample, double relative) {
  const Dense sums = sample.ofGroups();
  ASSERT_EQ(matrix.size(), kGroups);
  for (std::size_t group = 0; group < kGroups; ++group) {
    double area = 0;
    for (std::size_t i = 0; i < kSamplePatches; ++i)
      area += sample.group_of[i] == group ? sample.area[i] : 0;
    EXPECT_NEAR(matrix.area()[group], area, kRounding * area);
    for (std::size_t other = 0; other < kGroups; ++other) {
      EXPECT_NEAR(matrix.area()[group] * matrix.at(group, other), sums[group][other],
                  relative * sums[group][other])
          << group << " " << other;
    }
  }
}

TEST(Aggregation, ExchangeAreasAreSumsOverTheGroups) {
  Progress progress;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const GroupedSample sample(seed);
    const auto rows = aggregated(sample.rows(), sample.group_of, kGroups, progress);
    const auto symmetric = aggregated(sample.symmetric(), sample.group_of, kGroups, progress);
    EXPECT_FALSE(rows->isSymmetric());
    EXPECT_TRUE(symmetric->isSymmetric());
    expectSums(*rows, sample, kRounding);
    expectSums(*symmetric, sample, kRounding);
    // Single precision rounds each value once before it is summed, and once after: 2^-24 each.
    const auto single = aggregated(sample.symmetric(Precision::single_precision), sample.group_of,
                                   kGroups, progress);
    EXPECT_EQ(single->precision(), Precision::single_precision);
    expectSums(*single, sample, 2.1 * 0x1p-24);
  }
}

TEST(Aggregation, KeepsClosureAndReciprocity) {
  Progress progress;
  const GroupedSample sample(7);
  const auto rows = aggregated(sample.rows(), sample.group_of, kGroups, progress);
  const auto symmetric = aggregated(sample.symmetric(), sample.group_of, kGroups, progress);
  for (const auto& matrix : {rows, symmetric}) {
    const std::vector<double> sums = matrix->rowSums();
    for (std::size_t group = 0; group < kGroups; ++group) {
      EXPECT_NEAR(sums[group], group + 1 < kGroups ? 1 : 0, kRounding) << group;
    }
  }
  EXPECT_LT(reciprocityResidual(*rows), kRounding);
}

TEST(Aggregation, GroupsOfOnePatchChangeNothing) {
  Progress progress;
  const GroupedSample sample(3);
  std::vector<Index> each(kSamplePatches);
  std::iota(each.begin(), each.end(), Index(0));
  const RowMatrix rows = sample.rows();
  const SymmetricMatrix symmetric = sample.symmetric();
  for (const ExchangeMatrix* matrix : {static_cast<const ExchangeMatrix*>(&rows),
                                       static_cast<const ExchangeMatrix*>(&symmetric)}) {
    const auto same = aggregated(*matrix, each, kSamplePatches, progress);
    EXPECT_EQ(std::vector(same->order().begin(), same->order().end()),
              std::vector(matrix->order().begin(), matrix->order().end()));
    for (std::size_t i = 0; i < kSamplePatches; ++i) {
      for (std::size_t j = 0; j < kSamplePatches; ++j) {
        EXPECT_NEAR(same->at(i, j), matrix->at(i, j), 4e-16 * matrix->at(i, j));
      }
    }
  }
}

TEST(Aggregation, RefusesGroupsThatDoNotFit) {
  Progress progress;
  const GroupedSample sample(1);
  std::vector<Index> group_of = sample.group_of;
  group_of.pop_back();
  EXPECT_THROW(aggregated(sample.rows(), group_of, kGroups, progress), InputError);
  group_of.push_back(Index(kGroups));
  EXPECT_THROW(aggregated(sample.rows(), group_of, kGroups, progress), InputError);
  progress.cancel();
  EXPECT_THROW(aggregated(sample.rows(), sample.group_of, kGroups, progress), Cancelled);
  EXPECT_THROW(aggregated(sample.symmetric(), sample.group_of, kGroups, progress), Cancelled);
}

}  // namespace
}  // namespace radiosity
