#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "scene/checks/checks.h"
#include "scene/checks/far_apart.h"

namespace radiosity {

namespace {

void measureBox(const Scene& scene, SceneInfo& info) {
  info.lower = Vec3(std::numeric_limits<double>::infinity());
  info.upper = -info.lower;
  for (const Index vertex : scene.corners) {
    info.lower = glm::min(info.lower, scene.vertices[vertex]);
    info.upper = glm::max(info.upper, scene.vertices[vertex]);
  }
}

void measureSurfaces(const Scene& scene, const WeldedFaces& faces, SceneInfo& info) {
  for (const Surface& surface : scene.surfaces) {
    info.surfaces.push_back({surface.name, scene.materials[surface.material].name, 0, 0, Vec3(0)});
  }
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    SurfaceInfo& surface = info.surfaces[scene.face_surface[f]];
    ++surface.faces;
    surface.area += glm::length(faces.area_vector[f]);
    info.triangles += scene.face(f).size() - 2;
  }
  for (std::size_t s = 0; s < info.surfaces.size(); ++s) {
    const Material& material = scene.materials[scene.surfaces[s].material];
    const double sides = material.two_sided ? 2 : 1;
    info.surfaces[s].emitted_power = sides * info.surfaces[s].area * material.emission;
    info.emitted_power += info.surfaces[s].emitted_power;
  }
}

}  // namespace

SceneInfo inspectScene(const Scene& scene, double weld) {
  SceneInfo info;
  if (scene.faceCount() == 0) {
    throw InputError(scene.file + ": no faces; export the scene with its meshes as polygons");
  }
  measureBox(scene, info);
  const WeldedFaces faces = weldFaces(scene, info.lower, info.upper, weld);
  measureSurfaces(scene, faces, info);
  const SceneChecks checks(scene, faces);
  info.closed = checks.closed();
  info.open_edges = checks.openEdges();
  checks.reportLight(info);
  checks.reportExtent(info);
  if (const auto note = noteFarApart(scene, weld)) info.problems.push_back(*note);
  checks.reportFaces(info);
  checks.reportOrientation(info);
  checks.reportOverlaps(info);
  return info;
}

}  // namespace radiosity
