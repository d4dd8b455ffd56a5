// The cost of rays, foreseen from the errors of some rows.
#include <algorithm>
#include <cmath>
#include <numeric>
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

/// Rows looked at with kFewRays: these tell the norm of a usual row, and which rows need many rays.
/// Of these, up to kMostRows are cast with kManyRays, which tell errors, entries and seconds.
constexpr std::size_t kMostFirstRows = 512;
constexpr std::size_t kMostRows = 96;
/// Rays in each replicate.
constexpr std::uint32_t kFewRays = kPilotRays;
constexpr std::uint32_t kManyRays = 8 * kPilotRays;

/// A row by kFewRays.
struct PilotRow {
  std::size_t position = 0;
  double stands_for = 0;  ///< rows, itself included
  RowAccuracy accuracy;
  double sky = 0;  ///< its share of the rays
};

struct SampledRow {
  std::size_t position = 0;
  double stands_for = 0;  ///< rows, itself included
  RowAccuracy accuracy;   ///< by kManyRays
  double sky = 0;         ///< its share of the rays
  double few_entries = 0;
  double entries = 0;
  double visible = 0;  ///< entries that any number of rays would find, about
  BothClocks taken;    ///< by the rays from kFewRays on
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

void castPilotRow(const RayScene& scene, PilotRow& pilot, const Progress& progress) {
  RayRow row;
  scene.cast(pilot.position, kFewRays, row, progress);
  if (progress.cancelled()) return;
  pilot.accuracy = accuracyAlone(row, scene.size());
  pilot.sky = row.skyShare();
}

void castMore(const RayScene& scene, SampledRow& sampled, const Progress& progress) {
  RayRow row;
  scene.cast(sampled.position, kFewRays, row, progress);
  if (progress.cancelled()) return;
  sampled.few_entries = double(row.columns.size());
  const BothWatches watches;
  scene.cast(sampled.position, kManyRays, row, progress);
  sampled.taken = watches.elapsed();
  sampled.accuracy = accuracyAlone(row, scene.size());
  sampled.sky = row.skyShare();
  sampled.entries = double(row.columns.size());
  sampled.visible = visibleEntries(row);
}

/// Moderates errors by those of all pilot rows or sampled rows, as rounds will (CommonError).
template <class Row>
void moderate(std::vector<Row>& rows) {
  CommonError common;
  for (const Row& row : rows) common.add(row.accuracy);
  for (Row& row : rows) row.accuracy = common.moderated(row.accuracy);
}

/// What rows have in common that says how many rays each needs.
struct Need {
  double sky_weight = 0;
  double usual = 0;                    ///< norm of a usual row
  double usual_whole = 0;              ///< the same with black backs
  double most_of_unknown = kMostRays;  ///< rays of a row that has seen next to nothing

  double normOf(const RowAccuracy& accuracy, double sky) const {
    return std::hypot(accuracy.norm, sky_weight * sky);
  }
  /// Rays of a row in each replicate for this tolerance, from its errors with `rays` of them: as
  /// Rounds::relativeError(). Other rows' counts do not help with backs.
  double rays(const RowAccuracy& accuracy, double sky, double rays, double tolerance) const {
    const double norm = normOf(accuracy, sky);
    const double whole = std::max(std::hypot(norm, accuracy.backs_norm), usual_whole);
    const double fronts = std::max(norm, usual);
    const double of_fronts = relativeTo(fronts > 0 ? fronts : whole, accuracy.expectedError());
    const double of_backs = relativeTo(whole, accuracy.backs_error);
    const double square = std::max(kMerged * of_fronts * of_fronts, of_backs * of_backs);
    // Beyond kMostRays rows are given up and miss the tolerance: then this is too long.
    const double wanted = rays * std::pow(square / (tolerance * tolerance), 1 / kUsualOrder);
    return std::max(double(kPilotRays),
                    accuracy.isUnknown() ? std::min(wanted, most_of_unknown) : wanted);
  }
};

void setUsualNorms(const RayScene& scene, const std::vector<PilotRow>& pilots, Need& need) {
  UsualNorm usual;
  UsualNorm whole;
  for (const PilotRow& pilot : pilots) {
    const double norm = need.normOf(pilot.accuracy, pilot.sky);
    const double area = pilot.stands_for * scene.area()[pilot.position];
    usual.add(norm, area);
    whole.add(std::hypot(norm, pilot.accuracy.backs_norm), area);
  }
  double unknown = 0;
  for (const PilotRow& pilot : pilots) unknown += pilot.accuracy.isUnknown() ? pilot.stands_for : 0;
  need.most_of_unknown = mostOfUnknown(unknown);
  need.usual = usual.value();
  need.usual_whole = whole.value();
}

/// One that was chosen among others.
struct Chosen {
  std::size_t which = 0;
  double stands_for = 0;  ///< of the others, itself included
};

/// Chooses up to `most`, with probabilities that are half even and half by weight, and with
/// certainty where all can be chosen. What one stands for is the inverse of its probability
/// (Horvitz & Thompson, "A generalization of sampling without replacement from a finite universe",
/// J. Am. Stat. Assoc. 47, 1952).
std::vector<Chosen> choose(const std::vector<double>& weights, std::size_t most) {
  most = std::min(most, weights.size());
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const bool is_even = most == weights.size() || !(sum > 0);
  std::vector<Chosen> chosen;
  double until = 0;  // sum of probabilities
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double even = double(most) / double(weights.size());
    const double chance = is_even ? even : 0.5 * (even + double(most) * weights[k] / sum);
    // Systematic: at the middle of each unit of the running sum.
    const double times = std::floor(until + chance + 0.5) - std::floor(until + 0.5);
    until += chance;
    if (times > 0) chosen.push_back({k, times / chance});
  }
  return chosen;
}

