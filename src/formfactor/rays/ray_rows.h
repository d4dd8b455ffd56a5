// The counts of rays, a row a patch, and the accuracy of the matrix made from them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory_resource>
#include <span>
#include <vector>

#include "formfactor/known_entries.h"
#include "formfactor/rays/row_accuracy.h"
#include "radiosity/base.h"
#include "radiosity/scratch_memory.h"

namespace radiosity {

/// Each row is counted twice, by points scrambled independently: the difference of the two says how
/// far off their mean is.
inline constexpr int kReplicates = 2;

/// RayRow::window of a row that is proved to see nothing: none of its rays needs to be traced.
inline constexpr double kSeesNothing = 0x1p-100;

/// Counts of where the rays of one patch ended. Columns are positions in the order of the matrix,
/// then N + s for the black back of surface s; strictly increasing.
struct RayRow {
  std::uint32_t rays = 0;  ///< cast in each replicate
  std::array<std::uint32_t, kReplicates> sky{};
  /// The share of the hemisphere that rays go into; the rest is proved to be sky. Each ray stands
  /// for 1 / window of those that would go everywhere.
  double window = 1;
  std::pmr::vector<Index> columns;
  std::pmr::vector<std::array<std::uint32_t, kReplicates>> hits;

  RayRow() = default;
  /// Its entries stay in `memory`, also after an assignment.
  explicit RayRow(std::pmr::memory_resource* memory) : columns(memory), hits(memory) {}

  /// Adds the counts of rays `rays` to more.rays - 1 of each replicate.
  void add(const RayRow& more);

  /// Bytes of the entries.
  std::size_t bytes() const {
    return columns.size() * sizeof(Index) + hits.size() * sizeof(hits[0]);
  }
  /// The rays of one replicate, and those beside the window that they stand for.
  double countedEach() const { return double(rays) / window; }
  /// The same in both.
  double counted() const { return kReplicates * countedEach(); }
  /// Those of them that see the sky.
  double countedSky() const { return counted() * (1 - window) + double(sky[0]) + double(sky[1]); }
  /// The share of them that the sky has.
  double skyShare() const { return counted() > 0 ? countedSky() / counted() : 0.0; }
};

/// Both estimates of a row's pairs merged, for each replicate: G_ij = (c_ij + c_ji) / (n_i / A_i +
/// n_j / A_j), counts over rays a square metre. That is their mean weighted by the inverse of the
/// variances that independent rays would have, A_i G_ij / n_i.
struct MergedRow {
  std::size_t position = 0;
  std::size_t patches = 0;         ///< N
  std::span<const Index> columns;  ///< positions that one end or the other has hit, increasing
  /// F from this row's patch to the columns, by the first and the second replicate; the same
  /// value twice if it is known.
  std::span<const std::array<double, kReplicates>> factors;
  /// Variances foreseen of the factors' means, but for a factor that all rows share
  /// (foreseenVariance()); 0 for known ones.
  std::span<const double> variances;
  std::span<const KnownEntries::Entry> known;  ///< the known ones among the columns
  double counted = 0;                          ///< the sum of the factors that are not known
  bool all_known = false;                      ///< the row rests on no rays
};

/// Calls visit(row) for the rows with `wanted` (by position; empty: all), several at once from
/// different threads. `area`: K, by position. `scratch`: holds the rows' entries; null: in memory.
/// Known entries replace counted ones. O(K + entries), in panels of memory.
void forMergedRows(std::span<const RayRow> rows, std::span<const double> area,
                   const KnownEntries& known, std::span<const std::uint8_t> wanted,
                   ScratchMemory* scratch, const std::function<void(const MergedRow&)>& visit);

/// Bytes that forMergedRows() takes for `rows` rows with `entries` of their own, all together.
std::size_t mergingBytes(std::size_t rows, double entries);

/// The norm of a usual row: the root mean square of those added, weighted by area.
class UsualNorm {
 public:
  void add(double norm, double area) {
    squares_ += area * norm * norm;
    areas_ += area;
  }
  double value() const { return areas_ > 0 ? std::sqrt(squares_ / areas_) : 0.0; }

 private:
  double squares_ = 0;
  double areas_ = 0;
};

/// `own`: the row itself, for its black backs, which no other row estimates; `area`: the row's,
/// m^2.
RowAccuracy accuracyOf(const MergedRow& merged, const RayRow& own, double area);

/// The same for a row by itself, before it is merged with the others' counts.
RowAccuracy accuracyAlone(const RayRow& row, std::size_t patches);

}  // namespace radiosity
