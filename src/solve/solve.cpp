#include "radiosity/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string_view>

#include "solve/certificate.h"
#include "solve/cluster_solve.h"
#include "solve/energy.h"
#include "solve/iteration.h"
#include "solve/singular.h"
#include "solve/solve_rows.h"

namespace radiosity {

namespace {

void checkSizes(const FormFactors& factors, std::span<const double> reflectance,
                std::span<const double> emission, std::span<const double> sky, int bands,
                const PatchNames& names) {
  const std::size_t n = factors.matrix.size();
  if (bands < 1) throw InputError(fmt::format("solve: {} bands; 1 or more are needed", bands));
  const auto check = [](std::string_view what, std::size_t size, std::size_t expected) {
    if (size == expected) return;
    throw InputError(fmt::format("solve: {} {} values where {} are needed", size, what, expected));
  };
  check("reflectance", reflectance.size(), n * std::size_t(bands));
  check("emission", emission.size(), n * std::size_t(bands));
  check("row sum", factors.fronts.size(), n);
  check("back", factors.backs.size(), n);
  check("sky", factors.sky.size(), n);
  if (!sky.empty()) check("sky radiance", sky.size(), std::size_t(bands));
  for (const double radiance : sky) {
    if (radiance >= 0 && std::isfinite(radiance)) continue;
    throw InputError(fmt::format("solve: sky radiance {} is not a finite number >= 0", radiance));
  }
  if (names.group.empty()) return;
  check("surface", names.group.size(), n);
  for (const Index g : names.group) {
    if (g >= names.names.size()) throw InputError(fmt::format("solve: surface {} has no name", g));
  }
}

/// Irradiance of each patch from the sky, N * bands, W/m^2. An exact row's account of the sky may
/// be a little below 0.
std::vector<double> skyIrradiance(const FormFactors& factors, std::span<const double> sky,
                                  int bands) {
  std::vector<double> irradiance(factors.sky.size() * std::size_t(bands), 0.0);
  for (std::size_t k = 0; !sky.empty() && k < irradiance.size(); ++k) {
    const double share = std::max(0.0, factors.sky[k / std::size_t(bands)]);
    irradiance[k] = std::numbers::pi * sky[k % std::size_t(bands)] * share;
  }
  return irradiance;
}

/// E plus the reflected irradiance that is given.
std::vector<double> sourceOf(std::span<const double> reflectance, std::span<const double> emission,
                             std::span<const double> given) {
  std::vector<double> source(emission.begin(), emission.end());
  for (std::size_t k = 0; k < source.size(); ++k) source[k] += reflectance[k] * given[k];
  return source;
}

/// Which bands are solved, and where each band's values come from.
class BandPlan {
 public:
  BandPlan(std::span<const double> reflectance, std::span<const double> emission, int bands)
      : bands_(std::size_t(bands)) {
    for (std::size_t b = 0; b < bands_; ++b) {
      const auto same = std::find_if(solved_.begin(), solved_.end(), [&](std::size_t earlier) {
        return equal(reflectance, b, earlier) && equal(emission, b, earlier);
      });
      if (!emits(emission, b)) {
        source_.push_back(kDark);
        continue;
      }
      source_.push_back(std::size_t(same - solved_.begin()));
      if (same == solved_.end()) solved_.push_back(b);
    }
  }
  std::span<const std::size_t> solved() const { return solved_; }
  int dark() const { return int(std::count(source_.begin(), source_.end(), kDark)); }
  int repeated() const { return int(bands_) - dark() - int(solved_.size()); }

  /// The bands to solve of N * bands values.
  std::vector<double> pick(std::span<const double> values) const {
    std::vector<double> out;
    out.reserve(values.size() / bands_ * solved_.size());
    for (std::size_t row = 0; row < values.size(); row += bands_) {
      for (const std::size_t b : solved_) out.push_back(values[row + b]);
    }
    return out;
  }
  /// All bands from those solved; dark ones are 0.
  std::vector<double> spread(std::span<const double> values) const {
    const std::size_t width = solved_.size();
    std::vector<double> out;
    out.reserve(values.size() / width * bands_);
    for (std::size_t row = 0; row < values.size(); row += width) {
      for (const std::size_t from : source_) {
        out.push_back(from == kDark ? 0.0 : values[row + from]);
      }
    }
    return out;
  }

