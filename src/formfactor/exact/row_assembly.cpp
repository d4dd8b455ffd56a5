#include "formfactor/exact/row_assembly.h"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace radiosity {
namespace {

/// Rows filled at once take about this much: half of a usual second-level cache, the rest is for
/// what the kernels read.
constexpr std::size_t kTileBytes = std::size_t(1) << 20;

std::size_t tileRows(const ElementSet& elements) {
  return std::max<std::size_t>(1, kTileBytes / (sizeof(double) * (elements.size() + 1)));
}

/// Adds the time from its making to its end to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(Clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& sum_;
  Clock::time_point start_;
};

/// A number of the pair that looks random and depends on nothing but the pair (SplitMix64, Steele,
/// Lea & Flood 2014).
std::uint64_t pairHash(Index row, Index column) {
  std::uint64_t z = ((std::uint64_t(row) << 32U) | column) + 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

}  // namespace

PatchOrder::PatchOrder(const PatchMesh& mesh, const ElementSet& elements)
    : rank(elements.patch_elements) {
  std::vector<Index> rank_of(mesh.size(), kNone);
  for (Index e = 0; e < elements.patch_elements; ++e) {
    const Index p = elements.patch[e];
    if (rank_of[p] == kNone) {
      rank_of[p] = Index(patch.size());
      patch.push_back(p);
      first_element.push_back(e);
      area.push_back(mesh.area[p] * elements.scale * elements.scale);
    }
    rank[e] = rank_of[p];
  }
  ranked = patch.size();
  first_element.push_back(Index(elements.patch_elements));
  for (Index p = 0; p < mesh.size(); ++p) {
    if (rank_of[p] == kNone) patch.push_back(p);
  }
}

RowSums& RowSums::operator+=(const RowSums& other) {
  error += other.error;
  visibility += other.visibility;
  unoccluded += other.unoccluded;
  partial += other.partial;
  seconds_visibility += other.seconds_visibility;
  seconds_unoccluded += other.seconds_unoccluded;
  seconds_partial += other.seconds_partial;
  seconds_assembly += other.seconds_assembly;
  return *this;
}

std::size_t RowAssembly::scratchBytes(const ElementSet& elements) {
  return sizeof(double) * (elements.size() + 1) * (tileRows(elements) + 1);
}

void RowAssembly::run(std::span<const ElementRange> ranges, RowSums& sums) {
  const ElementRange rows{ranges.front().first, ranges.back().end};
  task_first_ = rows.first;
  pairs_.clear();
  {
    const Stopwatch watch(sums.seconds_visibility);
    for (const ElementRange& range : ranges) {
      context_.visibility.classify(range, pairs_, sums.visibility);
    }
  }
  sortPartialByRow(rows);
  evaluatePartial(sums);
  const std::size_t end_rank = context_.order.rank[rows.end - 1] + 1;
  std::size_t rank = context_.order.rank[rows.first];
  while (rank < end_rank) rank = fillTile(rank, end_rank, sums);
}

void RowAssembly::sortPartialByRow(ElementRange rows) {
  std::vector<PartialPair>& pairs = pairs_.partial_pairs;
  row_end_.assign(rows.size() + 1, 0);
  for (const PartialPair& pair : pairs) ++row_end_[pair.row - rows.first + 1];
  std::partial_sum(row_end_.begin(), row_end_.end(), row_end_.begin());
  sorted_.resize(pairs.size());
  for (const PartialPair& pair : pairs) sorted_[row_end_[pair.row - rows.first]++] = pair;
  row_end_.pop_back();
  std::size_t begin = 0;
  const auto by_column = [](const PartialPair& a, const PartialPair& b) {
    return a.column < b.column;
  };
  for (const std::size_t end : row_end_) {
    std::sort(sorted_.begin() + std::ptrdiff_t(begin), sorted_.begin() + std::ptrdiff_t(end),
              by_column);
    begin = end;
  }
  pairs.swap(sorted_);
}

/// What each pair would exchange with nothing in between: neighbours in a row at once.
void RowAssembly::evaluateUnoccluded(RowSums& sums) {
  const Stopwatch watch(sums.seconds_unoccluded);
  std::vector<PartialPair>& pairs = pairs_.partial_pairs;
  for (std::size_t begin = 0; begin < pairs.size();) {
    std::size_t end = begin + 1;
    const Index row = pairs[begin].row;
    const Index facet = context_.elements.facet[pairs[begin].column];
    while (end < pairs.size() && pairs[end].row == row &&
           pairs[end].column == pairs[end - 1].column + 1 &&
           context_.elements.facet[pairs[end].column] == facet) {
      ++end;
    }
    unoccluded_.resize(end - begin);
    context_.unoccluded.block({row, row + 1}, {pairs[begin].column, pairs[end - 1].column + 1},
                              unoccluded_.data(), unoccluded_.size(), sums.unoccluded);
    for (std::size_t k = begin; k < end; ++k) pairs[k].unoccluded = unoccluded_[k - begin];
    begin = end;
  }
}

