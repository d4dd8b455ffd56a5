// A symmetric matrix in the files: every entry of F is written, and one of each pair is read back.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numeric>

#include "results/matrix_blocks.h"
#include "results_sample.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

class ResultsSymmetric : public FolderTest {
 protected:
  std::string file() const { return path("x.h5"); }
  static Results results(Index side, Precision precision) {
    Results results = sample::results(side, precision);
    FormFactors& factors = *results.factors;
    factors.matrix = sample::symmetricMatrix(results.mesh->mesh, precision);
    factors.fronts = factors.matrix->rowSums();
    return results;
  }
  /// A dataset as another program reads it.
  template <class T>
  std::vector<T> dataset(const char* name, hid_t type) const {
    const hid_t id = H5Fopen(file().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t set = H5Dopen2(id, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(set);
    std::vector<T> values(std::size_t(H5Sget_simple_extent_npoints(space)));
    H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Sclose(space);
    H5Dclose(set);
    H5Fclose(id);
    return values;
  }
  template <class T>
  void change(const char* name, hid_t type, std::vector<T> values) const {
    const hid_t id = H5Fopen(file().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t set = H5Dopen2(id, name, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set);
    H5Fclose(id);
  }
};

// 60 x 60 patches: several chunks of the file and several panels of the matrix.
TEST_F(ResultsSymmetric, IsReadBackToTheBit) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    for (const Index side : {1u, 2u, 12u, 60u}) {
      const Results written = results(side, precision);
      writeResults(file(), written, progress_);
      const double size = double(std::filesystem::file_size(file()));
      // HDF5 hands out metadata in blocks of 2 KiB, some of them half empty: two of them, or 5%.
      EXPECT_NEAR(double(estimateResultsBytes(written)), size, std::max(4096.0, 0.05 * size));
      const Results read = readResults(file());
      ASSERT_TRUE(read.factors->matrix->isSymmetric());
      const auto& a = dynamic_cast<const SymmetricMatrix&>(*written.factors->matrix);
      const auto& b = dynamic_cast<const SymmetricMatrix&>(*read.factors->matrix);
      EXPECT_TRUE(std::equal(a.order().begin(), a.order().end(), b.order().begin()));
      EXPECT_EQ(a.bytes(), b.bytes());
      std::size_t wrong = 0;
      for (std::size_t k = 0; k < a.size(); ++k) {
        std::vector<double> left(a.size() - k);
        std::vector<double> right(a.size() - k);
        a.upperRow(k, left);
        b.upperRow(k, right);
        wrong += left != right ? 1 : 0;
      }
      EXPECT_EQ(wrong, 0u);
    }
  }
}

// A pair is kept in the row that is first in the order. Here that of the patches is the order, so
// the first third of the rows alone would keep 5/9 of the pairs. Stretches of a 48th of the rows,
// dealt to and fro, leave each part within a 20th of its third.
TEST_F(ResultsSymmetric, PartsHoldEveryRowOnceAndAsManyPairs) {
  Results written = results(24, Precision::single_precision);
  const std::size_t n = written.mesh->mesh.size();
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), 0u);
  const auto matrix = std::make_shared<SymmetricMatrix>(std::vector<double>(n, 1.0), order,
                                                        Precision::single_precision);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<Index> later(n - 1 - k);
    std::iota(later.begin(), later.end(), Index(k + 1));
    matrix->setUpperRow(k, later, std::vector<double>(later.size(), 1e-6));
  }
  written.factors->matrix = matrix;
  written.factors->fronts = written.factors->matrix->rowSums();
  writeResults(file(), written, progress_);
  std::vector<int> kept(n, 0);
  std::size_t all = 0;
  for (std::size_t part = 0; part < 3; ++part) {
    const auto read =
        std::dynamic_pointer_cast<const SymmetricMatrix>(readMatrixPart(file(), {part, 3}));
    std::size_t pairs = 0;
    for (std::size_t k = 0; k < n; ++k) {
      std::vector<double> row(n - k);
      read->upperRow(k, row);
      const auto entries = std::size_t(std::ranges::count_if(row, [](double v) { return v > 0; }));
      pairs += entries;
      kept[k] += entries > 0 ? 1 : 0;
    }
    EXPECT_NEAR(double(pairs), double(n * (n - 1)) / 6, 0.05 * double(n * (n - 1)) / 6) << part;
    all += pairs;
  }
  EXPECT_EQ(all, n * (n - 1) / 2);
  EXPECT_EQ(std::ranges::count(kept, 1), std::ptrdiff_t(n - 1));
}

