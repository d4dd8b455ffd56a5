#include "radiosity/form_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

#include "formfactor/exact/exact_factors.h"
#include "formfactor/hemicube_factors.h"

namespace radiosity {

struct FormFactorPlan::Prepared {
  Prepared(const PatchMesh& of, const FormFactorOptions& with) : mesh(of), options(with) {}
  const PatchMesh& mesh;
  FormFactorOptions options;
  std::optional<ExactScene> scene;  ///< where the method is exact
  ExactEstimate estimate;           ///< of it
  double seconds = 0;               ///< that this took
};

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Hemicubes are chosen only where they save a wait, ...
constexpr double kPatience = 60;
/// ... and much of it: they stall at some per cent of the matrix however many pixels they have.
constexpr double kWorthTheError = 30;

/// Of one core: what a hemicube of 256 pixels took on a 2.7 GHz Xeon; with the pixels elsewhere.
double hemicubeSeconds(const PatchMesh& mesh, const FormFactorOptions& options) {
  const double pixels = double(options.resolution) / 256;
  return 4e-4 * pixels * pixels * double(mesh.size());
}

std::string timeText(double seconds) {
  return seconds < 1 ? std::string("less than 1 s") : fmt::format("about {:.0f} s", seconds);
}

FormFactorPlan planWith(const ExactEstimate& estimate, const PatchMesh& mesh,
                        const FormFactorOptions& options) {
  FormFactorPlan plan{FormFactorMethod::exact, "", estimate.bytes, nullptr};
  if (options.method == FormFactorMethod::exact) return plan;
  const double hemicubes = hemicubeSeconds(mesh, options);
  // Who asks for more than the default does not ask for hemicubes: what that adds does not count.
  const double beyond = std::max(0.0, 1 - options.tolerance / FormFactorOptions().tolerance);
  const double wait = estimate.seconds - beyond * estimate.refining;
  const std::string clutter =
      estimate.partial_pairs < 1
          ? std::string("no pair of a sample is partly hidden")
          : fmt::format("about {:.2g} pairs are partly hidden, past {:.1f} occluders each",
                        estimate.partial_pairs, estimate.occluders_per_partial);
  if (wait > kPatience && wait > kWorthTheError * hemicubes) {
    plan.method = FormFactorMethod::hemicube;
    plan.reason = fmt::format("hemicube: {}; exact would take a core {}, hemicubes {}", clutter,
                              timeText(estimate.seconds), timeText(hemicubes));
  } else if (options.memory_limit > 0 && estimate.bytes > options.memory_limit) {
    plan.method = FormFactorMethod::hemicube;
    plan.reason = fmt::format("hemicube: exact would need {:.0f} MiB, more than the limit",
                              double(estimate.bytes) / (1024.0 * 1024.0));
  } else {
    plan.reason = fmt::format("exact: {}; {} of a core", clutter, timeText(estimate.seconds));
  }
  return plan;
}

/// A plan, but for the bytes of hemicubes.
FormFactorPlan prepare(const PatchMesh& mesh, const FormFactorOptions& options) {
  options.validate();
  const Clock::time_point start = Clock::now();
  auto prepared = std::make_shared<FormFactorPlan::Prepared>(mesh, options);
  FormFactorPlan plan;
  if (options.method != FormFactorMethod::hemicube) {
    prepared->estimate = estimateExact(prepared->scene.emplace(mesh), options);
    plan = planWith(prepared->estimate, mesh, options);
    if (plan.method == FormFactorMethod::hemicube) prepared->scene.reset();
  }
  prepared->seconds = secondsSince(start);
  plan.prepared = std::move(prepared);
  return plan;
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
  return precision.value_or(tolerance < 1e-6 ? Precision::real : Precision::single);
}

FormFactorPlan planFormFactors(const PatchMesh& mesh, const FormFactorOptions& options) {
  FormFactorPlan plan = prepare(mesh, options);
  if (plan.method == FormFactorMethod::hemicube) plan.bytes = hemicubeBytes(mesh, options);
  return plan;
}

FormFactors computeFormFactors(const FormFactorPlan& plan, Progress& progress) {
  const Clock::time_point start = Clock::now();
  if (!plan.prepared) throw std::logic_error("this plan is not from planFormFactors()");
  const FormFactorPlan::Prepared& prepared = *plan.prepared;
  FormFactors result;
  if (prepared.scene) {
    result =
        exactFactors(prepared.mesh, *prepared.scene, prepared.estimate, prepared.options, progress);
    result.report.exact.seconds_prepare += prepared.seconds;
  } else {
    result = hemicubeFactors(prepared.mesh, prepared.options, progress);
  }
  FormFactorReport& report = result.report;
  report.method_reason = plan.reason;
  report.matrix_bytes = result.matrix.bytes();
  report.seconds = prepared.seconds + secondsSince(start);
  return result;
}

FormFactors computeFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  // Hemicubes estimate their bytes themselves.
  return computeFormFactors(prepare(mesh, options), progress);
}

}  // namespace radiosity
