// Estimates of the bytes that a matrix will take.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "matrix/expected_bytes.h"
#include "matrix/run_row.h"
#include "matrix/uncertain_row.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {

std::size_t estimateRowFormBytes(std::size_t n, double entries_per_row, Precision precision) {
  const auto value = double(valueBytes(precision));
  const double sparse = entries_per_row * (value + sizeof(Index));
  const double dense = double(n) * value;
  return std::size_t(std::ceil(double(n) * std::min(sparse, dense)));
}

std::size_t estimateSymmetricBytes(std::size_t n, double entries_per_row, Precision precision) {
  // Half of the entries, each a run of its own at worst; dense rows have one run to 65,535 values.
  const auto value = double(valueBytes(precision));
  const double half = std::min(entries_per_row, double(n)) / 2;
  const double dense_runs = 1 + double(n) / std::numeric_limits<std::uint16_t>::max();
  const double sparse = half * (value + sizeof(Run));
  const double dense = double(n) / 2 * value + dense_runs * sizeof(Run);
  return std::size_t(std::ceil(double(n) * (std::min(sparse, dense) + sizeof(RunRow))));
}

namespace {

/// The share of a row's places without an entry nearby.
double gapShare(std::size_t n, double entries_per_row) {
  constexpr double kClose = 1.5;
  return n == 0 ? 0 : std::max(0.0, 1 - kClose * entries_per_row / double(n));
}

}  // namespace

std::size_t expectedSymmetricBytes(std::size_t n, double entries_per_row, Precision precision) {
  const double gaps = gapShare(n, entries_per_row);
  const double entry = double(valueBytes(precision)) + gaps * gaps * sizeof(Run);
  return std::size_t(double(n) * (entries_per_row / 2 * entry + sizeof(RunRow) + sizeof(double)));
}

std::size_t expectedUncertainBytes(std::size_t n, double entries_per_row) {
  const double gaps = gapShare(n, entries_per_row);
  const double entry = sizeof(std::uint8_t) + gaps * gaps * gaps * gaps * sizeof(Run);
  return std::size_t(double(n) * (entries_per_row / 2 * entry + sizeof(UncertainEntries::Row)));
}

}  // namespace radiosity
