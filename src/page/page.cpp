#include "page/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/figure_text.h"
#include "formfactor/light_on_patches.h"
#include "mesh/clusters/cluster_means.h"
#include "page/container.h"
#include "page/eyes.h"
#include "page/factor_codes.h"
#include "page/header.h"
#include "page/html.h"
#include "page/seen.h"
#include "page/surfaces.h"
#include "radiosity/spelling.h"
#include "results/glb.h"

namespace radiosity {

namespace page {

namespace {

std::vector<float> floats(std::span<const double> values) { return {values.begin(), values.end()}; }

std::vector<std::uint32_t> unknownsOf(const PatchMesh& mesh) {
  std::vector<std::uint32_t> unknowns;
  unknowns.reserve(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i)
    unknowns.push_back(std::uint32_t(mesh.unknownOf(i)));
  return unknowns;
}

void addPatches(const PatchMesh& mesh, const PatchColours& colours, const Vec3& origin,
                Container& container) {
  container.add("normal", packed(mesh.normal));
  container.add("centroid", packed(mesh.centroid, origin));
  container.add("area", floats(mesh.area));
  container.add("surface", mesh.surface);
  container.add("side", mesh.side);
  container.add("unknown", unknownsOf(mesh));
  container.add("emission", floats(colours.emission));
  container.add("reflectance", floats(colours.reflectance));
  container.add("irradiance", floats(colours.irradiance));
}

/// Lights without a surface: irradiance of unknowns by each, and what comes from where nothing
/// stands.
void addLights(const PatchMaterials& materials, const PatchMesh& mesh, const FormFactors& factors,
               Progress& progress, Container& container) {
  const int bands = materials.bands;
  Container::Json lights = Container::Json::array();
  LightOnPatches on_patches(mesh);
  for (const Light& light : materials.lights) {
    if (!light.shines()) continue;
    std::vector<double> irradiance =
        on_patches.all({&light, 1}, factors.sky, bands, progress).irradiance;
    if (mesh.clusters) irradiance = clusterMeans(mesh, irradiance, bands);
    container.add("light_" + std::to_string(lights.size()), floats(rgbOf(irradiance, bands)));
    lights.push_back({{"name", light.name},
                      {"kind", light.traits().word},
                      {"single", light.traits().single},
                      {"unit", light.traits().unit},
                      {"strength", rgbOf(light.strength, bands)},
                      {"parameters", light.briefText()},
                      {"radiance", rgbOf(background({&light, 1}, bands), bands)}});
  }
  container.header()["lights"] = lights;
}

void addFactors(const FormFactors& factors, const ExchangeMatrix& matrix, const FactorCodes& codes,
                Container& container) {
  container.add("unknown_area", floats(matrix.area()));
  container.add("order", matrix.order());
  container.add("row_sum", floats(factors.fronts));
  container.add("row_error", floats(factors.error));
  container.add("factor_begin", codes.begin);
  container.add("factor_column", codes.column);
  container.add("factor_code", codes.code);
}

void requireOneEstimate(const std::string& name, const ExchangeMatrix& matrix) {
  if (matrix.isSymmetric()) return;
  throw InputError(
      fmt::format("{}: a page keeps one form factor a pair, and these are two estimates of each; "
                  "compute them with {}, or with {} or rays",
                  name, spelled("symmetrize"), spelled("method", "exact")));
}

}  // namespace

std::vector<std::byte> pageData(Pipeline& pipeline, const SurfaceLight& light,
                                const PageOptions& options, Progress& progress,
                                PageReport& report) {
  const Scene& scene = pipeline.scene();
  const PatchMesh& mesh = pipeline.mesh().mesh;
  requirePageFits(scene.file, mesh);
  const ExchangeMatrix& matrix = pairsOf(pipeline.matrix());
  requireOneEstimate(scene.file, matrix);
  const Solution& solution = pipeline.solution();
  const FormFactors& factors = pipeline.factors();
  const PatchColours colours = patchColours(pipeline.materials(), solution);
  const FactorCodes codes = encodeFactors(matrix, progress);
  const Vec3 origin = floatOrigin(mesh.vertices);
  Container container;
  describeScene(container.header(), scene, mesh, colours, options);
  container.header()["origin"] = {origin.x, origin.y, origin.z};
  describeSolution(container.header(), factors, solution, pipeline.options());
  describe(container.header(), codes.quantisation);
  addSurfaces(mesh, options.crease, origin, container);
  addEyes(mesh, options.crease, origin, container);
  addPatches(mesh, colours, origin, container);
  addLights(pipeline.materials(), mesh, factors, progress, container);
  addFactors(factors, matrix, codes, container);
  addSeenPatches(mesh, progress, container);
  report.element_triangles = addElements(mesh, light, options.crease, origin, container);
  report.pairs = codes.pairs;
  report.quantisation = codes.quantisation;
  std::vector<std::byte> data = container.bytes();
  report.bytes = data.size();
  return data;
}

}  // namespace page

bool canWritePages() { return !page::pageTemplate().empty(); }

void requirePageFits(const std::string& name, const PatchMesh& mesh) {
  if (mesh.unknowns() > kMostPageUnknowns) {
    throw InputError(fmt::format(
        "{}: {} unknowns, and a page holds the form factors of at most {}; use fewer {}, "
        "e.g. {}",
        name, countText(mesh.unknowns()), countText(kMostPageUnknowns), spelled("patches"),
        spelled("patches", "4000")));
  }
  if (mesh.size() > kMostPagePatches) {
    throw InputError(fmt::format(
        "{}: {} patches, and a page holds at most {}; each planar piece is at least one patch: "
        "leave out parts of the scene",
        name, countText(mesh.size()), countText(kMostPagePatches)));
  }
}

PageReport writePage(const std::string& path, Pipeline& pipeline, const SurfaceLight& light,
                     const PageOptions& options, Progress& progress) {
  if (!canWritePages()) {
    throw RunError(path + ": this program was built without node and npm, which make pages");
  }
  PageReport report;
  const std::vector<std::byte> data = page::pageData(pipeline, light, options, progress, report);
  report.packed_bytes = page::writeHtml(path, page::pageTemplate(), data, progress);
  return report;
}

}  // namespace radiosity
