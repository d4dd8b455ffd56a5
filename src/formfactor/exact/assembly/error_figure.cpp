#include "formfactor/exact/assembly/error_figure.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "formfactor/exact/error_model.h"

namespace radiosity {
namespace {

/// The number of rows drawn, and the most pairs of each.
constexpr std::size_t kRowsDrawn = 2000;
constexpr double kMostDrawn = 1024;
/// Weights of rechecked pairs are rounded to shares of this many places a pair.
constexpr std::size_t kPlacesAPair = 8;
/// Share of the drawn rows that the figure must cover.
constexpr double kQuantile = 0.99;

}  // namespace

ErrorSums::PairErrors& ErrorSums::PairErrors::operator+=(const PairErrors& other) {
  squares += other.squares;
  fourths += other.fourths;
  return *this;
}

double ErrorSums::PairErrors::figure() const { return squares + std::sqrt(fourths); }

ErrorSums& ErrorSums::operator+=(const ErrorSums& other) {
  for (std::size_t i = 0; i < squares_.size(); ++i) {
    squares_[i] += other.squares_[i];
    occluded_[i] += other.occluded_[i];
    black_backs_[i] += other.black_backs_[i];
  }
  rechecks_.insert(rechecks_.end(), other.rechecks_.begin(), other.rechecks_.end());
  return *this;
}

namespace {

/// Writes the rows from `first` on that have any pairs, with their numbers: most have none.
template <class PairErrors>
void putPairs(const std::vector<PairErrors>& rows, std::size_t first, ByteWriter& bytes) {
  const auto has = [](const PairErrors& row) { return row.squares > 0; };
  bytes.putVarint(
      std::size_t(std::count_if(rows.begin() + std::ptrdiff_t(first), rows.end(), has)));
  for (std::size_t i = first; i < rows.size(); ++i) {
    if (!has(rows[i])) continue;
    bytes.putVarint(i);
    bytes.put(rows[i]);
  }
}

template <class PairErrors>
void takePairs(ByteReader& bytes, std::vector<PairErrors>& rows) {
  std::size_t count = bytes.getVarint();
  for (; count > 0 && bytes.left() > 0; --count) {
    const std::size_t i = bytes.getVarint();
    const auto row = bytes.get<PairErrors>();
    if (i < rows.size()) rows[i] = row;
  }
}

}  // namespace

void ErrorSums::put(std::size_t first, ByteWriter& bytes) const {
  bytes.putArray(std::span(squares_).subspan(first));
  putPairs(occluded_, first, bytes);
  putPairs(black_backs_, first, bytes);
  bytes.putArray(std::span(rechecks_));
}

bool ErrorSums::take(std::size_t first, ByteReader& bytes) {
  const std::vector<double> squares = bytes.getArray<double>();
  if (first + squares.size() != squares_.size()) return false;
  std::copy(squares.begin(), squares.end(), squares_.begin() + std::ptrdiff_t(first));
  takePairs(bytes, occluded_);
  takePairs(bytes, black_backs_);
  rechecks_ = bytes.getArray<Recheck>();
  return true;
}

void ErrorSums::addAndScale(std::size_t row, std::span<double> exchange, double inverse_area) {
  // Two passes of independent elements, and one sum in four lanes: the compiler may vectorise all
  // of it without reordering an addition.
  double* squares = squares_.data() + row;
  const std::size_t n = exchange.size();
  double lane[4] = {};
  std::size_t m = 0;
  for (; m + 4 <= n; m += 4) {
    for (std::size_t l = 0; l < 4; ++l) {
      const double square = exchange[m + l] * exchange[m + l];
      squares[m + l] += square;
      lane[l] += square;
      exchange[m + l] *= inverse_area;
    }
  }
  for (; m < n; ++m) {
    const double square = exchange[m] * exchange[m];
    squares[m] += square;
    lane[0] += square;
    exchange[m] *= inverse_area;
  }
  squares[0] += (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

double ErrorSums::weightedSquares(std::span<const double> area) const {
  double sum = 0;
  for (std::size_t i = 0; i < area.size(); ++i) sum += squares_[i] / area[i];
  return sum;
}

/// Rechecked pairs by number, each as often as it weighs in the stated errors of its two rows.
std::vector<std::uint32_t> ErrorSums::recheckedByWeight() const {
  std::vector<double> until;
  double all = 0;
  for (const Recheck& pair : rechecks_) {
    for (const std::size_t row : {pair.row, pair.column}) {
      const double squares = occluded_[row].squares;
      if (squares > 0) all += pair.stated * pair.stated / squares;
    }
    until.push_back(all);
  }
  std::vector<std::uint32_t> numbers;
  if (!(all > 0)) return numbers;
  const std::size_t places = kPlacesAPair * rechecks_.size();
  for (std::uint32_t k = 0; numbers.size() < places; ++k) {
    const double end = until[k] / all * double(places);
    while (double(numbers.size()) + 0.5 < end) numbers.push_back(k);
  }
  return numbers;
}

double ErrorSums::recheckRatio() const {
  // For each row, the number of equal errors that scatter like its own.
  std::vector<double> counts;
  for (const PairErrors& row : occluded_) {
    if (row.fourths > 0) counts.push_back(row.squares * row.squares / row.fourths);
  }
  const std::vector<std::uint32_t> by_weight = recheckedByWeight();
  if (counts.empty() || by_weight.empty()) return 0;
  // Numbers that are the same on every machine, unlike those of the library's distributions.
  std::mt19937 random;
  std::vector<double> ratios;
  for (std::size_t r = 0; r < kRowsDrawn; ++r) {
    const double count = std::clamp(std::round(counts[random() % counts.size()]), 1.0, kMostDrawn);
    double square = 0;
    for (std::size_t k = 0; k < std::size_t(count); ++k) {
      const Recheck& pair = rechecks_[by_weight[random() % by_weight.size()]];
      const double share = pair.difference / pair.stated;
      square += share * share;
    }
    ratios.push_back(square / count / (1 + 1 / std::sqrt(count)));
  }
  const auto place = ratios.begin() + std::ptrdiff_t(kQuantile * double(ratios.size() - 1));
  std::nth_element(ratios.begin(), place, ratios.end());
  return std::sqrt(*place);
}

double ErrorSums::raise() const { return std::max(1.0, kRowAlike * recheckRatio()); }

double ErrorSums::figures(std::span<const double> area, double closed_form,
                          std::span<double> figure) const {
  const double raised = raise();
  const double closed = kRowClosedForms * closed_form;
  double errors = 0;
  for (std::size_t i = 0; i < figure.size(); ++i) {
    const double closed_forms = closed * closed * squares_[i];
    PairErrors row = occluded_[i];
    errors += (closed_forms + raised * raised * row.figure()) / area[i];
    row += black_backs_[i];
    figure[i] = std::sqrt(closed_forms + raised * raised * row.figure()) / area[i];
  }
  const double squares = weightedSquares(area);
  return squares > 0 ? std::sqrt(errors / squares) : 0.0;
}

}  // namespace radiosity
