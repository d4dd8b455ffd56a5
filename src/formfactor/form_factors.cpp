#include "radiosity/form_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/figure_text.h"
#include "formfactor/exact/assembly/exact_factors.h"
#include "formfactor/exact/assembly/row_sample.h"
#include "formfactor/foreseen_work.h"
#include "formfactor/hemicube/hemicube_factors.h"
#include "formfactor/rays/ray_factors.h"

namespace radiosity {

struct FormFactorPlan::Prepared {
  Prepared(std::shared_ptr<const PatchMesh> of, const FormFactorOptions& with)
      : kept(std::move(of)), mesh(*kept), options(with) {}
  std::shared_ptr<const PatchMesh> kept;
  const PatchMesh& mesh;  ///< the one that is kept
  FormFactorOptions options;
  // Where the method is exact:
  std::optional<ExactScene> scene;
  std::optional<ExactKernels> kernels;  ///< of the scene
  ExactEstimate estimate;
  // Where it is not:
  std::optional<HemicubeScene> hemicubes;
  HemicubeEstimate hemicube_estimate;
  std::optional<RayScene> rays;
  RayEstimate ray_estimate;
  double seconds = 0;  ///< that this took
};

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Seconds of a wait that is worth saying how to shorten.
constexpr double kLongWait = 60;
/// Hemicubes are chosen only where exact is much work (kMuchWork), and so many times theirs: they
/// stall at some per cent of the matrix however many pixels they have.
constexpr double kWorthTheError = 30;
/// A rough estimate decides where it is past both by this. (In 21 scenes of others it was 0.24 to
/// 2.7 times the full one.)
constexpr double kFarBeyond = 5;

/// In a scene of few polygons.
double simpleHemicubeWork(const PatchMesh& mesh, const FormFactorOptions& options) {
  const double pixels = double(options.resolution) / 256;
  return kHemicubeWork * pixels * pixels * double(mesh.size());
}

std::string clutterText(const ExactEstimate& estimate) {
  if (estimate.occluded_pairs < 1) return "no pair of a sample is occluded";
  const double unit =
      std::pow(10.0, std::max(0.0, std::floor(std::log10(estimate.occluded_pairs)) - 1));
  const auto rounded = std::size_t(unit * std::round(estimate.occluded_pairs / unit));
  return fmt::format("about {} pairs are occluded, past {:.1f} occluders each", countText(rounded),
                     estimate.occluders_per_pair);
}

/// Of the exact method.
struct ExactWork {
  double all;    ///< see foreseen_work.h
  double times;  ///< as much as that of hemicubes in a simple scene
};

ExactWork exactWork(const ExactEstimate& estimate, const PatchMesh& mesh,
                    const FormFactorOptions& options) {
  // A tolerance below the default rules hemicubes out: the work that it adds does not count.
  const double beyond = std::max(0.0, 1 - options.tolerance / FormFactorOptions().tolerance);
  const double work = estimate.work - beyond * estimate.refining;
  return {work, work / simpleHemicubeWork(mesh, options)};
}

bool isTooMuch(const ExactWork& work, double margin) {
  return work.all > margin * kMuchWork && work.times > margin * kWorthTheError;
}

/// The method, and why.
void choose(const ExactEstimate& estimate, const PatchMesh& mesh, const FormFactorOptions& options,
            FormFactorPlan& plan) {
  plan.method = FormFactorMethod::exact;
  if (options.method == FormFactorMethod::exact) return;
  const ExactWork work = exactWork(estimate, mesh, options);
  if (isTooMuch(work, 1)) {
    plan.method = FormFactorMethod::hemicube;
    plan.reason = fmt::format(
        "{}; exact would be {:.0f} times the work of as many hemicubes in a simple scene",
        clutterText(estimate), work.times);
  } else if (options.memory_limit > 0 && estimate.bytes > options.memory_limit) {
    plan.method = FormFactorMethod::hemicube;
    plan.reason = "exact would need " + bytesText(estimate.bytes) + ", more than the limit";
  } else {
    plan.reason = clutterText(estimate);
  }
}

/// A full sample, but for a rough one where that settles that hemicubes are chosen.
RowSample sampleToChoose(const FormFactorPlan::Prepared& prepared, const ExactScene& scene,
                         Progress& progress) {
  const FormFactorOptions& options = prepared.options;
  if (options.method == FormFactorMethod::automatic) {
    RowSample rough = sampleRows(scene, options.tolerance, SampleSize::rough, progress);
    const ExactEstimate estimate = estimateExact(scene, rough, options);
    if (isTooMuch(exactWork(estimate, prepared.mesh, options), kFarBeyond)) return rough;
  }
  return sampleRows(scene, options.tolerance, SampleSize::full, progress);
}

void planExact(FormFactorPlan::Prepared& prepared, FormFactorPlan& plan, Progress& progress) {
  const FormFactorOptions& options = prepared.options;
  progress.begin("preparing", ExactScene::kSteps);
  const ExactScene& scene = prepared.scene.emplace(prepared.mesh, progress);
  progress.end();
  const RowSample sample = sampleToChoose(prepared, scene, progress);
  prepared.estimate = estimateExact(scene, sample, options);
  choose(prepared.estimate, prepared.mesh, options, plan);
  if (plan.method != FormFactorMethod::exact) {
    prepared.scene.reset();
    return;
  }
  const ExactKernels& kernels = prepared.kernels.emplace(scene, options);
  plan.bytes = prepared.estimate.bytes;
  plan.matrix_bytes = prepared.estimate.matrix_bytes;
  plan.seconds = exactSeconds(scene, kernels, sample, options, progress);
  plan.refining =
      prepared.estimate.work > 0 ? prepared.estimate.refining / prepared.estimate.work : 0.0;
}

void planHemicubes(FormFactorPlan::Prepared& prepared, FormFactorPlan& plan, Progress& progress) {
  progress.begin("preparing", 1);
  const HemicubeScene& scene = prepared.hemicubes.emplace(prepared.mesh, prepared.options);
  progress.advance();
  progress.end();
  progress.check();
  prepared.hemicube_estimate = estimateHemicubes(prepared.mesh, scene, prepared.options, progress);
  plan.bytes = prepared.hemicube_estimate.bytes;
  plan.matrix_bytes = prepared.hemicube_estimate.matrix_bytes;
  plan.seconds = prepared.hemicube_estimate.measured;
  plan.refining = 0;
}

void planRays(FormFactorPlan::Prepared& prepared, FormFactorPlan& plan, Progress& progress) {
  progress.begin("preparing", 1);
  const RayScene& scene = prepared.rays.emplace(prepared.mesh, prepared.options.seed);
  progress.advance();
  progress.end();
  progress.check();
  prepared.ray_estimate = estimateRays(scene, prepared.options, progress);
  plan.method = FormFactorMethod::rays;
  plan.bytes = prepared.ray_estimate.bytes;
  plan.matrix_bytes = prepared.ray_estimate.matrix_bytes;
  plan.seconds = prepared.ray_estimate.seconds;
  plan.refining = 1;
}

}  // namespace

