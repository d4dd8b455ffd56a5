#include "page/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/figure_text.h"
#include "page/container.h"
#include "page/elements.h"
#include "page/eyes.h"
#include "page/factor_codes.h"
#include "page/header.h"
#include "page/heat.h"
#include "page/html.h"
#include "page/lamps.h"
#include "page/nodes.h"
#include "page/surfaces.h"
#include "page/textures.h"
#include "radiosity/spelling.h"
#include "results/glb.h"

namespace radiosity {

namespace page {

namespace {

void addPatches(const PatchMesh& mesh, const PatchColours& colours, const Vec3& origin,
                Container& container) {
  container.add("normal", packed(mesh.normal));
  container.add("centroid", packed(mesh.centroid, origin));
  container.add("area", floats(mesh.area));
  container.add("surface", mesh.surface);
  container.add("side", mesh.side);
  container.add("emission", floats(colours.emission));
  container.add("reflectance", floats(colours.reflectance));
  container.add("irradiance", floats(colours.irradiance));
}

void addFactors(const PageNodes& nodes, const FactorCodes& codes, Container& container) {
  container.header()["nodes"] = nodes.size();
  container.add("node", nodes.of_patch);
  container.add("node_area", floats(nodes.matrix->area()));
  container.add("order", nodes.matrix->order());
  container.add("row_sum", floats(nodes.fronts));
  container.add("row_error", floats(nodes.error));
  container.add("factor_begin", codes.begin);
  container.add("factor_column", codes.column);
  container.add("factor_code", codes.code);
}

}  // namespace

std::vector<std::byte> pageData(Pipeline& pipeline, const SurfaceLight& light,
                                const PageOptions& options, Progress& progress,
                                PageReport& report) {
  const Scene& scene = pipeline.scene();
  const PatchMesh& mesh = pipeline.mesh().mesh;
  requirePageFits(scene.file, mesh);
  const ExchangeOperator& matrix = pipeline.matrix();
  const FormFactors& factors = pipeline.factors();
  const PageNodes nodes = pageNodes(scene.file, mesh, factors, progress);
  const Solution& solution = pipeline.solution();
  const PatchColours colours = patchColours(pipeline.materials(), solution);
  const FactorCodes codes = encodeFactors(*nodes.matrix, progress);
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
  addFactors(nodes, codes, container);
  if (!nodes.arePatches() || light.elements)
    addEmitted(scene, mesh, pipeline.materials(), matrix, container);
  report.element_triangles =
      addElements(pipeline, light, options.crease, origin, progress, container);
  if (light.elements) addTextures(scene, mesh, container, report);
  if (options.heat) addHeat(pipeline, container);
  report.nodes = nodes.arePatches() ? 0 : nodes.size();
  report.pairs = codes.pairs;
  report.quantisation = codes.quantisation;
  std::vector<std::byte> data = container.bytes();
  report.bytes = data.size();
  return data;
}

}  // namespace page

bool canWritePages() { return !page::pageTemplate().empty(); }

void requirePageFits(const std::string& name, const PatchMesh& mesh) {
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
