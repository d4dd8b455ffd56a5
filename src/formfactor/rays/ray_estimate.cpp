// The cost of rays, foreseen: some rows are cast, and their errors followed.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/rays/ray_factors.h"
#include "formfactor/rays/ray_model.h"
#include "formfactor/rays/ray_rounds.h"
#include "matrix/expected_bytes.h"
#include "matrix/working_memory.h"

namespace radiosity {
namespace {

constexpr std::size_t kMostRows = 160;
/// Rays of a sampled row, in each replicate. The fall of its error from the first number to the
/// second is measured.
constexpr std::uint32_t kFewRays = kPilotRays;
constexpr std::uint32_t kManyRays = 8 * kPilotRays;

struct SampledRow {
  RowAccuracy few;
  RowAccuracy many;
  double sky = 0;  ///< its share of the rays
  double few_entries = 0;
  double entries = 0;
  double visible = 0;  ///< entries that any number of rays would find, about
  double area = 0;
  BothClocks taken;  ///< by the rays from kFewRays on
};

/// The entries, with those not seen estimated from those seen once and twice (Chao, "Nonparametric
/// estimation of the number of classes in a population", Scand. J. Statist. 11, 1984).
double visibleEntries(const RayRow& row) {
  double once = 0;
  double twice = 0;
  for (const auto& [first, second] : row.hits) {
    once += first + second == 1 ? 1 : 0;
    twice += first + second == 2 ? 1 : 0;
  }
  return double(row.columns.size()) + once * (once - 1) / (2 * (twice + 1));
}

SampledRow sampleRow(const RayScene& scene, std::size_t position, const Progress& progress) {
  SampledRow sampled;
  sampled.area = scene.area()[position];
  RayRow row;
  scene.cast(position, kFewRays, row, progress);
  if (row.columns.empty() || progress.cancelled()) return sampled;
  sampled.few = accuracyAlone(row, scene.size());
  sampled.few_entries = double(row.columns.size());
  const BothWatches watches;
  scene.cast(position, kManyRays, row, progress);
  sampled.taken = watches.elapsed();
  sampled.many = accuracyAlone(row, scene.size());
  sampled.sky = row.skyShare();
  sampled.entries = double(row.columns.size());
  sampled.visible = visibleEntries(row);
  return sampled;
}

/// Moderates errors by those of all sampled rows, as rounds will (CommonError).
void moderate(std::vector<SampledRow>& rows) {
  CommonError few;
  CommonError many;
  for (const SampledRow& row : rows) {
    few.add(row.few);
    many.add(row.many);
  }
  for (SampledRow& row : rows) {
    row.few = few.moderated(row.few);
    row.many = many.moderated(row.many);
  }
}

/// The order at which error squared falls, over all rows: that of a single row is too rough.
double orderOf(const std::vector<SampledRow>& rows) {
  double few = 0;
  double many = 0;
  for (const SampledRow& row : rows) {
    if (!(row.many.norm > 0)) continue;
    few += row.few.error * row.few.error / (row.many.norm * row.many.norm);
    many += row.many.error * row.many.error / (row.many.norm * row.many.norm);
  }
  if (!(few > many) || !(many > 0)) return kUsualOrder;
  return std::clamp(std::log(few / many) / std::log(double(kManyRays) / kFewRays),
                    kLeastForeseenOrder, kMostForeseenOrder);
}

/// Entries of a row by `rays` rays a replicate. They grow as from few to many rays, beyond that at
/// most as by kNewEntries, and at most to all visible ones.
double entriesBy(const SampledRow& row, double rays) {
  if (!(row.few_entries > 0)) return 0;
  double power = std::log(row.entries / row.few_entries) / std::log(double(kManyRays) / kFewRays);
  if (rays > kManyRays) power = std::min(power, kNewEntries);
  return std::min(row.visible, row.entries * std::pow(rays / kManyRays, power));
}

/// The cost of all rows, foreseen from the sampled ones.
class Forecast {
 public:
  Forecast(const std::vector<SampledRow>& rows, std::size_t all, const RayAim& aim)
      : rows_(rows), order_(orderOf(rows)), tolerance_(aim.tolerance), sky_weight_(aim.sky_weight) {
    for (const SampledRow& row : rows) {
      usual_.add(normOf(row), row.area);
      taken_ += row.taken;
    }
    times_ = rows.empty() ? 0.0 : double(all) / double(rows.size());
    loosened_ = loosening(aim.most_rays, [&](double times) { return rays(times); });
  }

