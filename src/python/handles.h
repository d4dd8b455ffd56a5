// The contents of the Python objects. They are made once and then only read, so that views stay
// valid and threads may share them.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/radiosity.h"
#include "text.h"

namespace radiosity::python {

/// The key of a stage as in Results. It is computed on demand: hashing may take longer than the
/// stage.
using Key = std::function<std::string()>;

struct MeshHandle {
  std::shared_ptr<const Scene> scene;  ///< null: a results file without one
  MeshResult result;
  PatchMaterials materials;  ///< of the scene; without one of no bands
  Key key;
};

/// A sky of that radiance, a band each; none: the lights of the scene.
inline std::vector<Light> lightsOf(const std::optional<std::vector<double>>& sky,
                                   const MeshHandle* mesh) {
  if (!sky) return mesh->materials.lights;
  return sky->empty() ? std::vector<Light>() : std::vector<Light>{uniformSky(*sky)};
}

struct FactorsHandle {
  std::shared_ptr<const MeshHandle> mesh;  ///< null: a matrix from elsewhere
  std::vector<std::string> names;          ///< of the rows of a matrix from elsewhere, or empty
  FormFactors factors;
  Key key;
};

struct SolutionHandle {
  std::shared_ptr<const FactorsHandle> factors;
  std::shared_ptr<const PatchMaterials> materials;  ///< in the mesh's handle, or its own
  Solution solution;
  Key key;
};

struct GatheredHandle {
  std::shared_ptr<const MeshHandle> mesh;
  Gathered gathered;
  std::vector<double> radiosity;  ///< of the patches, N * bands
};

struct HeatHandle {
  std::shared_ptr<const FactorsHandle> factors;
  HeatSolution solution;
  std::optional<HeatOptions> options;  ///< none: it was read
  std::vector<Note> notes;             ///< on the conditions
  Key key;
};

// Each adds its classes and functions to the module.
void bindScene(pybind11::module_& module);
void bindFactors(pybind11::module_& module);
void bindLight(pybind11::module_& module);
void bindGather(pybind11::module_& module);
void bindPoints(pybind11::module_& module);
void bindPictures(pybind11::module_& module);

/// The mesh of form factors. Errors: InputError if they are a matrix alone; it names `asks`, the
/// feature that needs the mesh.
const MeshHandle& meshOf(const FactorsHandle& factors, const char* asks);

}  // namespace radiosity::python
