// Pictures of light.
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "arrays.h"
#include "handles.h"
#include "long_call.h"
#include "options.h"

namespace radiosity::python {
namespace {

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

/// A picture and what it was made with.
struct Drawn {
  Image radiance;
  Camera camera;
  RenderOptions options;
};

/// What is drawn: a solution, or radiosities (N, bands) if `light` is null.
struct Subject {
  const MeshHandle& mesh;
  const SolutionHandle* light;
  const Array<double>& radiosity;
};

/// `falling`: the light as it falls on surfaces, of a solution. `parts`: is filled unless it is
/// null.
Drawn drawn(const Subject& of, const py::object& from, const py::dict& given, bool falling,
            PictureParts* parts, const py::object& report) {
  const KeywordOptions take(given);
  Drawn made;
  RenderOptions& options = made.options;
  ElementOptions element_options;
  bool with_elements = of.light != nullptr;
  RenderOptions::describe(take, options);
  take("crease", element_options.crease);
  take("elements", with_elements);
  take("element_tolerance", element_options.tolerance);
  std::optional<Camera> camera = cameraOf(from, of.mesh.scene.get());
  takeSize(take, camera, options);
  options.validate();
  const PatchMesh& patches = of.mesh.result.mesh;
  const auto values = std::size_t(of.radiosity.size());
  const PatchMaterials plain{int(of.radiosity.shape(1)),
                             std::vector<double>(values, 0.0),
                             std::vector<double>(values, 0.0),
                             {}};
  runLong(report, [&](Progress& progress) {
    const PatchMaterials& materials = of.light != nullptr ? *of.light->materials : plain;
    const bool closed = of.light != nullptr && of.light->factors->factors.report.closed;
    SurfaceLight light = surfaceLight(spanOf(of.radiosity), materials);
    if (!camera) {
      camera = framingCamera(patches, closed, double(options.width) / double(options.height),
                             light.reflected);
    }
    made.camera = *camera;
    if (with_elements) {
      addElements(of.mesh, *of.light, *camera, options, element_options, light, progress);
    }
    if (falling) {
      const Solution& solution = of.light->solution;
      light = fallingLight(std::move(light), solution.irradiance, solution.bands);
    }
    made.radiance = renderRadiance(patches, light, *camera, options, progress, parts);
  });
  return made;
}

/// (height, width, channels).
py::array pixels(std::vector<float>&& values, const RenderOptions& size) {
  const auto channels = py::ssize_t(values.size()) / size.width / size.height;
  const std::vector<py::ssize_t> shape{size.height, size.width, channels};
  return taken(std::move(values)).reshape(shape);
}

py::array render(const MeshHandle& mesh, const SolutionHandle* light,
                 const Array<double>& radiosity, const py::object& from, const py::dict& given,
                 const py::object& report) {
  Drawn made = drawn({mesh, light, radiosity}, from, given, false, nullptr, report);
  return pixels(std::move(made.radiance.rgba), made.options);
}

/// The picture and its layers, by name: (height, width, channels), and their units.
py::tuple renderLayers(const MeshHandle& mesh, const SolutionHandle* light,
                       const Array<double>& radiosity, const py::object& from,
                       const py::dict& given, const py::object& report) {
  PictureParts parts;
  Drawn made = drawn({mesh, light, radiosity}, from, given, false, &parts, report);
  py::dict layers;
  for (ImageLayer& layer :
       pictureLayers(mesh.result.mesh, made.camera, made.options, std::move(parts))) {
    layers[layer.name.c_str()] = pixels(std::move(layer.values), made.options);
  }
  return py::make_tuple(pixels(std::move(made.radiance.rgba), made.options), layers);
}

const ShownLight& shownLight(const std::string& word, bool of_solution) {
  std::vector<std::string> names;
  for (const ShownLight& shown : shownLights()) {
    names.emplace_back(shown.name);
    if (word != shown.name) continue;
    if (shown.falling && !of_solution) {
      throw InputError(
          fmt::format("show: {} needs a Solution, which knows what falls on surfaces; "
                      "give what solve() returned",
                      word));
    }
    return shown;
  }
  throw InputError(fmt::format("show: is '{}'; give one of: {}", word, fmt::join(names, ", ")));
}

/// The values of pixels, (height, width), and the picture in false colours with its legend, which
/// is higher. `range`: none: of the values in view.
py::tuple renderShown(const MeshHandle& mesh, const SolutionHandle* light,
                      const Array<double>& radiosity, const py::object& from, const py::dict& given,
                      const std::string& word, const std::optional<std::array<double, 2>>& range,
                      const py::object& report) {
  const ShownLight& shown = shownLight(word, light != nullptr);
  const Drawn made = drawn({mesh, light, radiosity}, from, given, shown.falling, nullptr, report);
  FalseColour legend = legendOf(shown, int(radiosity.shape(1)));
  if (range) {
    legend.low = (*range)[0];
    legend.high = (*range)[1];
  }
  std::vector<double> values;
  Image image;
  runLong(report, [&](Progress& /*progress*/) {
    values = shownValues(made.radiance, shown);
    image = falseColourPicture(mesh.result.mesh, values, legend, made.camera, made.options);
  });
  const std::vector<py::ssize_t> size{made.options.height, made.options.width};
  const std::vector<py::ssize_t> shape{image.height, image.width, 4};
  return py::make_tuple(taken(std::move(values)).reshape(size),
                        taken(std::move(image.rgba)).reshape(shape));
}

double exposure(const py::array_t<float, py::array::c_style>& picture) {
  Image image;
  image.height = int(picture.shape(0));
  image.width = int(picture.shape(1));
  const py::gil_scoped_release unlocked;
  image.rgba.assign(picture.data(), picture.data() + picture.size());
  return autoExposure(image);
}

}  // namespace

void bindPictures(py::module_& module) {
  module.def("render", &render);
  module.def("render_layers", &renderLayers);
  module.def("render_shown", &renderShown);
  module.def("exposure", &exposure);
}

}  // namespace radiosity::python