TEST_F(ResultsSymmetric, TheFileHoldsAllOfFAsCompressedRows) {
  const Results written = results(12, Precision::single_precision);
  writeResults(file(), written, progress_);
  const auto indptr = dataset<std::int64_t>("/form_factors/indptr", H5T_NATIVE_INT64);
  const auto indices = dataset<std::int32_t>("/form_factors/indices", H5T_NATIVE_INT32);
  const auto data = dataset<float>("/form_factors/data", H5T_NATIVE_FLOAT);
  const ExchangeMatrix& matrix = pairsOf(*written.factors->matrix);
  std::size_t at = 0;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    ASSERT_EQ(std::size_t(indptr[i]), at);
    for (Index j = 0; j < matrix.size(); ++j) {
      const double f = matrix.at(i, j);
      if (f == 0) continue;
      ASSERT_EQ(Index(indices[at]), j);
      ASSERT_EQ(data[at], float(f));
      ++at;
    }
  }
  EXPECT_EQ(at, data.size());
  EXPECT_EQ(at, matrix.nonZeros());
}

TEST_F(ResultsSymmetric, NamesFieldsThatAreNotSymmetric) {
  const auto refused = [&](const std::string& part) {
    expectError<InputError>(file(), part, [&] { readResults(file()); });
  };
  writeResults(file(), results(3, Precision::single_precision), progress_);
  auto order = dataset<Index>("/form_factors/order", H5T_NATIVE_UINT32);
  std::swap(order[2], order[6]);
  change("/form_factors/order", H5T_NATIVE_UINT32, order);
  // Still a permutation, and any pattern with both ends of each pair fits it.
  EXPECT_TRUE(readResults(file()).factors->matrix->isSymmetric());
  order[2] = order[3];
  change("/form_factors/order", H5T_NATIVE_UINT32, order);
  refused("/form_factors/order does not name every patch once");
  order[2] = 1000;
  change("/form_factors/order", H5T_NATIVE_UINT32, order);
  refused("/form_factors/order does not name every patch once");

  writeResults(file(), results(3, Precision::single_precision), progress_);
  auto indptr = dataset<std::int64_t>("/form_factors/indptr", H5T_NATIVE_INT64);
  auto indices = dataset<std::int32_t>("/form_factors/indices", H5T_NATIVE_INT32);
  // A row gives its last entry to another column that it does not have: one end of a pair is gone.
  for (std::size_t i = 0; i + 1 < indptr.size(); ++i) {
    const auto last = std::size_t(indptr[i + 1]) - 1;
    if (indptr[i + 1] == indptr[i] || indices[last] >= 9 || i == 9) continue;
    if (std::size_t(indices[last]) > i) continue;
    indices[last] = 9;
    break;
  }
  change("/form_factors/indices", H5T_NATIVE_INT32, indices);
  refused("/form_factors/indices is not that of a symmetric matrix");
}

TEST_F(ResultsSymmetric, MatrixMarketHoldsAllOfF) {
  const auto stored = sample::symmetricMatrix(sample::mesh(17), Precision::single_precision);
  const SymmetricMatrix& matrix = *stored;
  writeMatrixMarket(path("x.mtx"), matrix, progress_);
  std::ifstream text(path("x.mtx"));
  std::string line;
  while (std::getline(text, line) && line[0] == '%') {
  }
  std::size_t entries = 0;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    for (std::size_t j = 0; j < matrix.size(); ++j) {
      // The value in the results file: F, rounded once to its precision.
      const double f = float(matrix.at(i, j));
      if (f == 0) continue;
      std::getline(text, line);
      char* rest = line.data();
      if (std::strtoul(rest, &rest, 10) != i + 1) ++wrong;
      if (std::strtoul(rest, &rest, 10) != j + 1) ++wrong;
      if (std::strtod(rest, &rest) != f || *rest != '\0') ++wrong;
      ++entries;
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(entries, matrix.nonZeros());
  EXPECT_FALSE(std::getline(text, line)) << line;
}

}  // namespace
}  // namespace radiosity
