// Light and heat on form factors.
#include <pybind11/stl.h>

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
  handle->options = options;
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
  handle->options = options;
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
}

}  // namespace radiosity::python
