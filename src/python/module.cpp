// The extension module radiosity._core, on which the package in radiosity/ is built. The package
// passes contiguous arrays of the type and shape that each function names.
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <string>
#include <utility>

#include "handles.h"
#include "long_call.h"
#include "options.h"

namespace radiosity::python {
namespace {

/// Reads a results file into handles that share the mesh and the form factors.
py::dict read(const std::string& path) {
  // Returns the key of the file.
  const auto kept = [](const std::string& text) { return [text] { return text; }; };
  const auto file = std::make_shared<Results>();
  auto mesh = std::make_shared<MeshHandle>();
  auto factors = std::make_shared<FactorsHandle>();
  auto light = std::make_shared<SolutionHandle>();
  auto heat = std::make_shared<HeatHandle>();
  runWithoutSteps([=] {
    *file = readResults(path);
    if (file->scene) mesh->scene = std::make_shared<const Scene>(std::move(*file->scene));
    if (file->mesh) mesh->result = std::move(*file->mesh);
    mesh->key = kept(file->mesh.key);
    if (mesh->scene && file->mesh) {
      mesh->materials = patchMaterials(*mesh->scene, mesh->result.mesh);
    }
    if (file->factors) factors->factors = std::move(*file->factors);
  });
  Results& results = *file;
  factors->key = kept(results.factors.key);
  factors->mesh = mesh;
  py::dict dict;
  if (mesh->scene) dict["scene"] = std::const_pointer_cast<Scene>(mesh->scene);
  if (results.mesh) dict["mesh"] = mesh;
  if (results.factors) dict["form_factors"] = factors;
  if (results.solution && results.materials && results.factors) {
    light->factors = factors;
    light->materials = std::make_shared<const PatchMaterials>(std::move(*results.materials));
    light->solution = std::move(*results.solution);
    light->key = kept(results.solution.key);
    dict["solution"] = light;
  }
  if (results.heat && results.factors) {
    heat->factors = factors;
    heat->solution = std::move(*results.heat);
    heat->key = kept(results.heat.key);
    dict["heat"] = heat;
  }
  return dict;
}

/// Writes scene, mesh and form factors, and light and heat if there are any. Does not copy the
/// matrix.
void save(const std::string& path, const FactorsHandle& factors, const SolutionHandle* light,
          const HeatHandle* heat, const py::object& report) {
  const MeshHandle& mesh = meshOf(factors, "a results file");
  runLong(report, [&](Progress& progress) {
    Results results;
    results.version = RADIOSITY_VERSION;
    if (mesh.scene) results.scene = *mesh.scene;
    results.mesh = {mesh.result, mesh.key()};
    results.factors.key = factors.key();
    if (light != nullptr) {
      results.materials = *light->materials;
      results.solution = {light->solution, light->key()};
    }
    if (heat != nullptr) results.heat = {heat->solution, heat->key()};
    writeResults(path, results, factors.factors, progress);
  });
}

/// The kinds of lights of which a scene has one as options.
py::list describedLights() {
  py::list all;
  for (const Light& light : lightKinds()) {
    if (!light.traits().single) continue;
    py::dict option;
    std::string name = light.name;
    std::ranges::replace(name, '-', '_');
    option["name"] = name;
    if (light.traits().usual > 0) {
      option["value"] = py::none();
    } else {
      option["value"] = 0.0;
    }
    option["help"] = light.traits().help;
    all.append(option);
  }
  return all;
}

/// The options of a stage, a dict each: name, value by default, help.
py::list optionsOf(const std::string& stage) {
  if (stage == "scene") return described(SceneOptions());
  if (stage == "overrides") return described(SceneOverrides());
  if (stage == "mesh") return described(MeshOptions());
  if (stage == "form_factors") return described(FormFactorOptions());
  if (stage == "solve") return described(SolveOptions());
  if (stage == "gather") return described(GatherOptions());
  if (stage == "heat") return described(HeatOptions());
  if (stage == "illuminance") return described(IlluminanceOptions());
  if (stage == "lights") return describedLights();
  throw InputError("no stage has the name " + stage);
}

PyObject* exceptionType(py::module_& module, const char* name, PyObject* base, const char* text) {
  PyObject* type =
      PyErr_NewExceptionWithDoc(("radiosity." + std::string(name)).c_str(), text, base, nullptr);
  module.add_object(name, type);
  return type;
}

void bindErrors(py::module_& module) {
  // The exception types live as long as the process.
  static PyObject* const run_error =
      exceptionType(module, "RunError", PyExc_RuntimeError,
                    "The run itself failed: the disk is full, a memory limit is exceeded.");
  static PyObject* const input_error = exceptionType(
      module, "InputError", PyExc_ValueError,
      "Bad input: one line with the file or argument, the element in it and the cure.");
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const InputError& error) {
      PyErr_SetObject(input_error, printable(error.what()).ptr());
    } catch (const RunError& error) {
      PyErr_SetObject(run_error, printable(error.what()).ptr());
    }
  });
}

}  // namespace
}  // namespace radiosity::python

PYBIND11_MODULE(_core, module) {
  using namespace radiosity;
  python::bindErrors(module);
  python::endWorkWithProcess();
  module.attr("version") = RADIOSITY_VERSION;
  module.def("set_threads", [](const python::py::object& threads) {
    setThreads(python::valueOf<std::uint16_t>("threads", threads));
  });
  module.def("options", &python::optionsOf);
  python::bindScene(module);
  python::bindFactors(module);
  python::bindLight(module);
  python::bindPoints(module);
  python::bindPictures(module);
  python::bindGather(module);
  module.def("read", &python::read);
  module.def("save", &python::save);
  module.def("is_results", &isResultsFile);
}
