#include "formfactor/exact/assembly/row_assembly.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <unordered_map>

#include "base/hash.h"
#include "base/processor_clock.h"

namespace radiosity {
namespace {

/// About this share of the occluded pairs is evaluated again.
constexpr double kRecheckShare = 1.0 / 256;
/// At least this many pairs are evaluated again, as far as there are. In double precision they are
/// more: fewer pairs hold the errors that rules miss there, and pairs cost more to begin with.
constexpr double kRecheckLeast = 512;
constexpr double kRecheckLeastTight = 1024;

/// What a receiver gets is to be good to 5%. Those that get less than this share of the mean are
/// dark: their errors count as if they got so much.
constexpr double kAcceptedShare = 0.04;
constexpr double kDark = 0.01;

/// Adds the processor time of this thread from its making to its end to a sum.
class ProcessorTime {
 public:
  explicit ProcessorTime(double& sum) : sum_(sum), start_(processorSeconds()) {}
  ~ProcessorTime() { sum_ += processorSeconds() - start_; }
  ProcessorTime(const ProcessorTime&) = delete;
  ProcessorTime& operator=(const ProcessorTime&) = delete;

 private:
  double& sum_;
  double start_;
};

/// A number of the pair that looks random and depends on nothing but the pair.
std::uint64_t pairHash(Index row, Index column) {
  return mixed(((std::uint64_t(row) << 32U) | column) + 0x9e3779b97f4a7c15ULL);
}

}  // namespace

std::size_t recheckEvery(double occluded_pairs, double tolerance) {
  const double least = tolerance < kSinglePrecision ? kRecheckLeastTight : kRecheckLeast;
  const double share = std::max(kRecheckShare, least / std::max(occluded_pairs, 1.0));
  return std::size_t(std::max(1.0, 1 / share));
}

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

Emitters::Emitters(const PatchMesh& mesh, const PatchOrder& order, std::span<const Index> patches)
    : emits(mesh.size(), 0),
      scene_area(std::accumulate(order.area.begin(), order.area.end(), 0.0)) {
  for (const Index i : patches) emits[i] = 1;
}

RowSums& RowSums::operator+=(const RowSums& other) {
  error += other.error;
  visibility += other.visibility;
  unoccluded += other.unoccluded;
  occluded += other.occluded;
  seconds_visibility += other.seconds_visibility;
  seconds_unoccluded += other.seconds_unoccluded;
  seconds_occluded += other.seconds_occluded;
  seconds_assembly += other.seconds_assembly;
  return *this;
}

void RowAssembly::run(std::span<const ElementRange> ranges, RowSums& sums) {
  const ElementRange rows{ranges.front().first, ranges.back().end};
  first_ = rows.first;
  width_ = context_.elements.size() - first_;
  const std::size_t places = (rows.size() * width_ + kMarks - 1) / kMarks * kMarks;
  if (panel_.size() < places) panel_.resize(places);
  marked_.assign(places, 0);
  classify(ranges, sums);
  evaluateOccluded(sums);
  if (context_.uncertain != nullptr) storeUncertain(rows);
  storePatches(rows, sums);
}

void RowAssembly::classify(std::span<const ElementRange> ranges, RowSums& sums) {
  pairs_.clear();
  for (const ElementRange& range : ranges) {
    const std::size_t first_block = pairs_.blocks.size();
    const std::size_t first_pair = pairs_.occluded_pairs.size();
    {
      const ProcessorTime watch(sums.seconds_visibility);
      context_.visibility.classify(range, pairs_, sums.visibility);
    }
    const ProcessorTime watch(sums.seconds_unoccluded);
    evaluateUnoccluded(range, first_block, first_pair, sums);
  }
}

void RowAssembly::evaluateUnoccluded(ElementRange range, std::size_t first_block,
                                     std::size_t first_pair, RowSums& sums) {
  const ColumnChunks& chunks = context_.chunks;
  for (std::size_t b = first_block; b < pairs_.blocks.size(); ++b) {
    const PairBlock& block = pairs_.blocks[b];
    const auto begin = asked_.begin() + chunks.of_element[block.columns.first];
    const auto end = asked_.begin() + chunks.of_element[block.columns.end - 1] + 1;
    std::fill(begin, end, std::uint8_t(1));
    for (Index row = block.rows.first; row < block.rows.end; ++row) {
      std::fill_n(marked_.begin() + std::ptrdiff_t(place(row, block.columns.first)),
                  block.columns.size(), std::uint8_t(1));
    }
  }
  for (std::size_t k = first_pair; k < pairs_.occluded_pairs.size(); ++k) {
    asked_[chunks.of_element[pairs_.occluded_pairs[k].column]] = 1;
  }
  const std::vector<ElementRange>& ranges = chunks.ranges;
  for (std::size_t c = chunks.of_element[range.end - 1]; c < ranges.size();) {
    std::size_t end = c;
    // Take neighbours of one facet at once.
    while (end < ranges.size() && asked_[end] != 0 &&
           context_.elements.facet[ranges[end].first] == context_.elements.facet[ranges[c].first]) {
      asked_[end++] = 0;
    }
    if (end > c) {
      const ElementRange columns{ranges[c].first, ranges[end - 1].end};
      context_.unoccluded.block(range, columns, &panel_[place(range.first, columns.first)], width_,
                                sums.unoccluded);
    }
    c = std::max(end, c + 1);
  }
  dropPairsWithoutExchange(first_pair, sums);
}

/// Drops the pairs below each other's horizon, which need no clipping.
void RowAssembly::dropPairsWithoutExchange(std::size_t first_pair, RowSums& sums) {
  std::vector<OccludedPair>& pairs = pairs_.occluded_pairs;
  std::size_t kept = first_pair;
  for (std::size_t k = first_pair; k < pairs.size(); ++k) {
    pairs[k].unoccluded = panel_[place(pairs[k].row, pairs[k].column)];
    if (pairs[k].unoccluded > 0) pairs[kept++] = pairs[k];
  }
  sums.visibility.occluded -= pairs.size() - kept;
  sums.visibility.no_exchange += pairs.size() - kept;
  pairs.resize(kept);
}

void RowAssembly::evaluateOccluded(RowSums& sums) {
  const ProcessorTime watch(sums.seconds_occluded);
  const PatchOrder& order = context_.order;
  const std::vector<OccludedPair>& pairs = pairs_.occluded_pairs;
  occluded_.resize(pairs.size());
  context_.occluded.evaluate(pairs, pairs_.occluder_list, occluded_, sums.occluded,
                             &context_.progress);
  replaceUncertain();
  recheck(sums);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [row, column, begin, end, unoccluded] = pairs[k];
    panel_[place(row, column)] = occluded_[k].exchange;
    marked_[place(row, column)] = 1;
    const Index a = order.rank[row];
    if (column < context_.elements.patch_elements) {
      const Index b = order.rank[column];
      sums.error.addOccluded(a, b, occluded_[k].error);
    } else {
      sums.error.addBlackBack(a, occluded_[k].error);
    }
  }
}

