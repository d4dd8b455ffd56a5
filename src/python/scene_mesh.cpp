// Scenes and meshes.
#include <pybind11/stl.h>

#include "arrays.h"
#include "handles.h"
#include "long_call.h"
#include "options.h"
#include "radiosity/volume_skin.h"
#include "reports.h"

namespace radiosity::python {
namespace {

/// A kind, and the light as lightOf() takes it.
using LightText = std::pair<std::string, std::string>;

std::shared_ptr<Scene> load(const std::string& path, const py::dict& given) {
  SceneOptions options;
  const KeywordOptions take(given);
  SceneOptions::describe(take, options);
  SceneOverrides::describe(take, options);
  std::vector<LightText> lights;
  take("lights", lights);
  for (const auto& [word, text] : lights) addLight(options.lights, lightOf(word, text));
  auto scene = std::make_shared<Scene>();
  runWithoutSteps([scene, path, options] { *scene = loadScene(path, options); });
  return scene;
}

std::shared_ptr<Scene> sceneOfArrays(const Array<double>& vertices, const Array<Index>& corners,
                                     const Array<std::uint64_t>& offset,
                                     const Array<Index>& surface, const py::list& materials,
                                     const std::vector<LightText>& lights) {
  auto scene = std::make_shared<Scene>();
  scene->file = "arrays";
  const auto places = vectorsOf(vertices);
  scene->vertices.assign(places.begin(), places.end());
  scene->corners = vectorOf(corners);
  scene->face_offset = {offset.data(), offset.data() + offset.size()};
  scene->face_surface = vectorOf(surface);
  scene->face_element.resize(scene->face_surface.size());
  for (std::size_t f = 0; f < scene->face_element.size(); ++f) scene->face_element[f] = f;
  for (const py::handle& entry : materials) {
    const auto [name, reflectance, emission, two_sided] =
        entry.cast<std::tuple<std::string, Triple, Triple, bool>>();
    Material material;
    material.name = name;
    material.reflectance = vec(reflectance);
    material.emission = vec(emission);
    material.two_sided = two_sided;
    scene->surfaces.push_back({name, Index(scene->materials.size()), name});
    scene->materials.push_back(material);
  }
  for (const auto& [word, text] : lights) {
    Light light = lightOf(word, text);
    light.settle(scene->up);
    addLight(scene->lights, std::move(light));
  }
  settleSkies(scene->lights, scene->up);
  {
    const py::gil_scoped_release unlocked;
    validate(*scene);
  }
  return scene;
}

/// The skin of volumes given as `corners` from each `offset` on: its faces in the layout of scenes,
/// and the volume of each.
py::tuple volumeSkin(const Array<double>& vertices, const Array<Index>& corners,
                     const Array<std::uint64_t>& offset) {
  std::vector<Index> loops;
  std::vector<std::uint64_t> loop_offset{0};
  std::vector<Index> volumes;
  {
    const py::gil_scoped_release unlocked;
    VolumeSkin skin;
    const std::span<const std::uint64_t> begin = spanOf(offset);
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
      skin.add(spanOf(corners).subspan(begin[v], begin[v + 1] - begin[v]));
    }
    for (const VolumeSkin::Face& face : skin.faces(vectorsOf(vertices))) {
      loops.insert(loops.end(), face.vertices().begin(), face.vertices().end());
      loop_offset.push_back(loops.size());
      volumes.push_back(face.volume);
    }
  }
  return py::make_tuple(taken(std::move(loops)), taken(std::move(loop_offset)),
                        taken(std::move(volumes)));
}

py::list materialsOf(const Scene& scene) {
  py::list list;
  for (const Material& material : scene.materials) {
    py::dict entry;
    entry["name"] = material.name;
    entry["reflectance"] = triple(material.reflectance);
    entry["emission"] = triple(material.emission);
    entry["two_sided"] = material.two_sided;
    list.append(entry);
  }
  return list;
}

py::dict dictOf(const Camera& camera) {
  py::dict entry;
  entry["name"] = camera.name;
  entry["eye"] = triple(camera.eye);
  entry["target"] = triple(camera.target);
  entry["up"] = triple(camera.up);
  entry["vertical_fov"] = camera.vertical_fov;
  entry["aspect"] = camera.aspect;
  return entry;
}

std::shared_ptr<MeshHandle> mesh(std::shared_ptr<Scene> scene, const py::dict& given,
                                 const py::object& report) {
  const auto options = optionsFrom<MeshOptions>(given);
  auto handle = std::make_shared<MeshHandle>();
  handle->scene = std::move(scene);
  handle->key = [options, scene = handle->scene] { return keyOfMesh(options, *scene); };
  runLong(report, [&](Progress& progress) {
    handle->result = meshScene(*handle->scene, options, progress);
    handle->materials = patchMaterials(*handle->scene, handle->result.mesh);
  });
  return handle;
}

/// A function that returns a view of an array of a handle.
template <class Handle, class Get>
auto viewed(Get get) {
  return [get](const py::object& self) { return view(get(self.cast<const Handle&>()), self); };
}

void bindMesh(py::module_& module) {
  using M = MeshHandle;
  py::class_<M, std::shared_ptr<M>> type(module, "Mesh");
  const auto array = [&](const char* name, auto field) {
    type.def_property_readonly(
        name, viewed<M>([field](const M& m) -> const auto& { return m.result.mesh.*field; }));
  };
  array("vertices", &PatchMesh::vertices);
  array("corner_offset", &PatchMesh::corner_offset);
  array("corners", &PatchMesh::corners);
  array("piece_offset", &PatchMesh::piece_offset);
  array("pieces", &PatchMesh::pieces);
  array("centroid", &PatchMesh::centroid);
  array("normal", &PatchMesh::normal);
  array("area", &PatchMesh::area);
  array("surface", &PatchMesh::surface);
  array("source_face", &PatchMesh::source_face);
  array("side", &PatchMesh::side);
  array("twin", &PatchMesh::twin);
  type.def_property_readonly("reflectance", [](const py::object& self) {
    const PatchMaterials& materials = self.cast<const M&>().materials;
    return rows(materials.reflectance, materials.bands, self);
  });
  type.def_property_readonly("emission", [](const py::object& self) {
    const PatchMaterials& materials = self.cast<const M&>().materials;
    return rows(materials.emission, materials.bands, self);
  });
  type.def_property_readonly(
      "sky", [](const M& m) { return background(m.materials.lights, m.materials.bands); });
  type.def_property_readonly("surface_names",
                             [](const M& m) { return m.result.mesh.surface_names; });
  type.def_property_readonly("has_scene", [](const M& m) { return m.scene != nullptr; });
  type.def_property_readonly("scene",
                             [](const M& m) { return std::const_pointer_cast<Scene>(m.scene); });
  type.def_property_readonly("report", [](const M& m) { return python::dictOf(m.result.report); });
  module.def("mesh", &mesh);
}

}  // namespace

