// The errors of the entries that are estimates, a byte each.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/scratch_rows.h"
#include "matrix/uncertain_row.h"

namespace radiosity {

namespace {

/// A code is 255 + 4 log2(error), rounded: 255 stands for 1 and more, 1 for 2^-63.5.
constexpr int kStepsPerOctave = 4;
constexpr int kLargestCode = 255;
/// 2^(-7/8), 2^(-5/8), 2^(-3/8) and 2^(-1/8): from these on the logarithm rounds to the next step.
constexpr std::array<double, 4> kRoundedUp = {0.5452538663326288, 0.6484197773255048,
                                              0.7711054127039704, 0.9170040432046712};

std::uint8_t codeOf(double error) {
  if (error == 0) return 0;
  // The exponent and four comparisons give the logarithm to a quarter of an octave.
  int exponent = 0;
  const double fraction = std::frexp(error, &exponent);  // 1/2 to 1
  int step = 0;
  for (const double bound : kRoundedUp) step += fraction >= bound ? 1 : 0;
  return std::uint8_t(std::clamp(kLargestCode + kStepsPerOctave * (exponent - 1) + step, 0, 255));
}

}  // namespace

std::size_t bytesOf(const UncertainEntries::Row& row) {
  return row.codes.size() + row.runs.size() * sizeof(Run);
}

double errorOfCode(std::uint8_t code) {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> errors{};
    for (std::size_t c = 1; c < errors.size(); ++c) {
      errors[c] = std::exp2((double(c) - kLargestCode) / double(kStepsPerOctave));
    }
    return errors;
  }();
  return table[code];
}

UncertainEntries::UncertainEntries() = default;
UncertainEntries::UncertainEntries(std::size_t n, std::shared_ptr<ScratchMemory> scratch)
    : scratch_(std::move(scratch)) {
  rows_.reserve(n);
  for (std::size_t k = 0; k < n; ++k) {
    rows_.emplace_back(rowMemory(scratch_.get()));
  }
}
UncertainEntries::UncertainEntries(UncertainEntries&&) noexcept = default;
UncertainEntries::~UncertainEntries() = default;

std::size_t UncertainEntries::size() const { return rows_.size(); }
const UncertainEntries::Row& UncertainEntries::row(std::size_t k) const {
  touchRows(scratch_.get(), bytesOf(rows_[k]));
  return rows_[k];
}

void UncertainEntries::setRow(std::size_t k, std::span<const Index> later,
                              std::span<const double> errors) {
  if (k >= size() || later.size() != errors.size()) {
    throw InputError(fmt::format("uncertain entries: {} positions and {} errors for row {} of {}",
                                 later.size(), errors.size(), k, size()));
  }
  for (std::size_t m = 0; m < later.size(); ++m) {
    const bool in_order = later[m] >= k && later[m] < size() && (m == 0 || later[m] > later[m - 1]);
    if (in_order && errors[m] >= 0 && std::isfinite(errors[m])) continue;
    throw InputError(fmt::format(
        "uncertain entries, row {}: position {} is out of order or its error {} is no error", k,
        later[m], errors[m]));
  }
  Row row;
  if (!later.empty() && later[0] == k) {
    row.own = codeOf(errors[0]);
    later = later.subspan(1);
    errors = errors.subspan(1);
  }
  RunFinder finder(sizeof(std::uint8_t));
  for (const auto position : later) finder.add(position - k - 1, position - k);
  row.runs = finder.take();
  std::size_t stored = 0;
  for (const Run run : row.runs) stored += run.count;
  row.codes.assign(stored, 0);
  std::size_t m = 0;
  forRuns(std::span<const Run>(row.runs), row.codes.data(),
          [&](std::size_t offset, std::uint8_t* codes, std::size_t count) {
            for (; m < later.size() && later[m] - k - 1 < offset + count; ++m) {
              codes[later[m] - k - 1 - offset] = codeOf(errors[m]);
            }
          });
  rows_[k] = std::move(row);
  touchRows(scratch_.get(), bytesOf(rows_[k]));
}

std::size_t UncertainEntries::entries() const {
  std::size_t count = 0;
  for (const Row& row : rows_) {
    count += (row.own != 0 ? 1u : 0u) + row.codes.size() -
             std::size_t(std::count(row.codes.begin(), row.codes.end(), std::uint8_t(0)));
  }
  return count;
}

std::size_t UncertainEntries::bytes() const {
  std::size_t total = 0;
  for (const Row& row : rows_) total += bytesOf(row);
  return total;
}

}  // namespace radiosity
