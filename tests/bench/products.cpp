// Verifies, then times: products with a dense matrix in single precision, by how many columns
// (bands, right-hand sides) there are, beside copying memory and beside reading it.
#include "products.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

#include "base/parallel.h"
#include "clocks.h"
#include "radiosity/symmetric_matrix.h"

namespace radiosity::bench {
namespace {

constexpr std::size_t kPatches = 10000;
constexpr int kColumns[] = {1, 3, 8, 16};
constexpr int kRounds = 15;

/// Half of the matrix that a room of so many patches, each of which sees all others, would have.
SymmetricMatrix denseMatrix() {
  std::vector<Index> order(kPatches);
  std::iota(order.begin(), order.end(), Index(0));
  auto matrix =
      SymmetricMatrix(std::vector<double>(kPatches, 1.0), order, Precision::single_precision);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.5, 1.5);
  for (std::size_t k = 0; k < kPatches; ++k) {
    std::vector<double> row(kPatches - k);
    for (std::size_t m = 1; m < row.size(); ++m) row[m] = uniform(random) / kPatches;
    matrix.setUpperRow(k, row);
  }
  return matrix;
}

/// Column b of N * columns values: 1 + b everywhere.
std::vector<double> steps(int columns) {
  std::vector<double> values(kPatches * std::size_t(columns));
  for (std::size_t m = 0; m < values.size(); ++m) values[m] = double(1 + m % std::size_t(columns));
  return values;
}

/// Sums of rows, entry by entry. All areas are 1: F_ij = F_ji.
std::vector<double> plainRowSums(const SymmetricMatrix& matrix) {
  std::vector<double> sums(kPatches);
  for (std::size_t k = 0; k < kPatches; ++k) {
    std::vector<double> row(kPatches - k);
    matrix.upperRow(k, row);
    for (std::size_t m = 1; m < row.size(); ++m) {
      sums[k] += row[m];
      sums[k + m] += row[m];
    }
  }
  return sums;
}

bool agrees(const SymmetricMatrix& matrix) {
  const std::vector<double> sums = plainRowSums(matrix);
  for (const int columns : kColumns) {
    std::vector<double> y(kPatches * std::size_t(columns));
    matrix.product(steps(columns), columns, y);
    for (std::size_t m = 0; m < y.size(); ++m) {
      const std::size_t i = m / std::size_t(columns);
      const double expected = double(1 + m % std::size_t(columns)) * sums[i];
      // 10,000 terms of one sign, summed in another order.
      if (std::abs(y[m] - expected) > 2e-12 * expected) return false;
    }
  }
  return true;
}

double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Bytes a second that all threads copy and read: as many as the matrix has.
class MemoryRates {
 public:
  explicit MemoryRates(std::size_t bytes) : from_(bytes / sizeof(std::uint64_t), 1), to_(from_) {}
  void copy() {
    forParts([&](std::size_t first, std::size_t count) {
      std::memcpy(&to_[first], &from_[first], count * sizeof(std::uint64_t));
    });
  }
  std::uint64_t read() {
    std::vector<std::uint64_t> sums(kParts);
    forParts([&](std::size_t first, std::size_t count) {
      sums[first / (from_.size() / kParts)] =
          std::accumulate(&from_[first], &from_[first] + count, std::uint64_t(0));
    });
    return std::accumulate(sums.begin(), sums.end(), std::uint64_t(0));
  }

 private:
  static constexpr std::size_t kParts = 64;
  template <class Part>
  void forParts(const Part& part) const {
    const std::size_t count = from_.size() / kParts;
    parallelFor(kParts, 1, [&](std::size_t p) { part(p * count, count); });
  }
  std::vector<std::uint64_t> from_;
  std::vector<std::uint64_t> to_;
};

/// In turn, so that a busy machine slows all alike; one thread: processor time, else wall time.
void timeProducts(const SymmetricMatrix& matrix, int threads) {
  setThreads(threads);
  MemoryRates memory(matrix.bytes());
  std::vector<double> copies;
  std::vector<double> reads;
  std::vector<std::vector<double>> products(std::size(kColumns));
  std::uint64_t read = 0;
  const auto now = [&] { return threads == 1 ? threadSeconds() : wallSeconds(); };
  const auto note = [&](std::vector<double>& list, const auto& run) {
    const double start = now();
    run();
    list.push_back(now() - start);
  };
  for (int round = 0; round < kRounds; ++round) {
    note(copies, [&] { memory.copy(); });
    note(reads, [&] { read += memory.read(); });
    for (std::size_t c = 0; c < std::size(kColumns); ++c) {
      const std::vector<double> x = steps(kColumns[c]);
      std::vector<double> y(x.size());
      note(products[c], [&] { matrix.product(x, kColumns[c], y); });
    }
  }
  const double bytes = double(matrix.bytes());
  const double copy = 2 * bytes / least(copies);
  const double reading = bytes / least(reads);
  fmt::print("  {} thread{}: copies {:.1f} GB/s, reads {:.1f} GB/s{}\n", allowedThreads(),
             allowedThreads() == 1 ? "" : "s", 1e-9 * copy, 1e-9 * reading,
             read == 0 ? " (nothing)" : "");
  for (std::size_t c = 0; c < std::size(kColumns); ++c) {
    const double time = least(products[c]);
    fmt::print("  {:>7} | {:>8.1f} {:>8.1f} {:>8.2f} {:>8.2f} {:>10.2f} {:>10.2f}\n", kColumns[c],
               1e3 * time, 1e-9 * bytes / time, bytes / time / copy, bytes / time / reading,
               time / least(products[0]), time / least(products[0]) / kColumns[c]);
  }
}

}  // namespace

bool benchProducts() {
  fmt::print(
      "\nProducts with a dense symmetric matrix of {} patches in single precision: rates of its\n"
      "bytes, also over what copying (bytes read and written) and reading reach; the least of\n"
      "{} rounds.\n",
      kPatches, kRounds);
  const SymmetricMatrix matrix = denseMatrix();
  if (!agrees(matrix)) {
    fmt::print("  NOT VERIFIED: nothing is timed\n");
    return false;
  }
  fmt::print("  verified: products with constant columns are row sums\n");
  fmt::print("  {:>7} | {:>8} {:>8} {:>8} {:>8} {:>10} {:>10}\n", "columns", "ms", "GB/s",
             "of copy", "of read", "x of one", "a column");
  timeProducts(matrix, 1);
  timeProducts(matrix, 0);
  return true;
}

}  // namespace radiosity::bench
