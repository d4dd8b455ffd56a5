// Light and heat at measuring points.
#include "arrays.h"
#include "handles.h"
#include "long_call.h"
#include "options.h"

namespace radiosity::python {
namespace {

/// (points, kMeasured, bands).
py::array measuredRows(std::vector<double>&& values, std::size_t points, int bands) {
  const std::vector<py::ssize_t> shape{py::ssize_t(points), py::ssize_t(kMeasured), bands};
  return taken(std::move(values)).reshape(shape);
}

/// `normals`: none: up.
py::dict illuminance(const SolutionHandle& light, const Array<double>& points,
                     const std::optional<Array<double>>& normals, const py::dict& given,
                     const py::object& report) {
  const auto options = optionsFrom<IlluminanceOptions>(given);
  const MeshHandle& mesh = meshOf(*light.factors, "illuminance");
  const Up up = mesh.scene ? mesh.scene->up : Up::y;
  const std::span<const Vec3> at = vectorsOf(points);
  const std::vector<Vec3> upward(normals ? 0 : at.size(), upVector(up));
  const std::span<const Vec3> ways = normals ? vectorsOf(*normals) : std::span(upward);
  PointLightValues values;
  runLong(report, [&](Progress& progress) {
    values = lightAtPoints(mesh.result.mesh, *light.materials, light.solution.irradiance, {}, at,
                           ways, up, options, progress);
  });
  py::dict out;
  out["rays"] = values.report.rays;
  out["open_lux"] = values.open_lux;
  out["direct"] = measuredRows(std::move(values.direct), at.size(), values.bands);
  out["indirect"] = measuredRows(std::move(values.indirect), at.size(), values.bands);
  out["error"] = taken(std::move(values.error));
  out["inside"] = taken(std::move(values.inside));
  return out;
}

/// `sky_temperature`: K; none: that of the heat.
py::tuple radiantTemperature(const HeatHandle& heat, const Array<double>& points,
                             std::optional<double> sky_temperature, const py::object& report) {
  const MeshHandle& mesh = meshOf(*heat.factors, "radiant_temperature");
  HeatOptions options = heat.options.value_or(HeatOptions());
  if (sky_temperature) {
    options.sky_temperature = *sky_temperature;
  } else if (!heat.options) {
    throw InputError("sky_temperature: is not known of heat that was read; give it, in K");
  }
  options.validate();
  RadiantTemperatures found;
  runLong(report, [&](Progress& progress) {
    found = radiantTemperatures(mesh.result.mesh, heat.solution, options, vectorsOf(points),
                                mesh.scene ? mesh.scene->up : Up::y, progress);
  });
  const std::vector<py::ssize_t> faces{points.shape(0), py::ssize_t(kRadiantFaces)};
  return py::make_tuple(taken(std::move(found.standing)), taken(std::move(found.seated)),
                        taken(std::move(found.plane)).reshape(faces),
                        taken(std::move(found.surfaces)));
}

}  // namespace

void bindPoints(py::module_& module) {
  module.def("illuminance", &illuminance);
  module.def("radiant_temperature", &radiantTemperature);
}

}  // namespace radiosity::python
