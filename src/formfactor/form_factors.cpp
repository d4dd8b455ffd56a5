#include "radiosity/form_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/figure_text.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "base/timed_progress.h"
#include "formfactor/cluster_factors.h"
#include "formfactor/exact/assembly/exact_factors.h"
#include "formfactor/exact/assembly/leading_rows.h"
#include "formfactor/exact/assembly/row_sample.h"
#include "formfactor/hemicube/hemicube_factors.h"
#include "formfactor/rays/ray_factors.h"
#include "formfactor/rays/ray_model.h"
#include "formfactor/row_accounts.h"
#include "formfactor/shared_factors.h"

namespace radiosity {

struct FormFactorPlan::Prepared {
  Prepared(std::shared_ptr<const PatchMesh> of, const FormFactorOptions& with)
      : kept(std::move(of)), mesh(*kept), options(with) {}
  std::shared_ptr<const PatchMesh> kept;
  const PatchMesh& mesh;  ///< in `kept`
  FormFactorOptions options;
  // For the exact method:
  std::optional<ExactScene> scene;
  std::optional<RowSample> sample;      ///< of the scene
  std::optional<ExactKernels> kernels;  ///< of the scene
  ExactEstimate estimate;
  // For the other methods:
  std::optional<HemicubeScene> hemicubes;
  HemicubeEstimate hemicube_estimate;
  std::optional<RayScene> rays;
  RayEstimate ray_estimate;
  std::optional<PatchMesh> patches;       ///< if hemicubes look from clusters' patches: these alone
  std::optional<LeadingRows> exact_rows;  ///< computed beside rays or hemicubes
  double seconds = 0;                     ///< of all this
  double seconds_exact = 0;               ///< of these, for the scene and kernels of exact
  double seconds_rays = 0;                ///< of these, for the scene of rays
  double seconds_exact_rows = 0;          ///< of these, for exact_rows
};

namespace {

/// Without a tolerance, exact, which then is far more accurate than rays, may take this many times
/// their seconds, or this many seconds.
constexpr double kWorthTimes = 2;
constexpr double kWorthSeconds = 5;

/// Chosen automatically, exact is given up, and rays take its place, where it takes this much
/// longer than was foreseen: a sample of rows may miss the few pairs whose shadows take nearly all
/// of the time (an engraved plate of 2,684 faces: .8 s foreseen, 50 s needed).
constexpr double kOverrunTimes = 3;
constexpr double kOverrunSeconds = 3;

std::string secondsText(double seconds) {
  if (seconds < 0.1) return "less than 0.1 s";
  if (seconds < 10) return fmt::format("about {:.2g} s", seconds);
  return fmt::format("about {} s", countText(std::size_t(std::llround(seconds))));
}

/// A look at exact samples its rows. It may take this share of the seconds that the work may take,
/// so that it stays small beside it, and as long as kFirstLookSeconds the first time, then
/// kLookSeconds. If exact is foreseen to take no more than kNoFurtherLookSeconds, rays are not
/// looked at.
constexpr double kLookShare = 0.02;
constexpr double kFirstLookSeconds = 0.15;
constexpr double kLookSeconds = 0.3;
constexpr double kNoFurtherLookSeconds = 0.5;
/// What could not be prepared in the first look would hardly be sampled in a second one shorter
/// than this.
constexpr double kLookUnpreparedSeconds = 1;
/// A look clips pairs for this long, in seconds of processors.
constexpr double kClipSeconds = 0.25;

/// The seconds that exact may take and still be chosen. With shared unknowns it must be the faster
/// one: an error of their light is larger than that of either method's form factors.
double secondsExactMayTake(const FormFactorPlan::Prepared& prepared, double ray_seconds) {
  if (prepared.options.tolerance || prepared.mesh.clusters) return ray_seconds;
  return std::max(kWorthTimes * ray_seconds, kWorthSeconds);
}

/// With clusters, adds the memory for summing rows over them, and adapts the matrix's size.
template <class Estimate>
void addClusters(const FormFactorPlan::Prepared& prepared, bool symmetric, Estimate& estimate) {
  const PatchMesh& mesh = prepared.mesh;
  if (!mesh.clusters) return;
  const Precision precision = prepared.options.storedPrecision();
  estimate.memory.bytes += clusterFactorsBytes(mesh, symmetric, precision, estimate.matrix_bytes);
  estimate.matrix_bytes =
      std::min(estimate.matrix_bytes, clusterMatrixBytes(mesh, symmetric, precision));
}

void takeMemory(const RowMemory& memory, FormFactorPlan& plan) {
  plan.bytes = memory.bytes;
  plan.scratch_bytes = memory.scratch_bytes;
}

/// Goes on from the scene and the sample where a plan that was given up has left them.
void planExact(FormFactorPlan::Prepared& prepared, FormFactorPlan& plan, Progress& progress) {
  const FormFactorOptions& options = prepared.options;
  if (!prepared.scene) {
    const Stopwatch watch;
    progress.begin("preparing", ExactScene::kSteps);
    prepared.scene.emplace(prepared.mesh, progress);
    progress.end();
    prepared.seconds_exact += watch.seconds();
  }
  const ExactScene& scene = *prepared.scene;
  RowSample& sample = prepared.sample ? *prepared.sample : prepared.sample.emplace();
  sampleRows(scene, options.toleranceOf(FormFactorMethod::exact), sample, progress);
  prepared.estimate = estimateExact(scene, sample, options);
  addClusters(prepared, true, prepared.estimate);
  if (!prepared.kernels) {
    const Stopwatch watch;
    prepared.kernels.emplace(scene, options);
    prepared.seconds_exact += watch.seconds();
  }
  plan.method = FormFactorMethod::exact;
  plan.tolerance = options.toleranceOf(FormFactorMethod::exact);
  takeMemory(prepared.estimate.memory, plan);
  plan.matrix_bytes = prepared.estimate.matrix_bytes;
  plan.seconds = exactSeconds(scene, *prepared.kernels, sample, options, kClipSeconds, progress);
  plan.refining =
      prepared.estimate.work > 0 ? prepared.estimate.refining / prepared.estimate.work : 0.0;
  prepared.sample.reset();
}

void planHemicubes(FormFactorPlan::Prepared& prepared, FormFactorPlan& plan, Progress& progress) {
  progress.begin("preparing", 1);
  const HemicubeScene& scene = prepared.hemicubes.emplace(prepared.mesh, prepared.options);
  progress.advance();
  progress.end();
  progress.check();
  prepared.hemicube_estimate = estimateHemicubes(prepared.mesh, scene, prepared.options, progress);
  addClusters(prepared, prepared.options.symmetrize, prepared.hemicube_estimate);
  takeMemory(prepared.hemicube_estimate.memory, plan);
  plan.matrix_bytes = prepared.hemicube_estimate.matrix_bytes;
  plan.seconds = prepared.hemicube_estimate.measured;
  plan.method = FormFactorMethod::hemicube;
}

/// Tolerances of exact rows beside rays or hemicubes: errors of a pair, relative to the mean form
/// factor. The first that is not too much work is taken. (Furnished room, 2,000 unknowns: their
/// view of its lamp differs by .05% rms between the two, and is 3.7% off by rays to 1e-2; the first
/// takes four times as long as the second.)
constexpr std::array<double, 2> kExactRowTolerances{FormFactorOptions::kExactTolerance, 1e-2};
/// Exact rows may be this much work (foreseen_work.h) for each ray, or for each hemicube and
/// polygon that it looks at: about half of what these take (a hemicube of 256 pixels .15 ms with 17
/// polygons, .95 ms with 17,672). In any case they may be kLittleExactRowWork, about two seconds of
/// a core.
constexpr double kExactRowWork = 7;
constexpr double kExactRowWorkAHemicube = 1e4;
constexpr double kExactRowWorkAPolygon = 2;
constexpr double kLittleExactRowWork = 2e8;
/// Preparing exact rows is about this much work for each patch. It may be kPreparedShare of what
/// the rows may be, so that rows that turn out to be too much have not cost long.
constexpr double kPreparedWork = 3000;
constexpr double kPreparedShare = 0.25;
/// At most this many pairs may be in exact rows: all are held at once, in 112 bytes each.
constexpr std::size_t kMostExactPairs = 1'000'000;

void requireUnknowns(const std::vector<Index>& rows, std::size_t unknowns) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows[k] < unknowns && (k == 0 || rows[k - 1] < rows[k])) continue;
    throw InputError(
        fmt::format("exact_rows[{}] = {}: give unknowns in ascending order, each once and below {}",
                    k, rows[k], unknowns));
  }
}