void RowAssembly::evaluatePartial(RowSums& sums) {
  evaluateUnoccluded(sums);
  const Stopwatch watch(sums.seconds_partial);
  partial_.resize(pairs_.partial_pairs.size());
  context_.partial.evaluate(pairs_.partial_pairs, pairs_.occluder_list, partial_, sums.partial);
  recheck(sums);
}

void RowAssembly::recheck(RowSums& sums) const {
  const PatchOrder& order = context_.order;
  for (std::size_t k = 0; k < partial_.size(); ++k) {
    const PartialPair& pair = pairs_.partial_pairs[k];
    if (pair.column >= context_.elements.patch_elements) continue;
    if (pairHash(pair.row, pair.column) % context_.recheck_every != 0) continue;
    const PartialExchange other = context_.partial.evaluateFromOtherEnd(pair, pairs_.occluder_list);
    const double a = order.area[order.rank[pair.row]];
    const double b = order.area[order.rank[pair.column]];
    sums.error.addRecheck(partial_[k].exchange - other.exchange, partial_[k].error, other.error,
                          1 / (a * a) + 1 / (b * b));
  }
}

std::size_t RowAssembly::fillTile(std::size_t first_rank, std::size_t end_rank, RowSums& sums) {
  const PatchOrder& order = context_.order;
  const std::size_t most = tileRows(context_.elements);
  std::size_t last_rank = first_rank + 1;
  while (last_rank < end_rank &&
         order.first_element[last_rank + 1] - order.first_element[first_rank] <= most) {
    ++last_rank;
  }
  const ElementRange rows{order.first_element[first_rank], order.first_element[last_rank]};
  tile_first_ = rows.first;
  width_ = context_.elements.size() - tile_first_;
  {
    const Stopwatch watch(sums.seconds_assembly);
    tile_.assign(rows.size() * width_, 0.0);
  }
  fillBlocks(rows, sums);
  const Stopwatch watch(sums.seconds_assembly);
  scatterPartial(rows, sums);
  for (std::size_t rank = first_rank; rank < last_rank; ++rank) {
    storePatch(rank, {order.first_element[rank], order.first_element[rank + 1]}, rows.first, sums);
  }
  return last_rank;
}

void RowAssembly::fillBlocks(ElementRange rows, RowSums& sums) {
  const Stopwatch watch(sums.seconds_unoccluded);
  for (const PairBlock& block : pairs_.blocks) {
    const ElementRange part{std::max(rows.first, block.rows.first),
                            std::min(rows.end, block.rows.end)};
    if (part.first >= part.end) continue;
    double* out = tileRow(part.first, rows.first) + (block.columns.first - tile_first_);
    context_.unoccluded.block(part, block.columns, out, width_, sums.unoccluded);
  }
}

void RowAssembly::scatterPartial(ElementRange rows, RowSums& sums) {
  const PatchOrder& order = context_.order;
  for (Index row = rows.first; row < rows.end; ++row) {
    const Index local = row - task_first_;
    double* out = tileRow(row, rows.first);
    const std::size_t begin = local == 0 ? 0 : row_end_[local - 1];
    for (std::size_t k = begin; k < row_end_[local]; ++k) {
      const Index column = pairs_.partial_pairs[k].column;
      const PartialExchange& value = partial_[k];
      out[column - tile_first_] = value.exchange;
      if (column < context_.elements.patch_elements) {
        sums.error.addPartial(order.rank[row], order.rank[column], value.error);
      }
    }
  }
}

void RowAssembly::storePatch(std::size_t rank, ElementRange rows, Index first_row, RowSums& sums) {
  const PatchOrder& order = context_.order;
  const std::size_t patch_elements = context_.elements.patch_elements;
  std::span<double> exchange;
  for (Index row = rows.first; row < rows.end; ++row) {
    double* values = tileRow(row, first_row);
    storeBacks(rank, {values + (patch_elements - tile_first_), values + width_});
    const bool one_to_one = order.ranked == patch_elements;
    if (one_to_one) {
      exchange = {values + (row - tile_first_), values + (patch_elements - tile_first_)};
      break;
    }
    if (row == rows.first) folded_.assign(order.ranked - rank, 0.0);
    for (std::size_t e = rows.end; e < patch_elements; ++e) {
      folded_[order.rank[e] - rank] += values[e - tile_first_];
    }
    exchange = folded_;
  }
  sums.error.addAndScale(rank, exchange, 1 / order.area[rank]);
  context_.matrix.setUpperRow(rank, exchange);
}

void RowAssembly::storeBacks(std::size_t rank, std::span<const double> bare) {
  const Index patch = context_.order.patch[rank];
  const ElementSet& elements = context_.elements;
  for (std::size_t k = 0; k < bare.size(); ++k) {
    if (!(bare[k] > 0)) continue;
    const double share = bare[k] / context_.order.area[rank];
    const Index surface =
        elements.patch[elements.patch_elements + k] - Index(context_.backs.size());
    context_.backs[patch] += share;
    std::vector<SeenBack>& seen = context_.seen_backs[patch];
    if (!seen.empty() && seen.back().surface == surface) {
      seen.back().share += share;
    } else {
      seen.push_back({surface, share});
    }
  }
}

}  // namespace radiosity
