#include "formfactor/rays/ray_rows.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/scratch_rows.h"

namespace radiosity {

namespace {

/// Bytes of the entries handed on to the rows that are merged at once.
constexpr std::size_t kPanelBytes = std::size_t(1) << 25;

using Hits = std::array<std::uint32_t, kReplicates>;

/// Bytes of an entry that another row hands on.
constexpr std::size_t kHandedBytes = sizeof(Index) + sizeof(Hits);
/// Blocks of rows that are looked through side by side.
constexpr std::size_t kBlocks = 32;

/// Counts of some rows by all other rows: their columns, transposed.
class Transposed {
 public:
  explicit Transposed(std::span<const RayRow> rows, ScratchMemory* scratch)
      : rows_(rows), scratch_(scratch), read_(rows.size(), 0), handed_(rows.size(), 0) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      touchRows(scratch_, rows[j].columns.size() * sizeof(Index));
      for (const Index column : rows[j].columns) {
        if (column < rows.size() && column != j) ++handed_[column];
      }
    }
    // Room for the largest panel at once: growing would hold two panels.
    std::size_t most = 0;
    for (std::size_t first = 0; first < rows.size();) {
      const std::size_t last = panelEnd(first);
      most = std::max(most, std::reduce(handed_.begin() + std::ptrdiff_t(first),
                                        handed_.begin() + std::ptrdiff_t(last)));
      first = last;
    }
    columns_.reserve(most);
    hits_.reserve(most);
  }

  /// The end of the next panel of rows: as many as fit, one at least.
  std::size_t panelEnd(std::size_t first) const {
    std::size_t bytes = 0;
    std::size_t last = first;
    while (last < rows_.size()) {
      bytes += handed_[last] * kHandedBytes;
      if (last > first && bytes > kPanelBytes) break;
      ++last;
    }
    return last;
  }

  /// Panels come in order, from row 0 on.
  void fill(std::size_t first, std::size_t last) {
    first_ = first;
    starts_.assign(1, 0);
    for (std::size_t k = first; k < last; ++k) starts_.push_back(starts_.back() + handed_[k]);
    columns_.resize(starts_.back());
    hits_.resize(starts_.back());
    // The place for the entries that each block of rows hands on: in the order of the rows, sorted.
    const std::size_t n = rows_.size();
    const std::size_t blocks = std::min(n, kBlocks);
    const std::size_t width = last - first;
    std::vector<std::size_t> next(blocks * width, 0);
    const auto forBlocks = [&](const auto& visit) {
      parallelFor(blocks, 1, [&](std::size_t b) {
        for (std::size_t j = b * n / blocks; j < (b + 1) * n / blocks; ++j) visit(b, j);
      });
    };
    forBlocks([&](std::size_t b, std::size_t j) {
      forHanded(j, last, [&](std::size_t k, const Hits&) { ++next[b * width + k - first]; });
    });
    for (std::size_t m = 0; m < width; ++m) {
      std::size_t at = starts_[m];
      for (std::size_t b = 0; b < blocks; ++b) at += std::exchange(next[b * width + m], at);
    }
    forBlocks([&](std::size_t b, std::size_t j) {
      read_[j] = forHanded(j, last, [&](std::size_t k, const Hits& hits) {
        const std::size_t at = next[b * width + k - first]++;
        columns_[at] = Index(j);
        hits_[at] = hits;
      });
    });
  }

  std::span<const Index> columns(std::size_t k) const { return part(columns_, k); }
  std::span<const Hits> hits(std::size_t k) const { return part(hits_, k); }

 private:
  /// Calls visit(k, hits) for the entries of row j, not yet read, in rows before `last`. Returns
  /// where it ended.
  template <class Visit>
  std::size_t forHanded(std::size_t j, std::size_t last, const Visit& visit) const {
    const RayRow& row = rows_[j];
    std::size_t e = read_[j];
    for (; e < row.columns.size() && row.columns[e] < last; ++e) {
      if (row.columns[e] != j) visit(row.columns[e], row.hits[e]);  // itself: both ends are one
    }
    touchRows(scratch_, (e - read_[j]) * kHandedBytes);
    return e;
  }
  template <class Value>
  std::span<const Value> part(const std::vector<Value>& values, std::size_t k) const {
    const std::size_t from = starts_[k - first_];
    return std::span(values).subspan(from, starts_[k - first_ + 1] - from);
  }