/// The unknowns whose rows are to be exact; for hemicubes, which look from every patch, their
/// patches.
std::vector<Index> exactRowsOf(const FormFactorPlan::Prepared& prepared, FormFactorMethod method) {
  const std::vector<Index>& wanted = prepared.options.exact_rows;
  if (method == FormFactorMethod::rays || !prepared.mesh.clusters) return wanted;
  std::vector<Index> patches;
  for (const Index unknown : wanted) {
    const auto own = prepared.mesh.clusters->patchesOf(unknown);
    patches.insert(patches.end(), own.begin(), own.end());
  }
  std::sort(patches.begin(), patches.end());
  return patches;
}

/// Prepares the rows that are to be exact, unless that is too much work beside the rays or
/// hemicubes.
void planExactRows(FormFactorPlan::Prepared& prepared, FormFactorPlan& plan, Progress& progress) {
  const bool rays = plan.method == FormFactorMethod::rays;
  const std::vector<Index> wanted = exactRowsOf(prepared, plan.method);
  const std::size_t pairs =
      wanted.size() * (rays ? prepared.mesh.unknowns() : prepared.mesh.size());
  const double a_hemicube =
      kExactRowWorkAHemicube + kExactRowWorkAPolygon * double(prepared.mesh.polygons.size());
  const double most =
      std::max(kLittleExactRowWork, rays ? kExactRowWork * prepared.ray_estimate.rays
                                         : a_hemicube * double(prepared.mesh.size()));
  if (wanted.empty() || pairs > kMostExactPairs) return;
  if (kPreparedWork * double(prepared.mesh.size()) > kPreparedShare * most) return;
  const Stopwatch watch;
  const PatchMesh* mesh = &prepared.mesh;
  if (!rays && mesh->clusters) {
    mesh = &prepared.patches.emplace(*mesh);
    prepared.patches->clusters.reset();
  }
  progress.begin("preparing", ExactScene::kSteps);
  LeadingRows& rows = prepared.exact_rows.emplace(*mesh, wanted, prepared.options, progress);
  progress.end();
  const double preparing = watch.seconds();
  RowSample sample = rows.sample(progress);
  for (const double tolerance : kExactRowTolerances) {
    rows.setTolerance(std::min(prepared.options.toleranceOf(plan.method), tolerance));
    if (rows.work(sample) > most) continue;
    plan.seconds += rows.seconds(sample, progress);
    // Hemicubes' own rows come after these.
    const std::size_t making = rows.bytes();
    plan.bytes =
        rays ? plan.bytes + making : std::max(plan.bytes, prepared.options.memory_held + making);
    plan.bytes += KnownEntries::bytes(std::min(double(pairs), sample.unoccluded + sample.occluded));
    prepared.seconds_exact_rows = preparing;
    return;
  }
  prepared.exact_rows.reset();
}

