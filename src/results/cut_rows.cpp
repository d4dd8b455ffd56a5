#include "results/cut_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "results/column_writer.h"

namespace radiosity {

using h5::ColumnWriter;
using h5::Number;

namespace {

constexpr unsigned kSecondHits = 16;  // bits
constexpr std::uint32_t kFirstHits = 0xffff;
/// Far beyond what balancing gives.
constexpr double kMostCounts = 1e3;

/// What the arrays are called; one place for all that reads and writes them.
template <class Sink>
void putArrays(Sink& group, const CutParts& parts, std::span<const Index> order,
               std::span<const float> features, std::span<const double> counts,
               std::span<const std::int64_t> starts) {
  const std::size_t rows = parts.of_a_hit.size();
  group.attribute("bias", Number::f64, 1, &parts.bias);
  group.dataset("order", {h5::numberOf<Index>(), rows, 0}, order.data(), "");
  group.dataset("features", {Number::f32, rows, kPatchFeatures}, features.data(), "");
  group.dataset("counts", {Number::f64, rows, 0}, counts.data(), "");
  group.dataset("of_a_hit", {Number::f64, rows, 0}, parts.of_a_hit.data(), "");
  group.dataset("starts", {Number::i64, rows + 1, 0}, starts.data(), "");
}

std::vector<std::int64_t> startsOf(const CutParts& parts) {
  std::vector<std::int64_t> starts{0};
  for (const CutRows& block : parts.blocks) {
    const std::int64_t before = starts.back();
    for (const std::uint32_t end : block.ends) starts.push_back(before + std::int64_t(end));
  }
  return starts;
}

/// A number from 0 to `most` for each row.
std::vector<double> readShares(const h5::InputGroup& group, const char* name, std::size_t rows,
                               double most) {
  std::size_t count = 0;
  const h5::Handle set = group.open(name, Number::f64, 0, count);
  if (count != rows) {
    group.fail(name, fmt::format("has {} values, order has {}", count, rows));
  }
  std::vector<double> shares(rows);
  if (rows > 0) group.readAll(name, set, Number::f64, shares.data());
  for (std::size_t k = 0; k < rows; ++k) {
    if (!(shares[k] >= 0 && shares[k] <= most)) group.failAt(name, k, shares[k]);
  }
  return shares;
}

std::vector<PatchTree::Patch> readPatches(const h5::InputGroup& group,
                                          const std::vector<double>& area) {
  std::size_t rows = 0;
  const h5::Handle order_set = group.open("order", h5::numberOf<Index>(), 0, rows);
  std::vector<Index> order(rows);
  if (rows > 0) group.readAll("order", order_set, h5::numberOf<Index>(), order.data());
  std::size_t feature_rows = 0;
  const h5::Handle feature_set = group.open("features", Number::f32, kPatchFeatures, feature_rows);
  if (feature_rows != rows) {
    group.fail("features", fmt::format("has {} rows, order has {}", feature_rows, rows));
  }
  const std::vector<double> counts = readShares(group, "counts", rows, kMostCounts);
  std::vector<PatchTree::Patch> patches(rows);
  std::vector<float> features(rows * kPatchFeatures);
  if (rows > 0) group.readAll("features", feature_set, Number::f32, features.data());
  std::vector<bool> named(area.size(), false);
  for (std::size_t k = 0; k < rows; ++k) {
    if (order[k] >= area.size() || named[order[k]] || !(area[order[k]] > 0)) {
      group.fail("order", fmt::format("names the row {}, which is none or there twice", order[k]));
    }
    named[order[k]] = true;
    patches[k].patch = order[k];
    patches[k].area = area[order[k]];
    patches[k].counts = counts[k];
    std::copy_n(features.begin() + std::ptrdiff_t(k * kPatchFeatures), kPatchFeatures,
                patches[k].at.begin());
    for (const float f : patches[k].at) {
      if (!std::isfinite(f)) group.failAt("features", k, f);
    }
  }
  return patches;
}

std::vector<std::int64_t> readStarts(const h5::InputGroup& group, std::size_t rows,
                                     std::size_t entries) {
  std::size_t count = 0;
  const h5::Handle set = group.open("starts", Number::i64, 0, count);
  if (count != rows + 1) {
    group.fail("starts", fmt::format("has {} values, not {}", count, rows + 1));
  }
  std::vector<std::int64_t> starts(count);
  group.readAll("starts", set, Number::i64, starts.data());
  constexpr std::int64_t kMostEntries = std::int64_t(1) << 25;  // of a row
  bool good = starts.front() == 0 && starts.back() == std::int64_t(entries);
  for (std::size_t k = 0; k < rows && good; ++k) {
    good = starts[k + 1] >= starts[k] && starts[k + 1] - starts[k] < kMostEntries;
  }
  if (!good) group.fail("starts", "does not divide the entries into rows");
  return starts;
}

/// The three arrays of entries, open.
class EntryReader {
 public:
  EntryReader(const h5::InputGroup& group, std::size_t nodes) : group_(group), nodes_(nodes) {
    std::size_t hits = 0;
    std::size_t places = 0;
    nodes_set_ = group.open("nodes", h5::numberOf<Index>(), 0, entries_);
    hits_set_ = group.open("hits", Number::u32, 0, hits);
    places_set_ = group.open("places", Number::u8, 0, places);
    if (hits != entries_) {
      group.fail("hits", fmt::format("has {} values, nodes has {}", hits, entries_));
    }
    if (places != entries_ * kPatchFeatures) {
      group.fail("places", fmt::format("has {} values, not {}", places, entries_ * kPatchFeatures));
    }
  }

