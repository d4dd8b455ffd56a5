// How many bytes a matrix will take.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "matrix/matrix_row.h"
#include "matrix/run_row.h"
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

}  // namespace radiosity
