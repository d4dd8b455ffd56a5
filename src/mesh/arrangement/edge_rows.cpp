#include "mesh/arrangement/edge_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radiosity {

namespace {

// The number of rows that an edge may be in, on average.
constexpr std::size_t kCopies = 8;

struct Range {
  double low;
  double high;
};

}  // namespace

EdgeRows::EdgeRows(const WeldedPoints& points, const PlaneImage& image,
                   const std::vector<std::array<Index, 2>>& edges, double margin) {
  std::vector<Range> ranges;
  ranges.reserve(edges.size());
  double high = -std::numeric_limits<double>::infinity();
  low_ = -high;
  for (const auto& [a, b] : edges) {
    const auto [from, to] = std::minmax({image(points[a]).y, image(points[b]).y});
    ranges.push_back({from - margin, to + margin});
    low_ = std::min(low_, ranges.back().low);
    high = std::max(high, ranges.back().high);
  }
  const auto divide = [&](std::size_t rows) {
    rows_per_metre_ = high > low_ ? double(rows) / (high - low_) : 0.0;
    begin_.assign(rows + 1, 0);
    std::size_t total = 0;
    for (const Range& r : ranges) total += row(r.high) - row(r.low) + 1;
    return total;
  };
  std::size_t rows = std::max<std::size_t>(1, edges.size());
  while (divide(rows) > kCopies * edges.size() && rows > 1) rows /= 2;
  for (const Range& r : ranges) {
    for (std::size_t k = row(r.low); k <= row(r.high); ++k) ++begin_[k + 1];
  }
  for (std::size_t k = 0; k + 1 < begin_.size(); ++k) begin_[k + 1] += begin_[k];
  edges_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t e = 0; e < ranges.size(); ++e) {
    for (std::size_t k = row(ranges[e].low); k <= row(ranges[e].high); ++k) {
      edges_[next[k]++] = Index(e);
    }
  }
}

std::size_t EdgeRows::row(double y) const {
  const double k = std::floor((y - low_) * rows_per_metre_);
  return std::size_t(std::clamp(k, 0.0, double(begin_.size() - 2)));
}

std::span<const Index> EdgeRows::at(double y) const {
  const std::size_t k = row(y);
  return {edges_.data() + begin_[k], begin_[k + 1] - begin_[k]};
}

std::vector<Index> EdgeRows::between(double low, double high) const {
  const auto first = edges_.begin() + std::ptrdiff_t(begin_[row(low)]);
  const auto last = edges_.begin() + std::ptrdiff_t(begin_[row(high) + 1]);
  std::vector<Index> out(first, last);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace radiosity