Index RowAssembly::receiverOf(const OccludedPair& pair) const {
  const std::vector<std::uint8_t>& emits = context_.emitters->emits;
  if (pair.column >= context_.elements.patch_elements) return kNone;
  const Index row = context_.elements.patch[pair.row];
  const Index column = context_.elements.patch[pair.column];
  if (emits[row] != 0) return column;
  return emits[column] != 0 ? row : kNone;
}

std::vector<std::size_t> RowAssembly::uncertainPairs() const {
  const ElementSet& elements = context_.elements;
  const std::vector<OccludedPair>& pairs = pairs_.occluded_pairs;
  const double scene_area = context_.emitters->scene_area;
  struct Received {
    double exchange = 0;
    double mean = 0;    ///< the exchange if all surfaces got the same
    double square = 0;  ///< of the error, without pairs that are evaluated again
  };
  std::unordered_map<Index, Received> lights;
  std::vector<std::size_t> by_error;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Index receiver = receiverOf(pairs[k]);
    if (receiver == kNone) continue;
    Received& light = lights[receiver];
    light.exchange += occluded_[k].exchange;
    light.mean += elements.area[pairs[k].row] * elements.area[pairs[k].column] / scene_area;
    light.square += occluded_[k].error * occluded_[k].error;
    if (!occluded_[k].cut_short) by_error.push_back(k);
  }
  std::ranges::stable_sort(by_error, std::ranges::greater(),
                           [&](std::size_t k) { return occluded_[k].error; });
  std::vector<std::size_t> uncertain;
  for (const std::size_t k : by_error) {
    Received& light = lights[receiverOf(pairs[k])];
    const double accepted = kAcceptedShare * std::max(light.exchange, kDark * light.mean);
    if (light.square <= accepted * accepted) continue;
    light.square -= occluded_[k].error * occluded_[k].error;
    uncertain.push_back(k);
  }
  return uncertain;
}

