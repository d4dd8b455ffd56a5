// Light that is gathered, without a matrix.
#include <pybind11/stl.h>

#include "arrays.h"
#include "handles.h"
#include "long_call.h"
#include "options.h"
#include "reports.h"

namespace radiosity::python {
namespace {

/// `reflectance`, `emission`: (N, bands).
std::shared_ptr<GatheredHandle> gatherLight(std::shared_ptr<MeshHandle> mesh,
                                            const Array<double>& reflectance,
                                            const Array<double>& emission,
                                            const std::optional<std::vector<double>>& sky,
                                            const py::dict& given, const py::object& report) {
  const GatherOptions options = optionsFrom<GatherOptions>(given);
  auto handle = std::make_shared<GatheredHandle>();
  handle->mesh = std::move(mesh);
  const PatchMaterials materials{int(emission.shape(1)), vectorOf(reflectance), vectorOf(emission),
                                 lightsOf(sky, handle->mesh.get())};
  runLong(report, [&](Progress& progress) {
    const PatchMesh& patches = handle->mesh->result.mesh;
    handle->gathered = gather(patches, materials, options, progress);
    handle->radiosity = patchRadiosity(patches, handle->gathered);
  });
  return handle;
}

}  // namespace

void bindGather(py::module_& module) {
  using G = GatheredHandle;
  py::class_<G, std::shared_ptr<G>> type(module, "Gathered");
  type.def_property_readonly("radiosity", [](const py::object& self) {
    const G& g = self.cast<const G&>();
    return rows(g.radiosity, g.gathered.bands, self);
  });
  const auto of_eyes = [&](const char* name, auto field) {
    type.def_property_readonly(name, [field](const py::object& self) {
      const Gathered& gathered = self.cast<const G&>().gathered;
      return rows(gathered.*field, gathered.bands, self);
    });
  };
  of_eyes("eye_radiosity", &Gathered::radiosity);
  of_eyes("eye_irradiance", &Gathered::irradiance);
  type.def_property_readonly("eye_position", [](const py::object& self) {
    return view(self.cast<const G&>().gathered.position, self);
  });
  type.def_property_readonly("eye_of_corner", [](const py::object& self) {
    return view(self.cast<const G&>().gathered.eye_of_corner, self);
  });
  type.def_property_readonly("summary", [](const G& g) { return dictOf(g.gathered.summary); });
  module.def("gather", &gatherLight);
}

}  // namespace radiosity::python