 private:
  static constexpr std::size_t kDark = std::size_t(-1);

  bool emits(std::span<const double> emission, std::size_t b) const {
    bool any = false;
    for (std::size_t k = b; k < emission.size(); k += bands_) any = any || emission[k] > 0;
    return any;
  }
  bool equal(std::span<const double> values, std::size_t a, std::size_t b) const {
    bool all = true;
    for (std::size_t row = 0; row < values.size(); row += bands_) {
      all = all && values[row + a] == values[row + b];
    }
    return all;
  }

  std::size_t bands_;
  std::vector<std::size_t> solved_;  // bands
  std::vector<std::size_t> source_;  // by band: an index into solved_, or kDark
};

std::string_view titleOf(Solver solver) {
  switch (solver) {
    case Solver::jacobi:
      return "Jacobi";
    case Solver::gauss_seidel:
      return "Gauss-Seidel";
  }
  return "";
}

Fields run(Solver solver, const System& system, Convergence& convergence) {
  switch (solver) {
    case Solver::jacobi:
      return jacobi(system, convergence);
    case Solver::gauss_seidel:
      return gaussSeidel(system, convergence);
  }
  throw std::logic_error("a solver without an iteration");
}

std::string convergenceMessage(const SolveSummary& summary, const SolveOptions& options,
                               bool diverged) {
  const std::string numbers =
      fmt::format("{} {} sweeps, residual {:.2e} (asked for {:.2e})", summary.iterations,
                  titleOf(options.solver), summary.residual, options.tolerance);
  const std::string bound =
      summary.error_bound
          ? fmt::format("the error against this matrix's solution is below {:.2e} W/m^2",
                        *summary.error_bound)
          : std::string(
                "no certificate: the error could not be bounded in the time that the "
                "solution took");
  if (summary.status == SolveStatus::converged) {
    return fmt::format("converged: {}; {}; usable", numbers, bound);
  }
  const std::string_view cure =
      diverged ? "it grows: reflectance times row sum is above 1 over much of a room, so restore "
                 "closure or use the raw rows"
               : "reflectances near 1 in a closed room need many sweeps: allow more";
  return fmt::format("no convergence: {}; {}; not usable as it is; {}", numbers, bound, cure);
}

/// Iterates, then bounds the error; fills in the summary except for energy and time.
Fields iterate(const System& system, const SolveOptions& options, Progress& progress,
               SolveSummary& summary) {
  Fields fields;
  bool diverged = false;
  {
    Convergence convergence(options.tolerance, options.max_iterations, "solving", progress);
    fields = run(options.solver, system, convergence);
    diverged = convergence.diverged();
    summary.status = convergence.converged() ? SolveStatus::converged : SolveStatus::no_convergence;
    summary.iterations = convergence.sweeps();
    summary.rows = convergence.rows();
    summary.residual_history = convergence.history();
  }
  summary.residual = summary.residual_history.back();
  if (!diverged) {
    summary.error_bound = certifiedErrorBound(system, fields, summary.iterations, progress);
  }
  summary.message = convergenceMessage(summary, options, diverged);
  blackIrradiance(system, fields);
  return fields;
}

/// Nothing leaves any patch.
void nameDarkness(const std::vector<double>& from_sky, SolveSummary& summary) {
  const bool sky = std::any_of(from_sky.begin(), from_sky.end(), [](double h) { return h > 0; });
  summary.status = sky ? SolveStatus::converged : SolveStatus::no_light;
  summary.message =
      sky ? "converged: the sky shines in, but no patch emits or reflects, so B = 0; usable"
          : "no light: no patch emits, so everything is dark; usable, but black";
}

}  // namespace

void checkMaterials(std::span<const double> reflectance, std::span<const double> emission,
                    int bands, const PatchNames& names) {
  for (std::size_t k = 0; k < reflectance.size(); ++k) {
    const std::size_t i = k / std::size_t(bands);
    if (!(reflectance[k] >= 0 && reflectance[k] <= 1)) {
      throw InputError(fmt::format("solve: {}: reflectance {} is not within 0 and 1", names.of(i),
                                   reflectance[k]));
    }
    if (!(emission[k] >= 0) || !std::isfinite(emission[k])) {
      throw InputError(fmt::format("solve: {}: emission {} is not a finite number >= 0",
                                   names.of(i), emission[k]));
    }
  }
}

void SolveOptions::validate() const {
  if (!(tolerance > 0 && tolerance < 1)) {
    throw InputError(fmt::format("tolerance {} is not between 0 and 1", tolerance));
  }
  if (max_iterations < 1) {
    throw InputError(fmt::format("max_iterations {} is not 1 or more", max_iterations));
  }
}

Solution solveRows(const FormFactors& factors, std::span<const double> reflectance,
                   std::span<const double> emission, int bands, const SolveOptions& options,
                   Progress& progress, const PatchNames& names, std::span<const double> sky,
                   std::span<const double> more) {
  const auto start = std::chrono::steady_clock::now();
  options.validate();
  checkSizes(factors, reflectance, emission, sky, bands, names);
  checkMaterials(reflectance, emission, bands, names);

  Solution solution;
  solution.bands = bands;
  SolveSummary& summary = solution.summary;
  const std::vector<double> from_sky = skyIrradiance(factors, sky, bands);
  std::vector<double> given = from_sky;
  for (std::size_t k = 0; k < more.size(); ++k) given[k] += more[k];
  const std::vector<double> source = sourceOf(reflectance, emission, given);
  const BandPlan plan(reflectance, source, bands);
  const System system(factors.matrix, int(plan.solved().size()), plan.pick(reflectance),
                      plan.pick(source));
  summary.skipped = {
      .black_patches = system.black, .dark_bands = plan.dark(), .equal_bands = plan.repeated()};
  if (plan.solved().empty()) {
    solution.radiosity.assign(emission.size(), 0.0);
    solution.irradiance.assign(emission.size(), 0.0);
    summary.error_bound = 0.0;
    nameDarkness(from_sky, summary);
  } else if (const WhiteRoom room = findWhiteRoom(factors, system); !room.patches.empty()) {
    summary.status = SolveStatus::singular;
    summary.message = fmt::format(
        "singular: in band {} a closed room has reflectance 1 everywhere, so its light is never "
        "absorbed and no solution exists; not usable; give one of its surfaces a reflectance below "
        "1: {}",
        plan.solved()[std::size_t(room.band)], names.list(room.patches));
    return solution;
  } else {
    const Fields fields = iterate(system, options, progress, summary);
    solution.radiosity = plan.spread(fields.radiosity);
    solution.irradiance = plan.spread(fields.irradiance);
  }
  for (std::size_t k = 0; k < given.size(); ++k) solution.irradiance[k] += given[k];
  summary.energy = energyAccount(factors, reflectance, {emission, from_sky}, solution.radiosity,
                                 solution.irradiance, bands);
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

Solution solve(const FormFactors& factors, std::span<const double> reflectance,
               std::span<const double> emission, int bands, const SolveOptions& options,
               Progress& progress, std::span<const Index> group,
               std::span<const std::string> group_names, std::span<const double> sky) {
  return solveRows(factors, reflectance, emission, bands, options, progress, {group, group_names},
                   sky, {});
}

Solution solve(const FormFactors& factors, const PatchMaterials& materials, const PatchMesh& mesh,
               const SolveOptions& options, Progress& progress) {
  materials.requireSizes(mesh.size());
  if (mesh.clusters) return ClusterSolve(factors, materials, mesh, options, progress).run();
  return solve(factors, materials.reflectance, materials.emission, materials.bands, options,
               progress, mesh.surface, mesh.surface_names, materials.sky);
}

}  // namespace radiosity
