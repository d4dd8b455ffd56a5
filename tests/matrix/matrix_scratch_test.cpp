// Matrices whose rows are in scratch memory.
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "radiosity/closure.h"
#include "radiosity/symmetric_matrix.h"

namespace radiosity {
namespace {

constexpr std::size_t kSize = 300;

double factor(std::size_t k, std::size_t later) {
  return (k + later) % 3 == 0 ? double(1 + (k * later) % 7) / (8.0 * kSize) : 0.0;
}

SymmetricMatrix filled(std::shared_ptr<ScratchMemory> scratch) {
  std::vector<Index> order(kSize);
  std::iota(order.begin(), order.end(), Index(0));
  auto matrix = SymmetricMatrix(std::vector<double>(kSize, 2.0), order, Precision::single_precision,
                                std::move(scratch));
  for (std::size_t k = 0; k < kSize; ++k) {
    std::vector<double> row;
    for (std::size_t later = k; later < kSize; ++later) row.push_back(factor(k, later));
    matrix.setUpperRow(k, row);
  }
  return matrix;
}

UncertainEntries uncertainOf(const SymmetricMatrix& matrix,
                             std::shared_ptr<ScratchMemory> scratch) {
  UncertainEntries uncertain(kSize, std::move(scratch));
  for (std::size_t k = 0; k < kSize; ++k) {
    std::vector<Index> later;
    for (const Index position : matrix.upperEntries(k).positions) {
      if (position > k) later.push_back(position);
    }
    uncertain.setRow(k, later, std::vector<double>(later.size(), 1e-3));
  }
  return uncertain;
}

std::shared_ptr<ScratchMemory> scratchIn(const std::string& folder) {
  // Nothing may stay in memory: all is released at every look.
  return std::make_shared<ScratchMemory>(folder, 0);
}

TEST(ScratchMemory, HoldsTheSameMatrixToTheBit) {
  const auto scratch = scratchIn(testing::TempDir());
  const SymmetricMatrix there = filled(scratch);
  const SymmetricMatrix here = filled(nullptr);
  EXPECT_GT(scratch->fileBytes(), there.bytes());
  std::vector<double> x(kSize);
  std::iota(x.begin(), x.end(), 1.0);
  std::vector<double> in_scratch(kSize);
  std::vector<double> in_memory(kSize);
  there.product(x, 1, in_scratch);
  here.product(x, 1, in_memory);
  EXPECT_EQ(in_scratch, in_memory);
  there.forPanels([&](const RowPanel& panel) {
    for (std::size_t i = panel.first(); i < panel.last(); ++i) {
      panel.forRow(i, [&](Index j, double value) { EXPECT_EQ(value, here.at(i, j)); });
    }
  });
}

TEST(ScratchMemory, RowsAreClosedToTheSameBits) {
  const auto scratch = scratchIn(testing::TempDir());
  SymmetricMatrix there = filled(scratch);
  SymmetricMatrix here = filled(nullptr);
  std::vector<double> target = here.rowSums();
  for (double& sum : target) sum *= 1.01;
  Progress silent;
  closeRows(there, uncertainOf(there, scratch), target, silent);
  const ClosureReport report = closeRows(here, uncertainOf(here, nullptr), target, silent);
  EXPECT_TRUE(report.reached);
  EXPECT_EQ(there.rowSums(), here.rowSums());
}

TEST(ScratchMemory, HoldsAMatrixThatIsMoved) {
  SymmetricMatrix matrix = filled(scratchIn(testing::TempDir()));
  const SymmetricMatrix moved = std::move(matrix);
  EXPECT_EQ(moved.rowSums(), filled(nullptr).rowSums());
}

TEST(ScratchMemory, LeavesNoFileAndNamesAMissingFolder) {
  const std::string folder = testing::TempDir() + "/scratch_memory";
  std::filesystem::create_directory(folder);
  const SymmetricMatrix matrix = filled(scratchIn(folder));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove(folder);
  try {
    scratchIn(folder);
    FAIL() << "no error";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find(folder), std::string::npos) << error.what();
  }
}

TEST(SymmetricFormInScratch, RowsWithFewValuesAreSetByTheirPositions) {
  const SymmetricMatrix dense = filled(nullptr);
  SymmetricMatrix sparse = filled(nullptr);
  for (std::size_t k = 0; k < kSize; ++k) {
    const SymmetricMatrix::UpperEntries entries = dense.upperEntries(k);
    sparse.setUpperRow(k, {});
    sparse.setUpperRow(k, entries.positions, entries.factors);
  }
  EXPECT_EQ(sparse.bytes(), dense.bytes());
  EXPECT_EQ(sparse.rowSums(), dense.rowSums());
  const std::vector<Index> early{3};
  const std::vector<Index> twice{7, 7};
  EXPECT_THROW(sparse.setUpperRow(5, early, std::vector<double>{0.1}), InputError);
  EXPECT_THROW(sparse.setUpperRow(5, twice, std::vector<double>{0.1, 0.1}), InputError);
  EXPECT_THROW(sparse.setUpperRow(5, twice, std::vector<double>{0.1}), InputError);
  EXPECT_THROW(sparse.setUpperRow(5, {&twice[0], 1}, std::vector<double>{-0.1}), InputError);
}

}  // namespace
}  // namespace radiosity
