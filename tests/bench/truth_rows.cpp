#include "truth_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <random>

#include "base/parallel.h"
#include "truth/ground_truth.h"

namespace radiosity::bench {
namespace {

constexpr std::size_t kCompleteUpTo = 1000;
constexpr std::size_t kSampledRows = 100;
constexpr std::uint64_t kSeed = 20;
/// Looks that a pair may cost. Of the thousands of pairs in a row of the furnished room half a
/// dozen or so run out of them, with figures of up to some 1e-3 of the mean form factor.
constexpr std::size_t kMostPoints = 100000;

std::vector<Index> chooseRows(const PatchMesh& mesh) {
  std::vector<Index> candidates;
  for (Index i = 0; i < mesh.size(); ++i) {
    if (mesh.area[i] > 0) candidates.push_back(i);
  }
  if (mesh.size() <= kCompleteUpTo) return candidates;
  std::vector<Index> chosen;
  std::sample(candidates.begin(), candidates.end(), std::back_inserter(chosen), kSampledRows,
              std::mt19937_64(kSeed));
  return chosen;
}

/// One file a mesh: records of a row's number and its N values.
class RowCache {
 public:
  RowCache(const PatchMesh& mesh, double accuracy, const std::string& folder) : size_(mesh.size()) {
    std::filesystem::create_directories(folder);
    path_ = fmt::format("{}/{}-{:.0e}-{}.rows", folder, geometryHash(mesh), accuracy,
                        RADIOSITY_TRUTH_CODE);
    std::ifstream in(path_, std::ios::binary);
    if (!in) return;
    Index i = 0;
    std::size_t records = 0;
    std::vector<double> row(size_);
    while (in.read(reinterpret_cast<char*>(&i), sizeof i) &&
           in.read(reinterpret_cast<char*>(row.data()), bytes())) {
      rows_[i] = row;
      ++records;
    }
    // An interrupted run may have left part of a record.
    in.close();
    std::filesystem::resize_file(path_, records * (sizeof i + std::size_t(bytes())));
  }
  const std::vector<double>* find(Index i) const {
    const auto found = rows_.find(i);
    return found == rows_.end() ? nullptr : &found->second;
  }
  /// Thread-safe.
  void add(Index i, const std::vector<double>& row) {
    const std::scoped_lock lock(mutex_);
    std::ofstream out(path_, std::ios::binary | std::ios::app);
    out.write(reinterpret_cast<const char*>(&i), sizeof i);
    out.write(reinterpret_cast<const char*>(row.data()), bytes());
  }

 private:
  std::streamsize bytes() const { return std::streamsize(size_ * sizeof(double)); }
  std::size_t size_;
  std::string path_;
  std::map<Index, std::vector<double>> rows_;
  std::mutex mutex_;
};

}  // namespace

TruthRows truthRows(const PatchMesh& mesh, double accuracy, const std::string& folder) {
  TruthRows truth;
  truth.index = chooseRows(mesh);
  truth.complete = mesh.size() <= kCompleteUpTo;
  truth.row.resize(truth.index.size());
  RowCache cache(mesh, accuracy, folder);
  truth::TruthOptions options;
  options.accuracy = accuracy;
  options.most_points = kMostPoints;
  const truth::GroundTruth estimator(mesh, options);
  parallelFor(truth.index.size(), 1, [&](std::size_t k) {
    if (const std::vector<double>* known = cache.find(truth.index[k])) {
      truth.row[k] = *known;
      return;
    }
    truth.row[k] = estimator.row(truth.index[k]).form_factors;
    cache.add(truth.index[k], truth.row[k]);
  });
  return truth;
}

MatrixError matrixError(const ExchangeMatrix& matrix, const TruthRows& truth) {
  MatrixError error;
  double wrong = 0;
  double all = 0;
  std::vector<double> row(matrix.size());
  for (std::size_t k = 0; k < truth.index.size(); ++k) {
    const Index i = truth.index[k];
    std::fill(row.begin(), row.end(), 0.0);
    matrix.forRow(i, [&](Index j, double value) { row[j] = value; });
    double squares = 0;
    for (std::size_t j = 0; j < row.size(); ++j) {
      const double difference = row[j] - truth.row[k][j];
      squares += difference * difference;
      all += matrix.area()[i] * truth.row[k][j] * truth.row[k][j];
      error.largest = std::max(error.largest, std::abs(difference));
    }
    wrong += matrix.area()[i] * squares;
    error.row.push_back(std::sqrt(squares));
  }
  error.relative_l2 = std::sqrt(wrong / all);
  return error;
}

}  // namespace radiosity::bench
