#include "formfactor/scan_conversion.h"

#include <algorithm>
#include <utility>

namespace radiosity {
namespace {

/// The first pixel whose centre is not left of (or below) x, clamped to [0, limit].
int firstCentre(double x, int limit) {
  const double shifted = x - 0.5;
  if (!(shifted > 0)) return 0;
  if (shifted >= limit) return limit;
  const int below = int(shifted);  // std::ceil is a library call without SSE4.1
  return below + int(shifted > below);
}

}  // namespace

void ScanConversion::begin(int columns, int rows) {
  columns_ = columns;
  rows_ = rows;
  first_ = end_ = 0;
  further_.clear();
  runs_.clear();
  if (count_.size() < std::size_t(rows)) {
    count_.resize(std::size_t(rows));
    pair_.resize(2 * std::size_t(rows));
  }
}

void ScanConversion::reserveRows(int first, int end) {
  if (first_ == end_) {
    first_ = first;
    end_ = first;
  }
  for (; first_ > first; --first_) count_[std::size_t(first_ - 1)] = 0;
  for (; end_ < end; ++end_) count_[std::size_t(end_)] = 0;
}

void ScanConversion::addEdge(Point a, Point b) {
  if (b.y < a.y || (b.y == a.y && b.x < a.x)) std::swap(a, b);
  const int first = firstCentre(a.y, rows_);
  const int end = firstCentre(b.y, rows_);
  if (first == end) return;
  reserveRows(first, end);
  const double slope = (b.x - a.x) / (b.y - a.y);
  for (int y = first; y < end; ++y) {
    const int x = firstCentre(a.x + (y + 0.5 - a.y) * slope, columns_);
    const int k = count_[std::size_t(y)]++;
    if (k < 2) {
      pair_[2 * std::size_t(y) + std::size_t(k)] = x;
    } else {
      further_.push_back({y, x});
    }
  }
}

void ScanConversion::addLoop(const std::vector<Point>& loop) {
  for (std::size_t k = 0, last = loop.size() - 1; k < loop.size(); last = k++) {
    addEdge(loop[last], loop[k]);
  }
}

const std::vector<PixelRun>& ScanConversion::finish() {
  std::sort(further_.begin(), further_.end(),
            [](const Crossing& a, const Crossing& b) { return a.y < b.y; });
  auto further = further_.begin();
  for (int y = first_; y < end_; ++y) {
    const std::int32_t* pair = &pair_[2 * std::size_t(y)];
    const int count = count_[std::size_t(y)];
    if (count == 2) {
      const auto [begin, end] = std::minmax(pair[0], pair[1]);
      if (begin < end) runs_.push_back({y, begin, end});
      continue;
    }
    if (count == 0) continue;
    row_crossings_.assign(pair, pair + 2);
    for (; further != further_.end() && further->y == y; ++further) {
      row_crossings_.push_back(further->x);
    }
    std::sort(row_crossings_.begin(), row_crossings_.end());
    for (std::size_t k = 0; k + 1 < row_crossings_.size(); k += 2) {
      if (row_crossings_[k] < row_crossings_[k + 1]) {
        runs_.push_back({y, row_crossings_[k], row_crossings_[k + 1]});
      }
    }
  }
  return runs_;
}

}  // namespace radiosity