void bindScene(py::module_& module) {
  py::class_<Scene, std::shared_ptr<Scene>> type(module, "Scene");
  const auto array = [&](const char* name, auto field) {
    type.def_property_readonly(
        name, viewed<Scene>([field](const Scene& s) -> const auto& { return s.*field; }));
  };
  array("vertices", &Scene::vertices);
  array("face_offset", &Scene::face_offset);
  array("corners", &Scene::corners);
  array("face_surface", &Scene::face_surface);
  type.def_readonly("file", &Scene::file);
  type.def_property_readonly("sky", [](const Scene& s) { return background(s.lights, 3); });
  type.def_property_readonly("notes", [](const Scene& s) { return listOf(s.notes); });
  type.def_property_readonly("materials", &materialsOf);
  type.def_property_readonly("surface_names", [](const Scene& s) {
    std::vector<std::string> names;
    names.reserve(s.surfaces.size());
    for (const Surface& surface : s.surfaces) names.push_back(surface.name);
    return names;
  });
  type.def_property_readonly("cameras", [](const Scene& s) {
    py::list list;
    for (const Camera& camera : s.cameras) list.append(dictOf(camera));
    return list;
  });
  module.def("load", &load);
  module.def("scene_of_arrays", &sceneOfArrays);
  module.def("volume_skin", &volumeSkin);
  bindMesh(module);
}

}  // namespace radiosity::python