void noteRowsLeftOut(const FormFactorPlan::Prepared& prepared, const char* by,
                     FormFactorReport& report) {
  const std::size_t wanted = prepared.options.exact_rows.size();
  if (wanted == 0 || prepared.exact_rows) return;
  report.notes.push_back(
      {Severity::info, fmt::format("rows of the {} {} that {} are by {}, as all others: exact "
                                   "ones would take too long",
                                   countText(wanted), wanted == 1 ? "unknown" : "unknowns",
                                   wanted == 1 ? "emits" : "emit", by)});
}

void planRays(FormFactorPlan::Prepared& prepared, FormFactorPlan& plan, Progress& progress) {
  progress.begin("preparing", 1);
  const Stopwatch watch;
  const RayScene& scene = prepared.rays.emplace(prepared.mesh, prepared.options.seed);
  prepared.seconds_rays = watch.seconds();
  progress.advance();
  progress.end();
  progress.check();
  prepared.ray_estimate = estimateRays(scene, prepared.options, progress);
  plan.method = FormFactorMethod::rays;
  takeMemory(prepared.ray_estimate.memory, plan);
  plan.matrix_bytes = prepared.ray_estimate.matrix_bytes;
  plan.seconds = prepared.ray_estimate.seconds;
  plan.tolerance = prepared.ray_estimate.tolerance;
  if (plan.tolerance > prepared.options.toleranceOf(FormFactorMethod::rays)) {
    plan.seconds_to_tolerance = prepared.ray_estimate.seconds_to_tolerance;
  }
}

