#include "page/header.h"

#include <algorithm>
#include <numbers>

#include "base/geometry/box.h"
#include "radiosity/names.h"
#include "radiosity/version.h"

namespace radiosity::page {

namespace {

using Json = Container::Json;

Json json(const Vec3& v) { return {v.x, v.y, v.z}; }

Vec3 at(const std::vector<double>& values, std::size_t patch) {
  return {values[3 * patch], values[3 * patch + 1], values[3 * patch + 2]};
}

/// Sums over the patches of one material.
struct MaterialSums {
  bool has_patches = false;
  double area = 0;
  MaterialColours first;
  Vec3 reflectance{0.0};  ///< times area
  Vec3 emission{0.0};
};

Json surfacesOf(const Scene& scene) {
  Json surfaces = Json::array();
  for (const Surface& surface : scene.surfaces) {
    surfaces.push_back({{"name", surface.name}, {"material", surface.material}});
  }
  return surfaces;
}

Json materialsOf(const Scene& scene, const std::vector<MaterialColours>& colours) {
  Json materials = Json::array();
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    materials.push_back({{"name", scene.materials[m].name},
                         {"reflectance", json(colours[m].reflectance)},
                         {"emission", json(colours[m].emission)},
                         {"textured", colours[m].textured},
                         {"factor", json(scene.materials[m].reflectance)},
                         {"emission_factor", json(scene.materials[m].emission)}});
  }
  return materials;
}

/// The tolerance of the method; null if it has none.
Json toleranceOf(const FormFactors& factors, const FormFactorOptions& options) {
  if (!(traitsOf(factors.method).tolerance > 0)) return nullptr;
  return factors.report.rays.loosened_tolerance.value_or(options.toleranceOf(factors.method));
}

}  // namespace

std::vector<float> floats(std::span<const double> values) { return {values.begin(), values.end()}; }

PatchColours patchColours(const PatchMaterials& materials, const Solution& solution) {
  return {rgbOf(materials.reflectance, materials.bands), rgbOf(materials.emission, materials.bands),
          rgbOf(solution.irradiance, solution.bands)};
}

std::vector<MaterialColours> materialColours(const Scene& scene, const PatchMesh& mesh,
                                             const PatchColours& patches) {
  std::vector<MaterialColours> colours;
  colours.reserve(scene.materials.size());
  for (const Material& m : scene.materials) colours.push_back({m.reflectance, m.emission, false});
  std::vector<MaterialSums> sums(colours.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Index m = scene.surfaces[mesh.surface[i]].material;
    const MaterialColours own{at(patches.reflectance, i), at(patches.emission, i), false};
    MaterialSums& sum = sums[m];
    if (!sum.has_patches) sum.first = own;
    sum.has_patches = true;
    colours[m].textured |=
        own.reflectance != sum.first.reflectance || own.emission != sum.first.emission;
    sum.area += mesh.area[i];
    sum.reflectance += mesh.area[i] * own.reflectance;
    sum.emission += mesh.area[i] * own.emission;
  }
  for (std::size_t m = 0; m < colours.size(); ++m) {
    const MaterialSums& sum = sums[m];
    if (!sum.has_patches) continue;
    const bool mean = colours[m].textured && sum.area > 0;
    colours[m].reflectance = mean ? sum.reflectance / sum.area : sum.first.reflectance;
    colours[m].emission = mean ? sum.emission / sum.area : sum.first.emission;
  }
  return colours;
}

void describeScene(Json& header, const Scene& scene, const PatchMesh& mesh,
                   const PatchColours& patches, const PageOptions& options) {
  header["title"] = options.title;
  header["arguments"] = options.arguments;
  header["program"] = "radiosity " RADIOSITY_VERSION;
  header["patches"] = mesh.size();
  header["exposure"] = options.exposure;
  const Camera& camera = options.camera;
  header["camera"] = {{"eye", json(camera.eye)},
                      {"target", json(camera.target)},
                      {"up", json(camera.up)},
                      {"fov", camera.vertical_fov * 180 / std::numbers::pi}};
  header["diagonal"] = boxOf(mesh.vertices).diagonal();
  header["surfaces"] = surfacesOf(scene);
  header["materials"] = materialsOf(scene, materialColours(scene, mesh, patches));
}

void describeSolution(Json& header, const FormFactors& factors, const Solution& solution,
                      const PipelineOptions& options) {
  header["bands"] = solution.bands;
  header["method"] = nameOf(kFactorsFromNames, factors.method);
  header["tolerance"] = toleranceOf(factors, options.factors);
  header["closed"] = factors.report.closed;
  const SolveSummary& summary = solution.summary;
  const Solver ran = summary.solver == Solver::automatic ? options.solve.solver : summary.solver;
  header["solver"] = {
      {"name", nameOf(kSolverNames, ran)},    {"status", nameOf(kSolveStatusNames, summary.status)},
      {"iterations", summary.iterations},     {"residual", summary.residual},
      {"tolerance", options.solve.tolerance}, {"history", summary.residual_history}};
}

void describe(Json& header, const FactorQuantisation& quantisation) {
  header["quantisation"] = {{"lowest", quantisation.lowest},
                            {"step", quantisation.step},
                            {"largest_relative_error", quantisation.largest_relative_error},
                            {"largest_row_error", quantisation.largest_row_error},
                            {"left_out", quantisation.left_out}};
}

}  // namespace radiosity::page