  std::size_t entries() const { return entries_; }

  void read(std::size_t first, std::size_t count, CutRows& rows) {
    rows.nodes.resize(count);
    rows.hits.resize(count);
    rows.places.resize(count);
    if (count == 0) return;
    hits_.resize(count);
    group_.readRows("nodes", nodes_set_, h5::numberOf<Index>(), first, count, rows.nodes.data());
    group_.readRows("hits", hits_set_, Number::u32, first, count, hits_.data());
    group_.readRows("places", places_set_, Number::u8, first * kPatchFeatures,
                    count * kPatchFeatures, rows.places.data());
    for (std::size_t e = 0; e < count; ++e) {
      if (rows.nodes[e] >= nodes_) group_.failAt("nodes", first + e, rows.nodes[e]);
      rows.hits[e] = {std::uint16_t(hits_[e] & kFirstHits), std::uint16_t(hits_[e] >> kSecondHits)};
    }
  }

 private:
  const h5::InputGroup& group_;
  std::size_t nodes_;
  std::size_t entries_ = 0;
  h5::Handle nodes_set_;
  h5::Handle hits_set_;
  h5::Handle places_set_;
  std::vector<std::uint32_t> hits_;
};

}  // namespace

void writeCut(h5::OutputGroup& group, const CutOperator& factors, Progress& progress) {
  const CutParts& parts = factors.parts();
  std::vector<Index> order;
  std::vector<float> features;
  std::vector<double> counts;
  for (const PatchTree::Patch& patch : parts.tree.patches()) {
    order.push_back(patch.patch);
    counts.push_back(patch.counts);
    features.insert(features.end(), patch.at.begin(), patch.at.end());
  }
  putArrays(group, parts, order, features, counts, startsOf(parts));
  const std::size_t entries = factors.entries();
  progress.begin("writing form factors", parts.blocks.size());
  ColumnWriter<Index> nodes(group, "nodes", entries);
  ColumnWriter<std::uint32_t> hits(group, "hits", entries);
  ColumnWriter<std::uint8_t> places(group, "places", entries * kPatchFeatures);
  for (const CutRows& block : parts.blocks) {
    const std::size_t count = block.nodes.size();
    std::ranges::copy(block.nodes, nodes.extend(count).begin());
    std::ranges::transform(block.hits, hits.extend(count).begin(), [](const CutRows::Hits& of) {
      return std::uint32_t(of[0]) | std::uint32_t(of[1]) << kSecondHits;
    });
    const std::span<std::uint8_t> bytes = places.extend(count * kPatchFeatures);
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      bytes[k] = std::uint8_t(block.places[k / kPatchFeatures][k % kPatchFeatures]);
    }
    progress.advance();
    progress.check();
  }
  nodes.flush();
  hits.flush();
  places.flush();
  progress.end();
}

void countCut(h5::SizeCounter& group, const CutOperator& factors) {
  putArrays(group, factors.parts(), {}, {}, {}, {});
  const std::size_t entries = factors.entries();
  group.dataset("nodes", {h5::numberOf<Index>(), entries, 0}, nullptr, "");
  group.dataset("hits", {Number::u32, entries, 0}, nullptr, "");
  group.dataset("places", {Number::u8, entries * kPatchFeatures, 0}, nullptr, "");
}

CutParts readCut(const h5::InputGroup& group, std::vector<double> area) {
  CutParts parts;
  group.attribute("bias", Number::f64, 1, &parts.bias);
  if (!(parts.bias >= 0) || !std::isfinite(parts.bias)) group.fail("bias", "is not 0 or more");
  parts.tree = PatchTree::ofSorted(readPatches(group, area));
  parts.area = std::move(area);
  const std::size_t rows = parts.tree.patches().size();
  parts.of_a_hit = readShares(group, "of_a_hit", rows, 1);
  EntryReader entries(group, parts.tree.nodes().size());
  const std::vector<std::int64_t> starts = readStarts(group, rows, entries.entries());
  parts.blocks.resize(CutParts::blocksOf(rows));
  for (std::size_t b = 0; b < parts.blocks.size(); ++b) {
    const std::size_t first = b * CutParts::kBlock;
    const std::size_t last = std::min(rows, first + CutParts::kBlock);
    for (std::size_t k = first; k < last; ++k) {
      parts.blocks[b].ends.push_back(std::uint32_t(starts[k + 1] - starts[first]));
    }
    entries.read(std::size_t(starts[first]), std::size_t(starts[last] - starts[first]),
                 parts.blocks[b]);
  }
  return parts;
}

}  // namespace radiosity
