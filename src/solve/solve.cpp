#include "radiosity/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/figure_text.h"
#include "base/option_list.h"
#include "base/processor_clock.h"
#include "formfactor/light_on_patches.h"
#include "solve/band_plan.h"
#include "solve/energy.h"
#include "solve/linear_solve.h"
#include "solve/patch_names.h"
#include "solve/singular.h"

namespace radiosity {

namespace {

void checkSizes(const FormFactors& factors, std::span<const double> reflectance,
                std::span<const double> emission, std::span<const double> given, int bands,
                const PatchNames& names) {
  if (!factors.matrix) throw InputError("solve: the form factors came without their matrix");
  const std::size_t n = factors.matrix->size();
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
  check("given irradiance", given.size(), n * std::size_t(bands));
  if (names.group.empty()) return;
  check("surface", names.group.size(), n);
  for (const Index g : names.group) {
    if (g >= names.names.size()) throw InputError(fmt::format("solve: surface {} has no name", g));
  }
}

/// Irradiance of each patch from a sky of that radiance, N * bands, W/m^2. An exact row's account
/// of the sky may be a little below 0.
std::vector<double> skyIrradiance(const FormFactors& factors, std::span<const double> radiance,
                                  int bands) {
  const auto width = std::size_t(bands);
  std::vector<double> irradiance(factors.sky.size() * width, 0.0);
  if (radiance.empty()) return irradiance;
  if (radiance.size() != width) {
    throw InputError(
        fmt::format("solve: {} sky radiance values where {} are needed", radiance.size(), width));
  }
  const Light sky = uniformSky({radiance.begin(), radiance.end()});
  sky.validate();
  for (std::size_t k = 0; k < irradiance.size(); ++k) {
    irradiance[k] = sky.fromAround(k % width, std::max(0.0, factors.sky[k / width]));
  }
  return irradiance;
}

/// E plus rho times the given irradiance.
std::vector<double> sourceOf(std::span<const double> reflectance, std::span<const double> emission,
                             std::span<const double> given) {
  std::vector<double> source(emission.begin(), emission.end());
  for (std::size_t k = 0; k < source.size(); ++k) source[k] += reflectance[k] * given[k];
  return source;
}

/// Where form factors are fits, some of which are below 0, what falls on a dark patch may come out
/// below 0, within its error: it is 0, and the message says for how many patches.
void raiseFromBelowZero(std::span<const double> source, Solution& solution) {
  const auto width = std::size_t(solution.bands);
  std::size_t raised = 0;
  for (std::size_t i = 0; i < solution.irradiance.size() / width; ++i) {
    bool below = false;
    for (std::size_t k = i * width; k < (i + 1) * width; ++k) {
      if (!(solution.irradiance[k] < 0)) continue;
      below = true;
      solution.irradiance[k] = 0;
      solution.radiosity[k] = source[k];
    }
    raised += below ? 1 : 0;
  }
  if (raised == 0) return;
  solution.summary.message += fmt::format("; irradiance of {} {}, below 0 by its error, is 0",
                                          countText(raised), raised == 1 ? "patch" : "patches");
}

/// L2 by area, over all bands.
double normOf(std::span<const double> irradiance, std::span<const double> area) {
  const std::size_t bands = area.empty() ? 1 : irradiance.size() / area.size();
  double squares = 0;
  for (std::size_t k = 0; k < irradiance.size(); ++k) {
    squares += area[k / bands] * irradiance[k] * irradiance[k];
  }
  return std::sqrt(squares);
}

/// About the error (L2, by area) of F B at most, where rows state their errors. What a row is off
/// by is independent from column to column, has a variance in proportion to F_ij, as counts of rays
/// do, and sums to nothing with what the row misses: so its H is off by its error times the
/// standard deviation of the light over what it sees. `beside`: B less the light of what rows miss.
/// Exact rows, of emitters, are right in all columns, too: their own light is left out.
std::optional<double> errorByRows(const FormFactors& factors, std::span<const double> emission,
                                  std::span<const double> beside, int bands) {
  if (factors.error.empty()) return std::nullopt;
  const std::span<const double> area = factors.matrix->area();
  const auto width = std::size_t(bands);
  // A column of light and one of its squares for each band.
  std::vector<double> light(2 * beside.size());
  std::vector<double> seen(light.size());
  for (std::size_t k = 0; k < beside.size(); ++k) {
    const double own = factors.report.exact_rows ? emission[k] : 0.0;
    const double value = beside[k] - own;
    light[2 * k] = value;
    light[2 * k + 1] = value * value;
  }
  factors.matrix->product(light, 2 * bands, seen);
  double square = 0;
  for (std::size_t k = 0; k < beside.size(); ++k) {
    const std::size_t i = k / width;
    const double variance = std::max(0.0, seen[2 * k + 1] - seen[2 * k] * seen[2 * k]);
    square += area[i] * factors.error[i] * factors.error[i] * variance;
  }
  return std::sqrt(square);
}

/// About the error (L2, by area) of irradiance by other patches and from around, where the matrix
/// knows it. `around`: W/m^2, by band, from where nothing stands, alike all round; or none. What a
/// row misses of patches it finds of that, and the other way round.
std::optional<double> errorOf(const FormFactors& factors, std::span<const double> emission,
                              const Solution& solution, std::span<const double> around) {
  const auto width = std::size_t(solution.bands);
  std::vector<double> beside = solution.radiosity;
  for (std::size_t k = 0; k < beside.size() && !around.empty(); ++k) beside[k] -= around[k % width];
  const auto relative = factors.matrix->relativeError(beside, solution.bands);
  if (!relative) return errorByRows(factors, emission, beside, solution.bands);
  std::vector<double> seen(beside.size());
  factors.matrix->product(beside, solution.bands, seen);
  return *relative * normOf(seen, factors.matrix->area());
}

/// Fills in the summary of a scene in which B = 0 for every patch.
void nameDarkness(std::span<const double> by_lights, SolveSummary& summary) {
  const bool sky = std::any_of(by_lights.begin(), by_lights.end(), [](double h) { return h > 0; });
  summary.status = sky ? SolveStatus::converged : SolveStatus::no_light;
  summary.message =
      sky ? "converged: the sky shines in, but no patch emits or reflects, so B = 0; usable"
          : "no light: no patch emits, so everything is dark; usable, but black";
}

/// Errors: InputError if a reflectance is not within 0 and 1, or an emission not finite and >= 0.
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

Solution solveUntimed(const FormFactors& factors, std::span<const double> reflectance,
                      std::span<const double> emission, int bands, const SolveOptions& options,
                      Progress& progress, const PatchNames& names,
                      std::span<const double> by_lights, std::span<const double> around) {
  options.validate();
  checkSizes(factors, reflectance, emission, by_lights, bands, names);
  checkMaterials(reflectance, emission, bands, names);
  requireSolver(options.solver, *factors.matrix);

  Solution solution;
  solution.bands = bands;
  SolveSummary& summary = solution.summary;
  const std::vector<double> source = sourceOf(reflectance, emission, by_lights);
  const BandPlan plan(reflectance, source, bands);
  const System system(*factors.matrix, int(plan.solved().size()), plan.pick(reflectance),
                      plan.pick(source));
  summary.skipped = {
      .black_patches = system.black, .dark_bands = plan.dark(), .equal_bands = plan.repeated()};
  if (plan.solved().empty()) {
    solution.radiosity.assign(emission.size(), 0.0);
    solution.irradiance.assign(emission.size(), 0.0);
    summary.error_bound = 0.0;
    nameDarkness(by_lights, summary);
  } else if (const WhiteRoom room = findWhiteRoom(factors, system); !room.patches.empty()) {
    summary.status = SolveStatus::singular;
    summary.message = fmt::format(
        "singular: in band {} a closed room has reflectance 1 everywhere, so its light is never "
        "absorbed and no solution exists; not usable; give one of its surfaces a reflectance below "
        "1: {}",
        plan.solved()[std::size_t(room.band)], names.list(room.patches));
    return solution;
  } else {
    const Fields fields = solveSystem(system, options, progress, summary);
    solution.radiosity = plan.spread(fields.radiosity);
    solution.irradiance = plan.spread(fields.irradiance);
  }
  if (summary.usable() && factors.seeNothing()) {
    summary.message += fmt::format("; {}", factors.condition());
  }
  if (!factors.matrix->isNonNegative()) raiseFromBelowZero(source, solution);
  const std::span<const double> area = factors.matrix->area();
  const std::optional<double> off = errorOf(factors, emission, solution, around);
  for (std::size_t k = 0; k < by_lights.size(); ++k) solution.irradiance[k] += by_lights[k];
  const double norm = normOf(solution.irradiance, area);
  if (off && norm > 0) {
    summary.irradiance_error = *off / norm;
    if (summary.usable()) {
      summary.message +=
          fmt::format("; irradiance off by about {:.2g}%{}", 100 * *summary.irradiance_error,
                      factors.error.empty() ? "" : " at most");
    }
  }
  summary.energy = energyAccount(factors, reflectance, {emission, by_lights}, solution.radiosity,
                                 solution.irradiance, bands);
  return solution;
}

/// solve() with irradiance by lights without a surface, N * bands, W/m^2, of which that of `around`
/// (errorOf()) is a part.
Solution solveRows(const FormFactors& factors, std::span<const double> reflectance,
                   std::span<const double> emission, int bands, const SolveOptions& options,
                   Progress& progress, const PatchNames& names, std::span<const double> by_lights,
                   std::span<const double> around) {
  const Stopwatch watch;
  Solution solution = solveUntimed(factors, reflectance, emission, bands, options, progress, names,
                                   by_lights, around);
  solution.summary.seconds = watch.seconds();
  return solution;
}

/// Says in the message which lights reach nothing, and how far the others may be off.
/// W/m^2, by band: what comes from where nothing stands, alike all round.
std::vector<double> lightAround(std::span<const Light> lights, int bands) {
  std::vector<double> around(std::size_t(bands), 0.0);
  for (const Light& light : lights) {
    for (std::size_t b = 0; b < around.size(); ++b) around[b] += light.fromAround(b, 1);
  }
  return around;
}

void noteErrorOf(const LightFall& by_lights, SolveSummary& summary) {
  if (!summary.usable()) return;
  for (const std::string& name : by_lights.lost) {
    summary.message +=
        fmt::format("; {} lights nothing: it stands in a body or behind surfaces", name);
  }
  if (!(by_lights.error > 0)) return;
  summary.message +=
      fmt::format("; light of lamps and skies off by about {:.2g}%", 100 * by_lights.error);
}

}  // namespace

void SolveOptions::validate() const { requireRanges(*this); }

Solution solve(const FormFactors& factors, std::span<const double> reflectance,
               std::span<const double> emission, int bands, const SolveOptions& options,
               Progress& progress, std::span<const Index> group,
               std::span<const std::string> group_names, std::span<const double> sky) {
  Solution solution =
      solveRows(factors, reflectance, emission, bands, options, progress, {group, group_names},
                skyIrradiance(factors, sky, bands),
                sky.empty() ? std::vector<double>{}
                            : lightAround(std::array{uniformSky({sky.begin(), sky.end()})}, bands));
  judgeBalance(factors, emission, solution.summary);
  return solution;
}

Solution solve(const FormFactors& factors, const PatchMaterials& materials, const PatchMesh& mesh,
               const SolveOptions& options, Progress& progress) {
  materials.requireSizes(mesh.size());
  const LightFall by_lights =
      LightOnPatches(mesh).all(materials.lights, factors.sky, materials.bands, progress);
  Solution solution =
      solveRows(factors, materials.reflectance, materials.emission, materials.bands, options,
                progress, {mesh.surface, mesh.surface_names}, by_lights.irradiance,
                lightAround(materials.lights, materials.bands));
  noteErrorOf(by_lights, solution.summary);
  judgeBalance(factors, materials.emission, solution.summary);
  return solution;
}

}  // namespace radiosity