/// The plan of exact; nothing if making it takes longer than `seconds`.
std::optional<FormFactorPlan> lookAtExact(FormFactorPlan::Prepared& prepared, double seconds,
                                          Progress& progress) {
  TimedProgress timed(progress, seconds);
  FormFactorPlan exact;
  try {
    planExact(prepared, exact, timed);
  } catch (const Cancelled&) {
    timed.giveUp();
    return std::nullopt;
  }
  return exact;
}

/// Plans both methods and keeps one. If the look at exact takes long beside what rays take, exact
/// is not the faster one: a look takes about a hundredth of the whole.
void planEither(FormFactorPlan::Prepared& prepared, FormFactorPlan& plan, Progress& progress) {
  const std::size_t limit = prepared.options.memory_limit;
  const auto fits = [&](const FormFactorPlan& one) { return limit == 0 || one.bytes <= limit; };
  std::optional<FormFactorPlan> exact = lookAtExact(prepared, kFirstLookSeconds, progress);
  if (exact && fits(*exact) && exact->seconds <= kNoFurtherLookSeconds) {
    plan = std::move(*exact);
    plan.reason = fmt::format("it takes {}", secondsText(plan.seconds));
    return;
  }
  planRays(prepared, plan, progress);
  const double ray_seconds = plan.seconds;
  const std::string ray_tolerance = fmt::format("{:.2g}", plan.tolerance);
  const double most = secondsExactMayTake(prepared, ray_seconds);
  const double least = prepared.scene ? 2 * kLookSeconds : kLookUnpreparedSeconds / kLookShare;
  if (!exact && most > least) {
    exact = lookAtExact(prepared, std::max(kLookSeconds, kLookShare * most), progress);
  }
  const bool smaller = exact && !fits(*exact) && !fits(plan) && exact->bytes < plan.bytes;
  if (smaller || (exact && fits(*exact) && exact->seconds <= most)) {
    prepared.rays.reset();
    const std::size_t ray_bytes = plan.bytes;
    plan = std::move(*exact);
    plan.other_seconds = ray_seconds;
    plan.reason = fmt::format("it takes {}; rays, to {}, would take {}{}",
                              secondsText(plan.seconds), ray_tolerance, secondsText(ray_seconds),
                              smaller ? " and " + bytesText(ray_bytes) : "");
    return;
  }
  prepared.scene.reset();
  prepared.sample.reset();
  prepared.kernels.reset();
  plan.reason =
      fmt::format("to {} they take {}; exact would take ", ray_tolerance, secondsText(ray_seconds));
  if (exact) {
    plan.other_seconds = exact->seconds;
    plan.reason += fmt::format("{} and {}{}", secondsText(exact->seconds), bytesText(exact->bytes),
                               fits(*exact) ? "" : ", more than --memory-limit");
  } else {
    plan.reason += "longer, as far as it was looked at";
  }
}

}  // namespace

