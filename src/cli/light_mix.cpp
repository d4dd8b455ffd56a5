#include "cli/light_mix.h"

#include <fmt/format.h>

#include <memory>

#include "base/parse.h"
#include "cli/show.h"
#include "cli/summaries.h"

namespace radiosity::cli {

namespace {

/// Parses "NAME=WEIGHT,NAME=WEIGHT". The last = of each part counts, so that names may have one.
std::vector<LightWeight> parseMix(const std::string& text) {
  std::vector<LightWeight> weights;
  for (const std::string_view part : splitAt(text, ',')) {
    const std::size_t equals = part.rfind('=');
    const std::optional<double> factor =
        equals == std::string_view::npos ? std::nullopt : parseNumber(part.substr(equals + 1));
    if (!factor || equals == 0) {
      throw InputError(fmt::format("--mix: '{}' is not NAME=WEIGHT, e.g. lamp=0.5", part));
    }
    weights.push_back({std::string(part.substr(0, equals)), *factor});
  }
  return weights;
}

/// The given option that changes the light of the scene; empty if there is none.
std::string overrideOf(const SceneOptions& scene) {
  if (!scene.set.empty()) return "--set";
  if (!scene.materials_file.empty()) return "--materials";
  return scene.lights.empty() ? "" : scene.lights.front().option();
}

[[noreturn]] void failWithoutBasis(const Request& request) {
  throw InputError(
      fmt::format("--mix: {} has no light of single lamps that fits these options; "
                  "make it: radiosity solve {} --basis surfaces -o FILE.h5",
                  request.input, request.input));
}

}  // namespace

void checkMix(const Request& request, const OutputSet& files) {
  if (request.mix.empty()) return;
  parseMix(request.mix);
  if (request.basis.empty()) {
    const std::string given = overrideOf(request.scene);
    if (!given.empty()) {
      throw InputError(
          fmt::format("--mix: mixes light as it was solved for, and {} changes what is "
                      "solved; leave it out, or add --basis surfaces to solve again",
                      given));
    }
  }
  if (parseShow(request.show).quantity) {
    throw InputError("--mix: --show draws what patches of the file have; leave one of the two out");
  }
  const Format shown[] = {Format::glb, Format::light_csv, Format::vtp,
                          Format::png, Format::exr,       Format::hdr};
  for (const Format format : shown) {
    if (files.has(format)) return;
  }
  throw InputError(
      "--mix: a mixture goes to a file of its own, not into a results file; name one with -o "
      "light.csv, lit.glb or light.vtp, or draw it with render");
}

void chooseSources(const Request& request, Pipeline& pipeline) {
  if (request.basis.empty()) {
    if (!request.mix.empty() && !pipeline.stored().basis) failWithoutBasis(request);
    return;
  }
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const PatchMaterials& materials = pipeline.materials();
  std::vector<LightSource>& sources = pipeline.options().sources;
  if (request.basis != kBasisOfSurfaces) {
    sources = readLightSources(request.basis, pipeline.scene(), mesh, materials.bands);
    return;
  }
  sources = lightSources(materials, mesh);
  if (sources.empty()) {
    throw InputError(
        "--basis surfaces: no surface emits light; make one a lamp with --set, or name "
        "a table of sets, --basis FILE.csv");
  }
}

std::optional<MixedLight> mixOf(Session& session, Pipeline& pipeline) {
  const Request& request = session.request;
  if (request.mix.empty()) return std::nullopt;
  const LightBasis* basis = request.basis.empty() ? pipeline.basisAtHand() : &pipeline.basis();
  if (basis == nullptr) failWithoutBasis(request);
  MixedLight mix = mixLight(*basis, parseMix(request.mix));
  session.report.section("mix", "Mixed light");
  session.report.text("message", "in words", mix.solution.summary.message);
  session.report.bands("emitted_W", "emitted", mix.solution.summary.energy.emitted, "W");
  if (mix.solution.summary.error_bound) {
    session.report.number("error_bound_W_per_m2", "|B - B*| is at most",
                          *mix.solution.summary.error_bound, "W/m^2");
  }
  return mix;
}

SurfaceLight mixedSurfaces(Session& session, Pipeline& pipeline, const MixedLight& mix,
                           bool elements, std::span<const std::uint8_t> wanted) {
  SurfaceLight light = surfaceLight(mix.solution.radiosity, mix.materials);
  if (!elements) return light;
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const ElementOptions& options = pipeline.options().elements;
  const std::vector<double>& irradiance = mix.solution.irradiance;
  light.reflectance = mix.materials.reflectance;
  light.emission = mix.materials.emission;
  light.materials = pipeline.pointMaterials(wanted);
  if (session.request.final_gather) {
    light.points = std::make_shared<const LightAtPoints>(mesh, mix.materials, irradiance, options,
                                                         wanted, session.progress);
    return light;
  }
  light.elements = std::make_shared<const Elements>(
      computeElements(mesh, mix.materials, irradiance, options, wanted, session.progress));
  summarizeElements(session.report, *light.elements, pipeline.factors());
  return light;
}

}  // namespace radiosity::cli
