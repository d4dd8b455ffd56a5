// MatrixMarket out: every stored entry, in order, to the last bit.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "results_sample.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

class MatrixMarket : public FolderTest {};

TEST_F(MatrixMarket, HoldsEveryEntryToTheBit) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    // 17 x 17 patches: rows of all kinds. 60 x 60: more text than one batch of tasks holds.
    for (const Index side : {17u, 60u}) {
      const auto stored = sample::matrix(sample::mesh(side), precision);
      const RowMatrix& matrix = *stored;
      writeMatrixMarket(path("x.mtx"), matrix, progress_);
      std::ifstream file(path("x.mtx"));
      std::string line;
      std::getline(file, line);
      EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real general");
      while (std::getline(file, line) && line[0] == '%') EXPECT_LT(line.size(), 1024u);
      std::ostringstream size;
      size << matrix.size() << ' ' << matrix.size() << ' ' << matrix.nonZeros();
      EXPECT_EQ(line, size.str());
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < matrix.size(); ++i) {
        matrix.forRow(i, [&](Index j, double value) {
          std::getline(file, line);
          char* rest = line.data();
          if (std::strtoul(rest, &rest, 10) != i + 1) ++wrong;
          if (std::strtoul(rest, &rest, 10) != j + 1) ++wrong;
          if (std::strtod(rest, &rest) != value || *rest != '\0') ++wrong;
        });
      }
      EXPECT_EQ(wrong, 0u);
      EXPECT_FALSE(std::getline(file, line)) << line;
    }
  }
}

// The far side of a pair of a symmetric matrix is computed from the near one: it is written as a
// results file holds it, rounded likewise.
TEST_F(MatrixMarket, RoundsLikeTheResultsFile) {
  SymmetricMatrix matrix({1, 3, 0.7}, {0, 1, 2}, Precision::single_precision);
  const std::vector<double> first = {0, 0.3, 0.1};
  const std::vector<double> second = {0, 0.05};
  matrix.setUpperRow(0, first);
  matrix.setUpperRow(1, second);
  writeMatrixMarket(path("x.mtx"), matrix, progress_);
  std::ifstream file(path("x.mtx"));
  std::string line;
  while (std::getline(file, line) && line[0] == '%') {
  }
  std::size_t i = 0;
  std::size_t j = 0;
  double value = 0;
  std::size_t entries = 0;
  for (; file >> i >> j >> value; ++entries) {
    EXPECT_EQ(value, double(float(value))) << i << ' ' << j;
    EXPECT_EQ(value, double(float(matrix.at(i - 1, j - 1)))) << i << ' ' << j;
  }
  EXPECT_EQ(entries, 6u);
  EXPECT_NE(matrix.at(1, 0), double(float(matrix.at(1, 0)))) << "0.1 as a double is no float";
}

TEST_F(MatrixMarket, AnEmptyMatrixHasNoEntries) {
  writeMatrixMarket(path("x.mtx"), RowMatrix({1, 2}, Precision::single_precision), progress_);
  std::ifstream file(path("x.mtx"));
  std::string line;
  while (std::getline(file, line) && line[0] == '%') {
  }
  EXPECT_EQ(line, "2 2 0");
}

TEST_F(MatrixMarket, IsWrittenWholeOrNotAtAll) {
  const auto stored = sample::matrix(sample::mesh(17), Precision::single_precision);
  const RowMatrix& matrix = *stored;
  for (const rlim_t limit : {0, 100, 100000}) {
    const FullDisk disk(limit);
    expectError<RunError>(path("x.mtx"), "cannot be written",
                          [&] { writeMatrixMarket(path("x.mtx"), matrix, progress_); });
    EXPECT_EQ(files(), 0u);
  }
  Progress cancelled;
  cancelled.cancel();
  EXPECT_THROW(writeMatrixMarket(path("x.mtx"), matrix, cancelled), Cancelled);
  EXPECT_EQ(files(), 0u);
  expectError<InputError>(path("no/x.mtx"), "does not exist",
                          [&] { writeMatrixMarket(path("no/x.mtx"), matrix, progress_); });
}

}  // namespace
}  // namespace radiosity
