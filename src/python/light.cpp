// Light and heat on form factors, and pictures of light.
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "arrays.h"
#include "handles.h"
#include "long_call.h"
#include "options.h"
#include "reports.h"

namespace radiosity::python {
namespace {

/// Up to this number of rows and bands the longest step of a solve, the direct solver's
/// factorizations of the matrix, takes about half a second.
constexpr std::size_t kShortStepRows = 1200;
constexpr int kShortStepBands = 3;

bool hasShortSteps(const FactorsHandle& of, int bands) {
  return bands <= kShortStepBands && of.factors.matrix->size() <= kShortStepRows;
}

/// Reflectance and emission, (rows, bands), and the sky's radiance or None: the lights of the
/// scene. A row is a patch of the mesh or a row of the matrix.
using GivenMaterials = std::tuple<Array<double>, Array<double>, std::optional<std::vector<double>>>;

/// `given_materials`: empty: those of the scene, which the mesh has.
std::shared_ptr<SolutionHandle> solveLight(std::shared_ptr<FactorsHandle> factors,
                                           const std::optional<GivenMaterials>& given_materials,
                                           const py::dict& given, const py::object& report) {
  const auto options = optionsFrom<SolveOptions>(given);
  auto handle = std::make_shared<SolutionHandle>();
  handle->factors = std::move(factors);
  const FactorsHandle& of = *handle->factors;
  if (given_materials) {
    const auto& [reflectance, emission, sky] = *given_materials;
    handle->materials = std::make_shared<const PatchMaterials>(
        PatchMaterials{int(emission.shape(1)), vectorOf(reflectance), vectorOf(emission),
                       lightsOf(sky, of.mesh.get())});
  } else {
    handle->materials = {of.mesh, &of.mesh->materials};
  }
  const PatchMaterials& materials = *handle->materials;
  (hasShortSteps(of, materials.bands) ? runShortSteps : runLong)(report, [&](Progress& progress) {
    if (!of.mesh) {
      handle->solution =
          solve(of.factors, materials.reflectance, materials.emission, materials.bands, options,
                progress, {}, {}, background(materials.lights, materials.bands));
      return;
    }
    handle->solution = solve(of.factors, materials, of.mesh->result.mesh, options, progress);
  });
  handle->key = [options, self = handle.get()] {
    const FactorsHandle& made_of = *self->factors;
    return keyOfSolution(options, *self->materials, made_of.key(),
                         nameOf(kFactorsFromNames, made_of.factors.method));
  };
  return handle;
}

/// The names of the rows of a matrix from elsewhere, empty for a row without one.
std::vector<std::string> rowNames(const FactorsHandle& factors) {
  std::vector<std::string> names = factors.names;
  names.resize(factors.factors.matrix->size());
  return names;
}

/// Of surfaces, or of the rows of a matrix from elsewhere.
HeatConditions conditionsOf(const FactorsHandle& factors, const ConditionText& text) {
  if (!factors.mesh) return readHeatConditions(rowNames(factors), {}, text);
  if (!factors.mesh->scene) {
    throw InputError("heat: the results file has no scene, whose surfaces have names");
  }
  return readHeatConditions(*factors.mesh->scene, text);
}

/// `settings`, `groups`: see ConditionText.
std::shared_ptr<HeatHandle> heat(std::shared_ptr<FactorsHandle> factors,
                                 const std::string& table_path,
                                 const std::vector<std::string>& settings,
                                 const std::vector<std::string>& groups, const py::dict& given,
                                 const py::object& report) {
  const HeatOptions options = optionsFrom<HeatOptions>(given);
  auto handle = std::make_shared<HeatHandle>();
  handle->factors = std::move(factors);
  const FactorsHandle& of = *handle->factors;
  const HeatConditions conditions =
      conditionsOf(of, readConditionText(table_path, settings, groups));
  validate(conditions, options);
  handle->notes = conditions.notes;
  runLong(report, [&](Progress& progress) {
    handle->solution =
        of.mesh ? solveHeat(of.factors, conditions, of.mesh->result.mesh, options, progress)
                : solveHeat(of.factors, {conditions.conditions, conditions.of_surface, {}}, options,
                            progress);
  });
  handle->solution.conditions = conditions.text;
  if (!of.mesh) return handle;
  handle->key = [options, conditions, self = handle.get()] {
    const FactorsHandle& made_of = *self->factors;
    return keyOfHeat(options, conditions, made_of.key(),
                     nameOf(kFactorsFromNames, made_of.factors.method));
  };
  return handle;
}

/// Conditions row by row; NaN: not given.
std::shared_ptr<HeatHandle> heatOfRows(std::shared_ptr<FactorsHandle> factors,
                                       const Array<double>& emissivity,
                                       const Array<double>& temperature, const Array<double>& flux,
                                       const py::dict& given, const py::object& report) {
  const HeatOptions options = optionsFrom<HeatOptions>(given);
  auto handle = std::make_shared<HeatHandle>();
  handle->factors = std::move(factors);
  const FactorsHandle& of = *handle->factors;
  const std::size_t rows = of.factors.matrix->size();
  std::vector<HeatCondition> conditions(rows);
  std::vector<Index> of_row(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    HeatCondition& condition = conditions[i];
    of_row[i] = Index(i);
    condition.name = of.names.empty() ? fmt::format("row {}", i) : of.names[i];
    condition.emissivity = {{{}, {emissivity.data()[i]}}};
    if (!std::isnan(temperature.data()[i])) condition.temperature = temperature.data()[i];
    if (!std::isnan(flux.data()[i])) condition.flux = flux.data()[i];
  }
  runLong(report, [&](Progress& progress) {
    handle->solution = solveHeat(of.factors, {conditions, of_row, {}}, options, progress);
  });
  return handle;
}

py::list heatTable(const HeatHandle& heat) {
  const FactorsHandle& of = *heat.factors;
  py::list list;
  for (const SurfaceHeat& surface :
       of.mesh ? heatBySurface(heat.solution, of.mesh->result.mesh, of.factors)
               : heatByName(heat.solution, rowNames(of), of.factors)) {
    list.append(dictOf(surface));
  }
  return list;
}

py::dict cameraProperties(const py::object& given) {
  constexpr std::array kKnown = {"name", "eye", "target", "up", "aspect", "vertical_fov"};
  if (!py::isinstance<py::dict>(given)) refuse("camera", given, "a name, a text or a dict");
  auto properties = given.cast<py::dict>();
  for (const auto& [name, value] : properties) {
    const std::string word = py::str(name);
    if (std::ranges::find(kKnown, word) == kKnown.end()) {
      throw InputError(fmt::format("camera: has no property '{}'; there are: {} (radians)", word,
                                   fmt::join(kKnown, ", ")));
    }
  }
  return properties;
}

/// Makes a camera from a dictionary like those of Scene.cameras, from a text, or from the name of
/// one in the scene. Empty for None in a scene without cameras.
std::optional<Camera> cameraOf(const py::object& given, const Scene* scene) {
  if (given.is_none()) {
    if (scene == nullptr || scene->cameras.empty()) return std::nullopt;
    return scene->cameras.front();
  }
  if (py::isinstance<py::str>(given)) {
    const auto text = given.cast<std::string>();
    for (const Camera& camera : scene != nullptr ? scene->cameras : std::vector<Camera>()) {
      if (camera.name == text) return camera;
    }
    return parseCamera(text);
  }
  const KeywordOptions take(cameraProperties(given), "camera");
  Camera camera;
  Triple eye{}, target{}, up{camera.up.x, camera.up.y, camera.up.z};
  if (!take.has("eye") || !take.has("target")) {
    throw InputError(
        "camera: has no eye or no target; give {'eye': (x, y, z), 'target': (x, y, z)}");
  }
  take("name", camera.name);
  take("eye", eye);
  take("target", target);
  take("up", up);
  take("vertical_fov", camera.vertical_fov);
  take("aspect", camera.aspect);
  camera.eye = vec(eye);
  camera.target = vec(target);
  camera.up = vec(up);
  return camera;
}

int otherSide(double pixels) { return std::max(1, int(std::lround(pixels))); }

/// Sets the size of the picture; a side that is not given follows from the camera.
void takeSize(const KeywordOptions& take, const std::optional<Camera>& camera,
              RenderOptions& options) {
  take("width", options.width);
  take("height", options.height);
  const double aspect = camera && camera->aspect > 0 ? camera->aspect : 1;
  if (!take.has("height")) options.height = otherSide(options.width / aspect);
  if (!take.has("width") && take.has("height")) options.width = otherSide(options.height * aspect);
}

/// Adds elements of the visible surfaces, like the command line; of a scene's own materials also
/// their textures.
void addElements(const MeshHandle& handle, const SolutionHandle& light, const Camera& camera,
                 const RenderOptions& options, const ElementOptions& elements, SurfaceLight& drawn,
                 Progress& progress) {
  const PatchMesh& mesh = handle.result.mesh;
  const std::vector<std::uint8_t> wanted = visiblePatches(mesh, camera, options, progress);
  drawn.elements = std::make_shared<const Elements>(computeElements(
      mesh, *light.materials, light.solution.irradiance, elements, wanted, progress));
  drawn.reflectance = light.materials->reflectance;
  drawn.emission = light.materials->emission;
  if (handle.scene && light.materials.get() == &handle.materials) {
    drawn.materials = pointMaterials(*handle.scene, mesh, handle.materials, wanted);
  }
}

/// The picture of a solution, or of radiosities (N, bands) if `light` is null.
py::array render(const MeshHandle& mesh, const SolutionHandle* light,
                 const Array<double>& radiosity, const py::object& from, const py::dict& given,
                 const py::object& report) {
  const KeywordOptions take(given);
  RenderOptions options;
  ElementOptions element_options;
  bool with_elements = light != nullptr;
  RenderOptions::describe(take, options);
  take("crease", element_options.crease);
  take("elements", with_elements);
  take("element_tolerance", element_options.tolerance);
  std::optional<Camera> camera = cameraOf(from, mesh.scene.get());
  takeSize(take, camera, options);
  options.validate();
  const PatchMesh& patches = mesh.result.mesh;
  const PatchMaterials plain{int(radiosity.shape(1)),
                             std::vector<double>(std::size_t(radiosity.size()), 0.0),
                             std::vector<double>(std::size_t(radiosity.size()), 0.0),
                             {}};
  Image image;
  runLong(report, [&](Progress& progress) {
    const PatchMaterials& materials = light != nullptr ? *light->materials : plain;
    const bool closed = light != nullptr && light->factors->factors.report.closed;
    SurfaceLight drawn = surfaceLight(spanOf(radiosity), materials);
    if (!camera) {
      camera = framingCamera(patches, closed, double(options.width) / double(options.height),
                             drawn.reflected);
    }
    if (with_elements) {
      addElements(mesh, *light, *camera, options, element_options, drawn, progress);
    }
    image = renderRadiance(patches, drawn, *camera, options, progress);
  });
  const std::vector<py::ssize_t> shape{image.height, image.width, 4};
  return taken(std::move(image.rgba)).reshape(shape);
}

double exposure(const py::array_t<float, py::array::c_style>& picture) {
  Image image;
  image.height = int(picture.shape(0));
  image.width = int(picture.shape(1));
  const py::gil_scoped_release unlocked;
  image.rgba.assign(picture.data(), picture.data() + picture.size());
  return autoExposure(image);
}

template <class Handle>
auto valuesOf(std::vector<double> HeatSolution::*field) {
  return [field](const py::object& self) {
    return view(self.cast<const Handle&>().solution.*field, self);
  };
}

}  // namespace

void bindLight(py::module_& module) {
  using S = SolutionHandle;
  py::class_<S, std::shared_ptr<S>> solution(module, "Solution");
  const auto light_rows = [&](const char* name, auto get) {
    solution.def_property_readonly(name, [get](const py::object& self) {
      const S& s = self.cast<const S&>();
      return rows(get(s), s.solution.bands, self);
    });
  };
  light_rows("radiosity", [](const S& s) -> const auto& { return s.solution.radiosity; });
  light_rows("irradiance", [](const S& s) -> const auto& { return s.solution.irradiance; });
  light_rows("reflectance", [](const S& s) -> const auto& { return s.materials->reflectance; });
  light_rows("emission", [](const S& s) -> const auto& { return s.materials->emission; });
  solution.def_property_readonly("summary", [](const S& s) { return dictOf(s.solution.summary); });
  solution.def_property_readonly("usable", [](const S& s) { return s.solution.summary.usable(); });
  solution.def_property_readonly(
      "form_factors", [](const S& s) { return std::const_pointer_cast<FactorsHandle>(s.factors); });

  using H = HeatHandle;
  py::class_<H, std::shared_ptr<H>> type(module, "Heat");
  type.def_property_readonly("temperature", valuesOf<H>(&HeatSolution::temperature));
  type.def_property_readonly("net_flux", valuesOf<H>(&HeatSolution::net_flux));
  type.def_property_readonly("convection", valuesOf<H>(&HeatSolution::convection));
  type.def_property_readonly("radiosity", [](const py::object& self) {
    const HeatSolution& heat = self.cast<const H&>().solution;
    return rows(heat.radiosity, heat.bands, self);
  });
  type.def_property_readonly("irradiance", [](const py::object& self) {
    const HeatSolution& heat = self.cast<const H&>().solution;
    return rows(heat.irradiance, heat.bands, self);
  });
  type.def_property_readonly("summary", [](const H& h) {
    py::dict summary = dictOf(h.solution.summary);
    summary["notes"] = listOf(h.notes);
    return summary;
  });
  type.def_property_readonly(
      "form_factors", [](const H& h) { return std::const_pointer_cast<FactorsHandle>(h.factors); });

  module.def("solve", &solveLight);
  module.def("heat", &heat);
  module.def("heat_of_rows", &heatOfRows);
  module.def("heat_table", &heatTable);
  module.def("render", &render);
  module.def("exposure", &exposure);
}

}  // namespace radiosity::python
