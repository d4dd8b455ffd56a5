// What rays will take: some rows are cast, and their errors followed.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/rays/ray_factors.h"
#include "formfactor/rays/ray_rounds.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

constexpr std::size_t kMostRows = 160;
/// Rays of a sampled row, in each replicate: from the first number to the second its error is seen
/// to fall.
constexpr std::uint32_t kFewRays = kPilotRays;
constexpr std::uint32_t kManyRays = 8 * kPilotRays;
/// Merging with what the others count takes about half off the square of an error.
constexpr double kMerged = 0.5;
/// Rays are cast to the next number that suits the net, and some rows twice.
constexpr double kRounding = 1.25;
/// Seconds an entry of the rows takes in counting, merging and closing, beside the rays.
constexpr double kEntrySeconds = 12e-9;

struct SampledRow {
  RowAccuracy few;
  RowAccuracy many;
  double entries = 0;
  double area = 0;
  BothClocks taken;  ///< by the rays from kFewRays on
};

SampledRow sampleRow(const RayScene& scene, std::size_t position, const Progress& progress) {
  SampledRow sampled;
  sampled.area = scene.area()[position];
  RayRow row;
  scene.cast(position, kFewRays, row, progress);
  if (row.columns.empty() || progress.cancelled()) return sampled;
  sampled.few = accuracyAlone(row);
  const BothWatches watches;
  scene.cast(position, kManyRays, row, progress);
  sampled.taken = watches.elapsed();
  sampled.many = accuracyAlone(row);
  sampled.entries = double(row.columns.size());
  return sampled;
}

/// How error squared falls, over all rows: of one alone it is too rough.
double orderOf(const std::vector<SampledRow>& rows) {
  double few = 0;
  double many = 0;
  for (const SampledRow& row : rows) {
    if (!(row.many.norm > 0)) continue;
    few += row.few.error * row.few.error / (row.many.norm * row.many.norm);
    many += row.many.error * row.many.error / (row.many.norm * row.many.norm);
  }
  if (!(few > many) || !(many > 0)) return kUsualOrder;
  return std::clamp(std::log(few / many) / std::log(double(kManyRays) / kFewRays), 1.0, 2.0);
}

}  // namespace

RayEstimate estimateRays(const RayScene& scene, const FormFactorOptions& options,
                         Progress& progress) {
  const std::size_t n = scene.size();
  std::vector<SampledRow> rows(std::min(n, kMostRows));
  progress.begin("planning", rows.size());
  parallelFor(rows.size(), 1, [&](std::size_t k) {
    rows[k] = sampleRow(scene, (2 * k + 1) * n / (2 * rows.size()), progress);
    progress.advance();
  });
  progress.check();
  progress.end();
  const double order = orderOf(rows);
  const double tolerance = options.toleranceOf(FormFactorMethod::rays);
  BothClocks taken;
  UsualNorm usual;
  for (const SampledRow& row : rows) usual.add(row.many.norm, row.area);
  double rays = 0;
  double entries = 0;
  for (const SampledRow& row : rows) {
    taken += row.taken;
    const double norm = std::max(row.many.norm, usual.value());
    if (!(norm > 0)) continue;
    const double over = row.many.error / (norm * tolerance);
    // Beyond kMostRays rows are given up, and the tolerance is not kept: then this is too long.
    const double needed =
        std::max(double(kPilotRays), kManyRays * std::pow(kMerged * over * over, 1 / order));
    rays += needed;
    // Entries that more rays find: few of those that are not there yet.
    constexpr double kNewEntries = 0.3;
    entries +=
        std::min(double(n), row.entries * std::pow(std::max(1.0, needed / kManyRays), kNewEntries));
  }
  const double share = rows.empty() ? 0.0 : 1 / double(rows.size());
  const double sampled = double(kManyRays - kFewRays) * double(rows.size());
  const double per_ray = sampled > 0 ? taken.processor / sampled : 0.0;
  const auto threads = double(allowedThreads());
  RayEstimate estimate;
  estimate.rays = kReplicates * kRounding * share * rays * double(n);
  const double all_entries = share * entries * double(n);
  estimate.seconds =
      taken.ratio() / threads * (0.5 * estimate.rays * per_ray + kEntrySeconds * all_entries);
  estimate.matrix_bytes = estimateSymmetricBytes(n, share * entries, options.storedPrecision());
  constexpr std::size_t kCountBytes = sizeof(Index) + kReplicates * sizeof(std::uint32_t) + 1;
  estimate.bytes = options.memory_held + scene.caster().bytes() + estimate.matrix_bytes +
                   std::size_t(all_entries * kCountBytes);
  return estimate;
}

}  // namespace radiosity