void RowAssembly::replaceUncertain() {
  if (context_.emitters == nullptr) return;
  const std::vector<std::size_t> which = uncertainPairs();
  const std::vector<OccludedExchange> strict = strictly(which);
  for (std::size_t m = 0; m < which.size(); ++m) occluded_[which[m]] = strict[m];
}

/// A strict evaluation of some occluded pairs.
std::vector<OccludedExchange> RowAssembly::strictly(std::span<const std::size_t> which) const {
  std::vector<OccludedExchange> strict(which.size());
  if (which.empty()) return strict;
  std::vector<OccludedPair> pairs;
  pairs.reserve(which.size());
  for (const std::size_t k : which) pairs.push_back(pairs_.occluded_pairs[k]);
  context_.occluded.evaluateStrictly(pairs, pairs_.occluder_list, strict, &context_.progress);
  return strict;
}

/// Pairs that are evaluated again keep the stricter value, with the error stated before: that is
/// what the others of their rows are judged by.
void RowAssembly::recheck(RowSums& sums) {
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < occluded_.size(); ++k) {
    const OccludedPair& pair = pairs_.occluded_pairs[k];
    if (pair.column >= context_.elements.patch_elements) continue;
    if (occluded_[k].cut_short) continue;  // it would take as long again, and has stated its error
    if (pairHash(pair.row, pair.column) % context_.recheck_every != 0) continue;
    which.push_back(k);
  }
  const std::vector<OccludedExchange> strict = strictly(which);
  for (std::size_t k = 0; k < which.size(); ++k) {
    OccludedExchange& found = occluded_[which[k]];
    const OccludedPair& pair = pairs_.occluded_pairs[which[k]];
    sums.error.addRecheck(context_.order.rank[pair.row], context_.order.rank[pair.column],
                          found.exchange - strict[k].exchange, found.error);
    found.exchange = strict[k].exchange;
  }
}

void RowAssembly::storeUncertain(ElementRange rows) {
  const PatchOrder& order = context_.order;
  const auto isCounted = [&](std::size_t k) {
    return pairs_.occluded_pairs[k].column < context_.elements.patch_elements;
  };
  // Dealt out by rows: within a row they mostly stand in order already.
  const Index first = order.rank[rows.first];
  const Index count = order.rank[rows.end - 1] + 1 - first;
  row_begin_.assign(count + 2, 0);
  for (std::size_t k = 0; k < occluded_.size(); ++k) {
    if (isCounted(k)) ++row_begin_[order.rank[pairs_.occluded_pairs[k].row] - first + 2];
  }
  std::partial_sum(row_begin_.begin(), row_begin_.end(), row_begin_.begin());
  uncertain_.resize(row_begin_.back());
  for (std::size_t k = 0; k < occluded_.size(); ++k) {
    if (!isCounted(k)) continue;
    const OccludedPair& pair = pairs_.occluded_pairs[k];
    const Index row = order.rank[pair.row];
    uncertain_[row_begin_[row - first + 1]++] = {order.rank[pair.column],
                                                 occluded_[k].error / order.area[row]};
  }
  for (std::size_t r = 0; r < count; ++r) {
    storeUncertainRow(
        first + r, std::span(uncertain_).subspan(row_begin_[r], row_begin_[r + 1] - row_begin_[r]));
  }
}