  std::span<const RayRow> rows_;
  ScratchMemory* scratch_;
  std::vector<std::size_t> read_;    ///< of each row, entries before the panel
  std::vector<std::size_t> handed_;  ///< to each row, entries
  // Of the panel:
  std::size_t first_ = 0;
  std::vector<std::size_t> starts_;
  std::vector<Index> columns_;
  std::vector<Hits> hits_;
};

/// Calls visit(column, hits of its own, hits handed on) for every column below `n` that has any.
template <class Visit>
void forBothEnds(const RayRow& own, std::span<const Index> columns, std::span<const Hits> handed,
                 std::size_t n, const Visit& visit) {
  constexpr Hits kNoHits{};
  std::size_t e = 0;
  std::size_t h = 0;
  for (;;) {
    const Index here = e < own.columns.size() && own.columns[e] < n ? own.columns[e] : kNone;
    const Index there = h < columns.size() ? columns[h] : kNone;
    const Index column = std::min(here, there);
    if (column == kNone) return;
    visit(column, here == column ? own.hits[e++] : kNoHits,
          there == column ? handed[h++] : kNoHits);
  }
}

/// The storage of a MergedRow.
struct Merging {
  std::vector<Index> columns;
  std::vector<std::array<double, kReplicates>> factors;
  std::vector<double> variances;
};

}  // namespace

std::size_t mergingBytes(std::size_t rows, double entries) {
  constexpr std::size_t kRowBytes = (kReplicates + 4 + kBlocks) * sizeof(double);
  return rows * kRowBytes +
         std::size_t(std::min(double(kPanelBytes), entries * double(kHandedBytes)));
}

void RayRow::add(const RayRow& more) {
  std::vector<Index> all;
  std::set_union(columns.begin(), columns.end(), more.columns.begin(), more.columns.end(),
                 std::back_inserter(all));
  std::vector<Hits> sums(all.size());
  const auto addHits = [&](const RayRow& row) {
    std::size_t at = 0;
    for (std::size_t e = 0; e < row.columns.size(); ++e) {
      while (all[at] < row.columns[e]) ++at;
      for (std::size_t r = 0; r < kReplicates; ++r) sums[at][r] += row.hits[e][r];
    }
  };
  addHits(*this);
  addHits(more);
  columns.assign(all.begin(), all.end());
  hits.assign(sums.begin(), sums.end());
  for (std::size_t r = 0; r < kReplicates; ++r) {
    sky[r] += more.sky[r];
  }
  rays = more.rays;
  window = more.window;
}