/// The pilot rows. Few large ones may decide the norm of a usual row.
std::vector<PilotRow> choosePilotRows(const RayScene& scene) {
  std::vector<PilotRow> pilots;
  for (const auto& [position, stands_for] : choose(scene.area(), kMostFirstRows)) {
    pilots.emplace_back();
    pilots.back().position = position;
    pilots.back().stands_for = stands_for;
  }
  return pilots;
}

/// Of the rows looked at, those to be cast with more rays. Few rows need most of the rays, and
/// would be missed or met twice by an even choice.
std::vector<SampledRow> chooseRows(const std::vector<PilotRow>& pilots, const Need& need,
                                   double tolerance) {
  std::vector<double> needed;
  needed.reserve(pilots.size());
  for (const PilotRow& pilot : pilots) {
    needed.push_back(pilot.stands_for * need.rays(pilot.accuracy, pilot.sky, kFewRays, tolerance));
  }
  std::vector<SampledRow> rows;
  for (const auto& [which, stands_for] : choose(needed, kMostRows)) {
    rows.emplace_back();
    rows.back().position = pilots[which].position;
    rows.back().stands_for = stands_for * pilots[which].stands_for;
  }
  return rows;
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
  Forecast(const std::vector<SampledRow>& rows, const Need& need, const RayAim& aim)
      : rows_(rows), need_(need), tolerance_(aim.tolerance) {
    for (const SampledRow& row : rows) taken_ += row.taken;
    loosened_ = loosening(aim.most_rays, [&](double times) { return rays(times); });
  }

  /// The factor by which the tolerance is loosened to keep within the rays allowed.
  double loosened() const { return loosened_; }
  /// Rays of all rows, for a tolerance loosened by this factor.
  double rays(double loosened) const {
    double sum = 0;
    for (const SampledRow& row : rows_) sum += row.stands_for * raysOf(row, loosened);
    return kReplicates * kRaysRoundedUp * sum;
  }
  /// Entries of all `n` rows together, once they have the rays they get.
  double entries(std::size_t n) const {
    double sum = 0;
    double stand_for = 0;  // n, about
    for (const SampledRow& row : rows_) {
      sum += row.stands_for *
             std::min(double(n), entriesBy(row, kRaysRoundedUp * raysOf(row, loosened_)));
      stand_for += row.stands_for;
    }
    return stand_for > 0 ? double(n) * sum / stand_for : 0.0;
  }
  /// Seconds by the clock, on all threads, each row at its own rate: rows that want many rays look
  /// into corners, where rays take longer than under the sky.
  double seconds(double loosened, double entries) const {
    double casting = 0;
    for (const SampledRow& row : rows_) {
      casting += row.stands_for * raysOf(row, loosened) * row.taken.processor;
    }
    return taken_.ratio() / double(allowedThreads()) *
           (kRaysRoundedUp * casting / (kManyRays - kFewRays) + kEntrySeconds * entries);
  }

 private:
  /// Rays of a row in each replicate.
  double raysOf(const SampledRow& row, double loosened) const {
    return need_.rays(row.accuracy, row.sky, kManyRays, tolerance_ * loosened);
  }

  const std::vector<SampledRow>& rows_;
  Need need_;
  double tolerance_;
  BothClocks taken_;
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
  const std::size_t always = options.memory_held + scene.bytes() + n * kAccounts;
  const std::size_t whole = always + estimate.matrix_bytes +
                            std::max({merging + counts + errors, 2 * errors, working + panels});
  const std::size_t rows = estimate.matrix_bytes + std::max(counts + errors, 2 * errors);
  estimate.memory = planRowMemory(whole, always + std::max(merging, working), rows, options);
}

}  // namespace

RayEstimate estimateRays(const RayScene& scene, const FormFactorOptions& options,
                         Progress& progress) {
  const std::size_t n = scene.size();
  const RayAim aim(options);
  std::vector<PilotRow> pilots = choosePilotRows(scene);
  progress.begin("planning", pilots.size() + std::min(pilots.size(), kMostRows));
  parallelFor(pilots.size(), 1, [&](std::size_t k) {
    castPilotRow(scene, pilots[k], progress);
    progress.advance();
  });
  progress.check();
  moderate(pilots);
  Need need{aim.sky_weight};
  setUsualNorms(scene, pilots, need);
  std::vector<SampledRow> rows = chooseRows(pilots, need, aim.tolerance);
  parallelFor(rows.size(), 1, [&](std::size_t k) {
    castMore(scene, rows[k], progress);
    progress.advance();
  });
  progress.check();
  progress.end();
  moderate(rows);
  const Forecast forecast(rows, need, aim);
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