void RowAssembly::storeUncertainRow(std::size_t rank, std::span<Uncertain> entries) {
  if (entries.empty()) return;
  if (!std::is_sorted(entries.begin(), entries.end())) std::sort(entries.begin(), entries.end());
  later_.clear();
  errors_.clear();
  for (const auto& [column, error] : entries) {
    if (!later_.empty() && later_.back() == column) {
      errors_.back() += error;  // another piece of the same patches
    } else {
      later_.push_back(column);
      errors_.push_back(error);
    }
  }
  context_.uncertain->setRow(rank, later_, errors_);
}

void RowAssembly::storePatches(ElementRange rows, RowSums& sums) {
  const ProcessorTime watch(sums.seconds_assembly);
  const PatchOrder& order = context_.order;
  clearUnmarked();
  const std::size_t end = order.rank[rows.end - 1] + 1;
  for (std::size_t rank = order.rank[rows.first]; rank < end; ++rank) {
    const std::span<double> exchange =
        patchRow(rank, {order.first_element[rank], order.first_element[rank + 1]});
    assert(std::all_of(exchange.begin(), exchange.end(), [](double g) { return g >= 0; }));
    sums.error.addAndScale(rank, exchange, 1 / order.area[rank]);
    context_.matrix.setUpperRow(rank, exchange);
  }
}

/// Sets places without a mark to 0. Reads eight marks at a time: mostly all or none are set.
void RowAssembly::clearUnmarked() {
  constexpr std::uint64_t kAllMarked = 0x0101010101010101ULL;
  for (std::size_t k = 0; k < marked_.size(); k += kMarks) {
    std::uint64_t marks = 0;
    std::memcpy(&marks, &marked_[k], kMarks);
    if (marks == kAllMarked) continue;
    for (std::size_t m = k; m < k + kMarks; ++m) panel_[m] = marked_[m] != 0 ? panel_[m] : 0.0;
  }
}

std::span<double> RowAssembly::patchRow(std::size_t rank, ElementRange rows) {
  const PatchOrder& order = context_.order;
  const Index patch_elements = Index(context_.elements.patch_elements);
  for (Index row = rows.first; row < rows.end; ++row) {
    const std::size_t black = context_.elements.size() - patch_elements;
    storeBacks(rank, {panel_.data() + (place(row, first_) + (patch_elements - first_)), black});
  }
  if (order.ranked == patch_elements) {  // every patch is one element
    return {&panel_[place(rows.first, rows.first)], patch_elements - rows.first};
  }
  folded_.assign(order.ranked - rank, 0.0);
  for (Index row = rows.first; row < rows.end; ++row) {
    const double* values = panel_.data() + place(row, first_);
    for (Index e = rows.end; e < patch_elements; ++e) {
      folded_[order.rank[e] - rank] += values[e - first_];
    }
  }
  return folded_;
}

void RowAssembly::storeBacks(std::size_t rank, std::span<const double> black) {
  const Index patch = context_.order.patch[rank];
  const ElementSet& elements = context_.elements;
  for (std::size_t k = 0; k < black.size(); ++k) {
    if (!(black[k] > 0)) continue;
    const double share = black[k] / context_.order.area[rank];
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