void FormFactorOptions::validate() const {
  if (resolution < 16 || resolution > 4096 || resolution % 2 != 0) {
    throw InputError(fmt::format(
        "hemicube resolution {}: give an even number of pixels from 16 to 4096", resolution));
  }
  if (!(tolerance >= 1e-12 && tolerance <= 0.1)) {
    throw InputError(fmt::format(
        "tolerance {}: give a fraction of the mean form factor from 1e-12 to 0.1", tolerance));
  }
}

Precision FormFactorOptions::storedPrecision() const {
  // Single precision rounds to 6e-8 of a value, well below a tolerance of 1e-6 of the mean.
  return precision.value_or(tolerance < 1e-6 ? Precision::double_precision
                                             : Precision::single_precision);
}

FormFactorPlan planFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  return planFormFactors(std::make_shared<const PatchMesh>(mesh), options, progress);
}

FormFactorPlan planFormFactors(std::shared_ptr<const PatchMesh> mesh,
                               const FormFactorOptions& options, Progress& progress) {
  if (!mesh) throw std::logic_error("planFormFactors(): no mesh");
  options.validate();
  const Clock::time_point start = Clock::now();
  auto prepared = std::make_shared<FormFactorPlan::Prepared>(std::move(mesh), options);
  FormFactorPlan plan;
  if (options.method == FormFactorMethod::rays) {
    planRays(*prepared, plan, progress);
  } else if (options.method != FormFactorMethod::hemicube) {
    planExact(*prepared, plan, progress);
  }
  if (plan.method == FormFactorMethod::hemicube) {
    planHemicubes(*prepared, plan, progress);
  } else if (plan.method == FormFactorMethod::exact && plan.seconds > kLongWait) {
    const HemicubeScene scene(prepared->mesh, options);
    plan.hemicube_seconds = estimateHemicubes(prepared->mesh, scene, options, progress).measured;
  }
  prepared->seconds = secondsSince(start);
  plan.prepared = std::move(prepared);
  return plan;
}

FormFactors computeFormFactors(const FormFactorPlan& plan, Progress& progress) {
  const Clock::time_point start = Clock::now();
  if (!plan.prepared) throw std::logic_error("this plan is not from planFormFactors()");
  const FormFactorPlan::Prepared& prepared = *plan.prepared;
  FormFactors result;
  if (prepared.scene && prepared.kernels) {
    result = exactFactors(prepared.mesh, *prepared.scene, *prepared.kernels, prepared.estimate,
                          prepared.options, progress);
    result.report.exact.seconds_prepare += prepared.seconds;
  } else if (prepared.hemicubes) {
    result = hemicubeFactors(prepared.mesh, *prepared.hemicubes, prepared.hemicube_estimate,
                             prepared.options, progress);
  } else if (prepared.rays) {
    result = rayFactors(prepared.mesh, *prepared.rays, prepared.ray_estimate, prepared.options,
                        progress);
  } else {
    throw std::logic_error("this plan was not prepared");
  }
  FormFactorReport& report = result.report;
  report.method_reason = plan.reason;
  report.seconds_plan = prepared.seconds;
  report.estimated_seconds = plan.seconds;
  report.matrix_bytes = result.matrix.bytes();
  report.seconds = prepared.seconds + secondsSince(start);
  return result;
}

FormFactors computeFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  // The plan does not outlive this call, and the mesh does: it is not copied.
  const std::shared_ptr<const PatchMesh> here(std::shared_ptr<const void>(), &mesh);
  return computeFormFactors(planFormFactors(here, options, progress), progress);
}

}  // namespace radiosity
