// A scene with its light at elements, for tests of pictures.
#pragma once

#include <memory>
#include <string>

#include "radiosity/elements.h"
#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace radiosity::test {

struct LitScene {
  LitScene(Scene from, std::size_t patches, const ElementOptions& options = {.rays = 64})
      : scene(std::move(from)), mesh(meshScene(scene, {.patches = patches}, quiet).mesh) {
    const PatchMaterials materials = patchMaterials(scene, mesh);
    FormFactorOptions how;
    how.method = FormFactorMethod::hemicube;
    const Solution solution =
        solve(computeFormFactors(mesh, how, quiet), materials, mesh, {}, quiet);
    light = surfaceLight(solution.radiosity, materials);
    light.elements = std::make_shared<const Elements>(
        computeElements(mesh, materials, solution.irradiance, options, {}, quiet));
    light.reflectance = materials.reflectance;
    light.emission = materials.emission;
  }

  Progress quiet;
  Scene scene;
  PatchMesh mesh;
  SurfaceLight light;
};

inline Scene dataScene(const std::string& name) {
  return loadScene(std::string(RADIOSITY_SOURCE_DIR) + "/data/" + name);
}

}  // namespace radiosity::test
