#include "page/factor_codes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace radiosity::page {

namespace {

/// The most that all omitted pairs of a row sum to.
constexpr double kNegligibleRow = 1e-9;

/// Calls visit(i, j, F_ij) for j >= i, row by row, columns increasing.
template <class Visit>
void forUpper(const ExchangeMatrix& matrix, Progress& progress, const Visit& visit) {
  matrix.forPanels([&](const RowPanel& panel) {
    for (std::size_t i = panel.first(); i < panel.last(); ++i) {
      progress.check();
      panel.forRow(i, i, matrix.size(), [&](Index j, double factor) { visit(i, j, factor); });
      progress.advance();
    }
  });
}

/// Finds the range of all pairs, then gives each pair its code.
class Encoder {
 public:
  Encoder(const ExchangeMatrix& matrix, Progress& progress)
      : matrix_(matrix),
        progress_(progress),
        negligible_(kNegligibleRow / double(std::max<std::size_t>(matrix.size(), 1))),
        row_error_(matrix.size(), 0.0) {}

  FactorCodes run() {
    progress_.begin("codes of form factors", 2 * matrix_.size(), "rows");
    chooseScale();
    encode();
    progress_.end();
    codes_.quantisation.largest_row_error =
        row_error_.empty() ? 0 : *std::max_element(row_error_.begin(), row_error_.end());
    return std::move(codes_);
  }

 private:
  double backwards(std::size_t i, std::size_t j, double factor) const {
    return factor * matrix_.area()[i] / matrix_.area()[j];
  }
  bool isKept(std::size_t i, std::size_t j, double factor) const {
    return std::max(factor, backwards(i, j, factor)) >= negligible_;
  }

  /// Chooses the scale: code 1 is the smallest value that is kept, the last code the largest.
  void chooseScale() {
    double smallest = std::numeric_limits<double>::infinity();
    double largest = 0;
    forUpper(matrix_, progress_, [&](std::size_t i, Index j, double factor) {
      if (!isKept(i, j, factor)) {
        ++codes_.quantisation.left_out;
        return;
      }
      ++codes_.pairs;
      smallest = std::min(smallest, factor);
      largest = std::max(largest, factor);
    });
    if (codes_.pairs == 0) return;
    FactorQuantisation& q = codes_.quantisation;
    q.step = std::log(largest / smallest) / double(FactorCodes::kLargestCode - 1);
    q.lowest = std::log(smallest) - q.step;
    q.largest_relative_error = std::expm1(q.step / 2);
  }

  std::uint16_t codeOf(double factor) const {
    const FactorQuantisation& q = codes_.quantisation;
    if (q.step == 0) return 1;
    const double steps = std::round((std::log(factor) - q.lowest) / q.step);
    return std::uint16_t(std::clamp(steps, 1.0, double(FactorCodes::kLargestCode)));
  }

  void addError(std::size_t i, std::size_t j, double factor, std::uint16_t code) {
    const FactorQuantisation& q = codes_.quantisation;
    const double decoded = code == 0 ? 0 : std::exp(q.lowest + q.step * double(code));
    const double error = std::abs(decoded - factor);
    row_error_[i] += error;
    if (i != j) row_error_[j] += backwards(i, j, error);
  }

  void encode() {
    const std::size_t n = matrix_.size();
    const bool dense = codes_.pairs > n * (n + 1) / 4;
    codes_.begin.assign(n + 1, 0);
    codes_.code.reserve(dense ? n * (n + 1) / 2 : codes_.pairs);
    if (!dense) codes_.column.reserve(codes_.pairs);
    // The first code of row i: dense rows before it have n, n - 1, ... codes.
    const auto denseBegin = [&](std::size_t i) { return i * (2 * n + 1 - i) / 2; };
    if (dense) codes_.code.assign(denseBegin(n), 0);
    forUpper(matrix_, progress_, [&](std::size_t i, Index j, double factor) {
      const std::uint16_t code = isKept(i, j, factor) ? codeOf(factor) : 0;
      addError(i, j, factor, code);
      if (code == 0) return;
      if (dense) {
        codes_.code[denseBegin(i) + (j - i)] = code;
      } else {
        codes_.column.push_back(j);
        codes_.code.push_back(code);
        ++codes_.begin[i + 1];
      }
    });
    for (std::size_t i = 0; i < n; ++i) {
      codes_.begin[i + 1] =
          dense ? std::uint32_t(denseBegin(i + 1)) : codes_.begin[i] + codes_.begin[i + 1];
    }
  }

  const ExchangeMatrix& matrix_;
  Progress& progress_;
  double negligible_;
  std::vector<double> row_error_;
  FactorCodes codes_;
};

}  // namespace

FactorCodes encodeFactors(const ExchangeMatrix& matrix, Progress& progress) {
  assert(matrix.isSymmetric());
  return Encoder(matrix, progress).run();
}

}  // namespace radiosity::page
