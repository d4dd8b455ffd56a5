#include "radiosity/light_basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace radiosity {

namespace {

bool anyAbove0(std::span<const double> values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return value > 0; });
}

void checkSources(const PatchMaterials& materials, std::span<const LightSource> sources) {
  if (sources.empty()) throw InputError("light sources: there is none; make a surface a lamp");
  std::set<std::string> names;
  for (const LightSource& source : sources) {
    if (!names.insert(source.name).second) {
      throw InputError(fmt::format("light sources: two are called '{}'", source.name));
    }
    const bool fits = std::ranges::all_of(source.lights, [&](const Light& light) {
      return light.strength.size() == std::size_t(materials.bands);
    });
    if (!fits || source.emission.size() != materials.reflectance.size()) {
      throw InputError(fmt::format("light source '{}': {} emissions where {} are needed",
                                   source.name, source.emission.size(),
                                   materials.reflectance.size()));
    }
  }
}

/// The light of that name and kind, which is there afterwards: dark if it was not.
Light& findOrAdd(std::vector<Light>& lights, const Light& like, std::size_t bands) {
  const auto same = std::ranges::find_if(lights, [&](const Light& light) {
    return light.name == like.name && light.kind == like.kind;
  });
  if (same != lights.end()) return *same;
  return lights.emplace_back(like.name, like.kind, std::vector<double>(bands, 0.0),
                             like.photometric);
}

/// Materials with the bands of every source side by side.
PatchMaterials sideBySide(const PatchMaterials& materials, std::span<const LightSource> sources) {
  const auto bands = std::size_t(materials.bands);
  const std::size_t n = materials.reflectance.size() / bands;
  PatchMaterials wide;
  wide.bands = int(bands * sources.size());
  wide.reflectance.reserve(n * bands * sources.size());
  wide.emission.reserve(n * bands * sources.size());
  for (std::size_t i = 0; i < n; ++i) {
    for (const LightSource& source : sources) {
      for (std::size_t b = 0; b < bands; ++b) {
        wide.reflectance.push_back(materials.reflectance[i * bands + b]);
        wide.emission.push_back(source.emission[i * bands + b]);
      }
    }
  }
  for (std::size_t s = 0; s < sources.size(); ++s) {
    for (const Light& light : sources[s].lights) {
      if (!light.shines()) continue;
      Light& of_all = findOrAdd(wide.lights, light, bands * sources.size());
      std::ranges::copy(light.strength, of_all.strength.begin() + std::ptrdiff_t(s * bands));
    }
  }
  return wide;
}

/// A factor for each source of the basis.
std::vector<double> factorsOf(const LightBasis& basis, std::span<const LightWeight> weights) {
  std::vector<double> factors(basis.names.size(), 0.0);
  std::set<std::string> given;
  for (const LightWeight& weight : weights) {
    const auto at = std::find(basis.names.begin(), basis.names.end(), weight.name);
    if (at == basis.names.end()) {
      throw InputError(fmt::format("mix: there is no light '{}'; there are {}", weight.name,
                                   fmt::join(basis.names, ", ")));
    }
    if (!given.insert(weight.name).second) {
      throw InputError(fmt::format("mix: the light '{}' is given twice", weight.name));
    }
    if (!(weight.factor >= 0) || !std::isfinite(weight.factor)) {
      throw InputError(fmt::format("mix: {} times the light '{}' is not a finite factor >= 0",
                                   weight.factor, weight.name));
    }
    factors[std::size_t(at - basis.names.begin())] = weight.factor;
  }
  return factors;
}

/// Rows of S * bands values, mixed to rows of bands.
std::vector<double> mixed(std::span<const double> wide, std::span<const double> factors,
                          std::size_t bands) {
  const std::size_t width = factors.size() * bands;
  std::vector<double> out(wide.size() / width * bands, 0.0);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double* row = wide.data() + k / bands * width + k % bands;
    for (std::size_t s = 0; s < factors.size(); ++s) out[k] += factors[s] * row[s * bands];
  }
  return out;
}

std::string mixMessage(const LightBasis& basis, std::span<const double> factors) {
  std::string text;
  for (std::size_t s = 0; s < factors.size(); ++s) {
    if (factors[s] == 0) continue;
    text += fmt::format("{}{:g} x {}", text.empty() ? "" : " + ", factors[s], basis.names[s]);
  }
  return text.empty() ? "no light: every source is off; usable, but black" : "mixed: " + text;
}

}  // namespace

std::vector<LightSource> lightSources(const PatchMaterials& materials, const PatchMesh& mesh) {
  materials.requireSizes(mesh.size());
  const auto bands = std::size_t(materials.bands);
  std::vector<LightSource> sources;
  for (std::size_t s = 0; s < mesh.surface_names.size(); ++s) {
    LightSource source{mesh.surface_names[s], std::vector<double>(materials.emission.size()), {}};
    for (std::size_t k = 0; k < source.emission.size(); ++k) {
      if (mesh.surface[k / bands] == s) source.emission[k] = materials.emission[k];
    }
    if (anyAbove0(source.emission)) sources.push_back(std::move(source));
  }
  for (const Light& light : materials.lights) {
    if (!light.shines()) continue;
    const bool taken = std::ranges::find(sources, light.name, &LightSource::name) != sources.end();
    sources.push_back({taken ? light.name + " (light)" : light.name,
                       std::vector<double>(materials.emission.size()),
                       {light}});
  }
  return sources;
}

LightBasis solveBasis(const FormFactors& factors, const PatchMaterials& materials,
                      const PatchMesh& mesh, std::span<const LightSource> sources,
                      const SolveOptions& options, Progress& progress) {
  materials.requireSizes(mesh.size());
  checkSources(materials, sources);
  LightBasis basis;
  basis.bands = materials.bands;
  for (const LightSource& source : sources) basis.names.push_back(source.name);
  basis.materials = sideBySide(materials, sources);
  basis.solution = solve(factors, basis.materials, mesh, options, progress);
  return basis;
}

MixedLight mixLight(const LightBasis& basis, std::span<const LightWeight> weights) {
  const std::vector<double> factors = factorsOf(basis, weights);
  const auto bands = std::size_t(basis.bands);
  std::vector<double> first(factors.size(), 0.0);
  if (!first.empty()) first[0] = 1;
  const auto mix = [&](const std::vector<double>& wide) { return mixed(wide, factors, bands); };
  MixedLight light;
  light.materials.bands = basis.bands;
  light.materials.reflectance = mixed(basis.materials.reflectance, first, bands);
  light.materials.emission = mix(basis.materials.emission);
  for (const Light& wide : basis.materials.lights) {
    light.materials.lights.push_back({wide.name, wide.kind, mix(wide.strength)});
  }
  light.solution.bands = basis.bands;
  light.solution.radiosity = mix(basis.solution.radiosity);
  light.solution.irradiance = mix(basis.solution.irradiance);
  const SolveSummary& solved = basis.solution.summary;
  SolveSummary& summary = light.solution.summary;
  summary.status = solved.status;
  summary.solver = solved.solver;
  summary.residual = solved.residual;
  if (solved.error_bound) {
    double sum = 0;
    for (const double factor : factors) sum += factor;
    summary.error_bound = sum * *solved.error_bound;
  }
  const EnergyAccount& energy = solved.energy;
  summary.energy = {mix(energy.emitted), mix(energy.from_sky), mix(energy.absorbed),
                    mix(energy.to_sky),  mix(energy.on_backs), mix(energy.imbalance)};
  summary.message = mixMessage(basis, factors);
  return light;
}

}  // namespace radiosity