void FormFactorOptions::validate() const {
  if (resolution < 16 || resolution > 4096 || resolution % 2 != 0) {
    throw InputError(fmt::format(
        "hemicube resolution {}: give an even number of pixels from 16 to 4096", resolution));
  }
  if (tolerance && !(*tolerance >= 1e-12 && *tolerance <= 0.1)) {
    throw InputError(fmt::format("tolerance {}: give a fraction from 1e-12 to 0.1", *tolerance));
  }
}

Precision FormFactorOptions::storedPrecision() const {
  // Single precision rounds to 6e-8 of a value, well below a tolerance of 1e-6 of the mean.
  return precision.value_or(tolerance.value_or(kExactTolerance) < 1e-6
                                ? Precision::double_precision
                                : Precision::single_precision);
}

double FormFactorPlan::secondsIfLooser(double times) const {
  if (method == FormFactorMethod::hemicube) return seconds;
  if (method == FormFactorMethod::exact) return seconds * (1 - refining * (1 - 1 / times));
  // Error squared falls as n^-p with the number n of rays, p = kUsualOrder.
  return seconds * std::pow(times, -2 / kUsualOrder);
}

FormFactorPlan planFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  return planFormFactors(std::make_shared<const PatchMesh>(mesh), options, progress);
}

FormFactorPlan planFormFactors(std::shared_ptr<const PatchMesh> mesh,
                               const FormFactorOptions& options, Progress& progress) {
  if (!mesh) throw std::logic_error("planFormFactors(): no mesh");
  options.validate();
  requireUnknowns(options.exact_rows, mesh->unknowns());
  const Stopwatch watch;
  auto prepared = std::make_shared<FormFactorPlan::Prepared>(std::move(mesh), options);
  if (options.onlyForSources() || !options.exact_emitters) prepared->options.exact_rows.clear();
  FormFactorPlan plan;
  switch (options.method) {
    case FormFactorMethod::automatic:
      planEither(*prepared, plan, progress);
      break;
    case FormFactorMethod::exact:
      planExact(*prepared, plan, progress);
      break;
    case FormFactorMethod::rays:
      planRays(*prepared, plan, progress);
      break;
    case FormFactorMethod::hemicube:
      planHemicubes(*prepared, plan, progress);
      break;
  }
  if (plan.method != FormFactorMethod::exact) planExactRows(*prepared, plan, progress);
  prepared->seconds = watch.seconds();
  plan.prepared = std::move(prepared);
  return plan;
}

namespace {

FormFactors exactOf(const FormFactorPlan::Prepared& prepared, const ExactScene& scene,
                    const ExactKernels& kernels, Progress& progress, RowJournal* journal,
                    Processes* processes) {
  FormFactors result = exactFactors(prepared.mesh, scene, kernels, prepared.estimate,
                                    prepared.options, progress, journal, processes);
  result.report.exact.seconds_prepare += prepared.seconds_exact;
  return result;
}

/// The rows that are exact beside rays or hemicubes; none if they were left out.
std::vector<KnownRow> exactRows(const FormFactorPlan::Prepared& prepared, Progress& progress) {
  if (!prepared.exact_rows) return {};
  return prepared.exact_rows->compute(progress);
}

/// Exact form factors, unless they take far longer than foreseen. Time is that of processors, so
/// that other work on the machine does not change the method.
std::optional<FormFactors> exactInTime(const FormFactorPlan& plan, const ExactScene& scene,
                                       const ExactKernels& kernels, Progress& progress,
                                       RowJournal* journal) {
  const double over = std::max(kOverrunTimes * plan.seconds, kOverrunSeconds);
  TimedProgress timed(progress, double(allowedThreads()) * (plan.seconds + over), processSeconds);
  try {
    return exactOf(*plan.prepared, scene, kernels, timed, journal, nullptr);
  } catch (const Cancelled&) {
    timed.giveUp();
    return std::nullopt;
  }
}

/// Rays in place of exact form factors that were given up after `seconds`.
FormFactors raysInstead(const FormFactorPlan& exact, double seconds, Progress& progress) {
  FormFactorOptions options = exact.prepared->options;
  options.method = FormFactorMethod::rays;
  FormFactorPlan rays = planFormFactors(exact.prepared->kept, options, progress);
  rays.reason = fmt::format("exact, which was to take {}, was not done after {}",
                            secondsText(exact.seconds), secondsText(seconds));
  FormFactors result = computeFormFactors(rays, progress);
  result.report.notes.push_back({Severity::info, "form factors by rays: " + rays.reason});
  result.report.seconds += exact.prepared->seconds + seconds;
  return result;
}

}  // namespace