void forMergedRows(std::span<const RayRow> rows, std::span<const double> area,
                   const KnownEntries& known, std::span<const std::uint8_t> wanted,
                   ScratchMemory* scratch, const std::function<void(const MergedRow&)>& visit) {
  const std::size_t n = rows.size();
  std::vector<double> density(n);  // rays a square metre, in each replicate
  for (std::size_t k = 0; k < n; ++k) {
    density[k] = area[k] > 0 ? rows[k].countedEach() / area[k] : 0.0;
  }
  tbb::enumerable_thread_specific<Merging> mergings;
  Transposed handed(rows, scratch);
  for (std::size_t first = 0; first < n;) {
    const std::size_t last = handed.panelEnd(first);
    handed.fill(first, last);
    parallelFor(last - first, 1, [&](std::size_t m) {
      const std::size_t k = first + m;
      if (!wanted.empty() && wanted[k] == 0) return;
      Merging& merging = mergings.local();
      merging.columns.clear();
      merging.factors.clear();
      merging.variances.clear();
      const std::span<const KnownEntries::Entry> entries = known.at(k);
      const bool all_known = known.rowAt(k) != nullptr;
      std::size_t next = 0;  // into entries
      double counted = 0;
      const auto addKnownBefore = [&](std::size_t end) {
        for (; next < entries.size() && entries[next].position < end; ++next) {
          const double factor = entries[next].exchange / area[k];
          merging.columns.push_back(entries[next].position);
          merging.factors.push_back({factor, factor});
          merging.variances.push_back(0);
        }
      };
      const auto merge = [&](Index j, const Hits& own, const Hits& of_j) {
        if (all_known || known.rowAt(j) != nullptr) return;
        addKnownBefore(j);
        merging.columns.push_back(j);
        std::array<double, kReplicates>& factor = merging.factors.emplace_back();
        std::array<double, 2> hits_of{};  // its own; those of j
        const double rays = (density[k] + (j == k ? 0.0 : density[j])) * area[k];
        for (std::size_t r = 0; r < kReplicates; ++r) {
          const double hits = double(own[r]) + double(of_j[r]);
          if (hits == 0) continue;
          factor[r] = hits / rays;
          hits_of[0] += double(own[r]);
          hits_of[1] += double(of_j[r]);
        }
        const double mean = 0.5 * (factor[0] + factor[1]);
        counted += mean;
        // A row that sees little but j knows this well by its own rays; j's may be few.
        const double of_hits = pairHitsVariance(mean, hits_of, {area[k], area[j]});
        merging.variances.push_back(foreseenVariance(mean, hits_of[0] + hits_of[1], of_hits));
      };
      touchRows(scratch, rows[k].bytes());
      forBothEnds(rows[k], handed.columns(k), handed.hits(k), n, merge);
      addKnownBefore(n);
      visit(
          {k, n, merging.columns, merging.factors, merging.variances, entries, counted, all_known});
    });
    first = last;
  }
}

namespace {

/// Adds an entry that a row alone has counted.
void addAlone(const RayRow& row, std::size_t e, ReplicateSums& sums) {
  const double first = row.hits[e][0] / row.countedEach();
  const double second = row.hits[e][1] / row.countedEach();
  const double hits = double(row.hits[e][0]) + double(row.hits[e][1]);
  const double mean = 0.5 * (first + second);
  sums.add(first, second, foreseenVariance(mean, hits, hitsVariance(mean, hits)));
}

/// Adds the black backs that a row sees, whose columns come from `patches` on.
void addBacks(const RayRow& row, std::size_t patches, RowAccuracy& accuracy) {
  ReplicateSums backs;
  for (std::size_t e = row.columns.size(); e-- > 0 && row.columns[e] >= patches;) {
    addAlone(row, e, backs);
  }
  const RowAccuracy of_backs = backs.accuracy();
  accuracy.backs_norm = of_backs.norm;
  accuracy.backs_error = of_backs.error;
}

}  // namespace

RowAccuracy accuracyOf(const MergedRow& merged, const RayRow& own, double area) {
  ReplicateSums sums;
  for (std::size_t e = 0; e < merged.factors.size(); ++e) {
    sums.add(merged.factors[e][0], merged.factors[e][1], merged.variances[e]);
  }
  RowAccuracy accuracy = sums.accuracy();
  if (!merged.all_known) {
    addBacks(own, merged.patches, accuracy);
    accuracy.rays = own.counted();
    // Not those of other rows: however often one hits it, it says nothing of the rest.
    accuracy.hits = accuracy.rays * merged.counted;
  }
  double squares = 0;
  double fourths = 0;
  for (const KnownEntries::Entry& entry : merged.known) {
    const double square = (entry.error / area) * (entry.error / area);
    squares += square;
    fourths += square * square;
  }
  accuracy.known_error = std::sqrt(squares + std::sqrt(fourths));  // as ErrorSums
  return accuracy;
}

RowAccuracy accuracyAlone(const RayRow& row, std::size_t patches) {
  ReplicateSums sums;
  double hits = 0;
  for (std::size_t e = 0; e < row.columns.size() && row.columns[e] < patches; ++e) {
    addAlone(row, e, sums);
    hits += double(row.hits[e][0]) + double(row.hits[e][1]);
  }
  RowAccuracy accuracy = sums.accuracy();
  addBacks(row, patches, accuracy);
  accuracy.rays = row.counted();
  accuracy.hits = hits;
  return accuracy;
}

}  // namespace radiosity
