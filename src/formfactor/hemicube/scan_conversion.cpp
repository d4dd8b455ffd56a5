#include "formfactor/hemicube/scan_conversion.h"

#include <algorithm>
#include <utility>

namespace radiosity {
namespace {

/// The first row whose centre is not below y, clamped to [0, limit].
int firstRow(double y, int limit) {
  const double shifted = y - 0.5;
  if (!(shifted > 0)) return 0;
  if (shifted >= limit) return limit;
  const int below = int(shifted);  // std::ceil is a library call without SSE4.1
  return below + int(shifted > below);
}

}  // namespace

void ScanConversion::begin(int columns, int rows) {
  columns_ = columns;
  rows_ = rows;
  loops_ = 0;
  edges_.clear();
  runs_.clear();
  if (up_.size() < std::size_t(rows)) {
    up_.resize(std::size_t(rows));
    down_.resize(std::size_t(rows));
  }
}

void ScanConversion::addLoop(const std::vector<Point>& loop) {
  ++loops_;
  Point from = loop.back();
  int from_row = firstRow(from.y, rows_);
  for (const Point& to : loop) {
    const int to_row = firstRow(to.y, rows_);
    if (from_row != to_row) {
      const bool upward = from_row < to_row;
      edges_.push_back({from, to, from_row, to_row, upward});
      Edge& edge = edges_.back();
      if (!upward) {
        std::swap(edge.low, edge.high);
        std::swap(edge.first, edge.end);
      }
    }
    from = to;
    from_row = to_row;
  }
}

/// A single loop that goes up once and down once crosses every row exactly twice.
bool ScanConversion::isMonotone() const {
  if (loops_ != 1 || edges_.empty()) return false;
  int turns = 0;
  bool upward = edges_.back().upward;
  for (const Edge& edge : edges_) {
    turns += edge.upward != upward;
    upward = edge.upward;
  }
  return turns == 2;
}

void ScanConversion::crossEdge(const Edge& edge, std::int32_t* crossings) const {
  const double slope = (edge.high.x - edge.low.x) / (edge.high.y - edge.low.y);
  cross_({edge.low.x, edge.low.y, slope, edge.first, edge.end, columns_}, crossings);
}

void ScanConversion::finishMonotone() {
  int first = rows_;
  int end = 0;
  for (const Edge& edge : edges_) {
    crossEdge(edge, (edge.upward ? up_ : down_).data() + edge.first);
    first = std::min(first, edge.first);
    end = std::max(end, edge.end);
  }
  for (int y = first; y < end; ++y) {
    const auto [left, right] = std::minmax(up_[std::size_t(y)], down_[std::size_t(y)]);
    addRun(y, left, right);
  }
}

/// Crossings sorted by row (counted first, so that they can be placed at once), then along it.
void ScanConversion::finishAny() {
  int first = rows_;
  int end = 0;
  row_end_.assign(std::size_t(rows_) + 1, 0);
  for (const Edge& edge : edges_) {
    for (int y = edge.first; y < edge.end; ++y) ++row_end_[std::size_t(y)];
    first = std::min(first, edge.first);
    end = std::max(end, edge.end);
  }
  std::int32_t total = 0;
  for (std::int32_t& count : row_end_) total += std::exchange(count, total);
  crossings_.resize(std::size_t(total));
  for (const Edge& edge : edges_) {
    crossEdge(edge, up_.data());
    for (int y = edge.first; y < edge.end; ++y) {
      // Starts as the row's begin; ends as its end once all its crossings are placed.
      crossings_[std::size_t(row_end_[std::size_t(y)]++)] = up_[std::size_t(y - edge.first)];
    }
  }
  auto at = crossings_.begin();
  for (int y = first; y < end; ++y) {
    const auto row_end = crossings_.begin() + row_end_[std::size_t(y)];
    std::sort(at, row_end);
    for (; at != row_end; at += 2) addRun(y, at[0], at[1]);
  }
}

const std::vector<PixelRun>& ScanConversion::finish() {
  if (isMonotone()) {
    finishMonotone();
  } else {
    finishAny();
  }
  return runs_;
}

}  // namespace radiosity