  /// The factor by which the tolerance is loosened to keep within the rays allowed.
  double loosened() const { return loosened_; }
  /// Rays of all rows, for a tolerance loosened by this factor.
  double rays(double loosened) const {
    double sum = 0;
    for (const SampledRow& row : rows_) sum += raysOf(row, loosened);
    return kReplicates * kRaysRoundedUp * times_ * sum;
  }
  /// Entries of all rows together, once they have the rays they get.
  double entries(std::size_t columns) const {
    double sum = 0;
    for (const SampledRow& row : rows_) {
      sum += std::min(double(columns), entriesBy(row, kRaysRoundedUp * raysOf(row, loosened_)));
    }
    return times_ * sum;
  }
  /// Seconds by the clock, on all threads, each row at its own rate: rows that want many rays look
  /// into corners, where rays take longer than under the sky.
  double seconds(double loosened, double entries) const {
    double casting = 0;
    for (const SampledRow& row : rows_) {
      casting += raysOf(row, loosened) * row.taken.processor / (kManyRays - kFewRays);
    }
    return taken_.ratio() / double(allowedThreads()) *
           (kRaysRoundedUp * times_ * casting + kEntrySeconds * entries);
  }

 private:
  double normOf(const SampledRow& row) const {
    return std::hypot(row.many.norm, sky_weight_ * row.sky);
  }
  /// Rays of a row in each replicate.
  double raysOf(const SampledRow& row, double loosened) const {
    const double norm = std::max(normOf(row), usual_.value());
    if (!(norm > 0)) return 0;
    const double over = row.many.error / (norm * tolerance_ * loosened);
    // Beyond kMostRays rows are given up and miss the tolerance: then this is too long.
    return std::max(double(kPilotRays), kManyRays * std::pow(kMerged * over * over, 1 / order_));
  }

  const std::vector<SampledRow>& rows_;
  double order_;
  double tolerance_;
  double sky_weight_;
  UsualNorm usual_;
  BothClocks taken_;
  double times_ = 0;  ///< rows for each sampled one
  double loosened_ = 1;
};

/// Bytes of counts, matrix and errors: rows are merged first, then closed, then written.
void foreseeBytes(const RayScene& scene, double entries, const FormFactorOptions& options,
                  RayEstimate& estimate) {
  const std::size_t n = scene.size();
  constexpr std::size_t kCountBytes = sizeof(Index) + kReplicates * sizeof(std::uint32_t);
  constexpr std::size_t kAccounts = 16 * sizeof(double);     // a row: accounts, states, targets
  constexpr std::size_t kHeaders = 4 * sizeof(std::size_t);  // of two vectors' memory
  const auto counts = std::size_t(double(n) * entries * kCountBytes);
  // A pair is stored if either end has seen it: as many pairs as twice the rays would find.
  const double merged = std::min(double(n), entries * std::exp2(kNewEntries));
  estimate.matrix_bytes = expectedSymmetricBytes(n, merged, options.storedPrecision());
  const std::size_t errors = expectedUncertainBytes(n, merged);
  const std::size_t merging =
      n * (sizeof(RayRow) + kHeaders) + mergingBytes(n, double(n) * entries);
  const std::size_t working = matrixWorkingMemory(n, allowedThreads());
  const std::size_t panels = panelsOf(estimate.matrix_bytes, options.storedPrecision());
  const std::size_t always = options.memory_held + scene.caster().bytes() + n * kAccounts;
  const std::size_t whole = always + estimate.matrix_bytes +
                            std::max({merging + counts + errors, 2 * errors, working + panels});
  const std::size_t rows = estimate.matrix_bytes + std::max(counts + errors, 2 * errors);
  estimate.memory = planRowMemory(whole, always + std::max(merging, working), rows, options);
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
  moderate(rows);
  const RayAim aim(options);
  const Forecast forecast(rows, n, aim);
  const double entries = forecast.entries(n);
  RayEstimate estimate;
  estimate.rays = forecast.rays(forecast.loosened());
  estimate.tolerance = aim.tolerance * forecast.loosened();
  estimate.seconds = forecast.seconds(forecast.loosened(), entries);
  estimate.seconds_to_tolerance = forecast.seconds(1, entries);
  foreseeBytes(scene, n > 0 ? entries / double(n) : 0.0, options, estimate);
  return estimate;
}

}  // namespace radiosity