FormFactors computeFormFactors(const FormFactorPlan& plan, Progress& progress, RowJournal* journal,
                               Processes* processes) {
  const Stopwatch watch;
  if (!plan.prepared) throw std::logic_error("this plan is not from planFormFactors()");
  const FormFactorPlan::Prepared& prepared = *plan.prepared;
  if (processes != nullptr) {
    tellOthers(*processes, prepared.mesh, plan.method, prepared.options);
  }
  FormFactors result;
  if (prepared.scene && prepared.kernels) {
    // One process alone cannot give up shared work.
    if (processes == nullptr && prepared.options.method == FormFactorMethod::automatic) {
      std::optional<FormFactors> in_time =
          exactInTime(plan, *prepared.scene, *prepared.kernels, progress, journal);
      if (!in_time) return raysInstead(plan, watch.seconds(), progress);
      result = std::move(*in_time);
    } else {
      result = exactOf(prepared, *prepared.scene, *prepared.kernels, progress, journal, processes);
    }
  } else if (prepared.hemicubes) {
    result =
        hemicubeFactors(prepared.mesh, *prepared.hemicubes, exactRows(prepared, progress),
                        prepared.hemicube_estimate, prepared.options, progress, journal, processes);
    noteRowsLeftOut(prepared, "hemicubes", result.report);
  } else if (prepared.rays) {
    std::vector<KnownRow> known = exactRows(prepared, progress);
    const double seconds_known = watch.seconds();
    result = rayFactors(prepared.mesh, *prepared.rays, std::move(known), prepared.ray_estimate,
                        prepared.options, progress, journal, processes);
    result.report.rays.seconds_prepare =
        prepared.seconds_rays + prepared.seconds_exact_rows + seconds_known;
    noteRowsLeftOut(prepared, "rays", result.report);
  } else {
    throw std::logic_error("this plan was not prepared");
  }
  if (prepared.mesh.clusters && !prepared.rays) {  // rays are counted between clusters
    result = clusterFactors(result, prepared.mesh, progress);
  }
  FormFactorReport& report = result.report;
  if (result.seeNothing()) {
    if (std::optional<Note> note = nothingSeenNote(prepared.mesh)) {
      report.notes.push_back(*std::move(note));
    }
  }
  report.method_reason = plan.reason;
  // What was prepared for the method is part of its work.
  double preparing = prepared.seconds_exact_rows;
  if (plan.method == FormFactorMethod::exact) preparing += prepared.seconds_exact;
  if (plan.method == FormFactorMethod::rays) preparing += prepared.seconds_rays;
  report.seconds_plan = prepared.seconds - preparing;
  report.estimated_seconds = preparing + plan.seconds;
  report.matrix_bytes = result.matrix.bytes();
  report.seconds = prepared.seconds + watch.seconds();
  return result;
}

FormFactors computeFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  // The mesh outlives the plan, which ends with this call: it is not copied.
  const std::shared_ptr<const PatchMesh> here(std::shared_ptr<const void>(), &mesh);
  return computeFormFactors(planFormFactors(here, options, progress), progress);
}

}  // namespace radiosity
