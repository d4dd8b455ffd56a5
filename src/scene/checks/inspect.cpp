#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "scene/checks/checks.h"
#include "scene/checks/far_apart.h"
#include "scene/surface_names.h"
#include "scene/text.h"

namespace radiosity {

namespace {

void measureBox(const Scene& scene, Vec3& lower, Vec3& upper) {
  lower = Vec3(std::numeric_limits<double>::infinity());
  upper = -lower;
  for (const Index vertex : scene.corners) {
    lower = glm::min(lower, scene.vertices[vertex]);
    upper = glm::max(upper, scene.vertices[vertex]);
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
  measureBox(scene, info.lower, info.upper);
  const WeldedFaces faces = weldFaces(scene, info.lower, info.upper, weld);
  measureSurfaces(scene, faces, info);
  const SceneChecks checks(scene, faces);
  info.watertight = checks.closed();
  info.open_edges = checks.openEdges();
  checks.reportLight(info);
  checks.reportExtent(info);
  if (const auto note = noteFarApart(scene, weld)) info.problems.push_back(*note);
  checks.reportFaces(info);
  checks.reportOrientation(info);
  checks.reportOverlaps(info);
  return info;
}

std::vector<std::string> whyDropped(const Scene& scene, double weld,
                                    std::span<const Index> dropped) {
  Vec3 lower;
  Vec3 upper;
  measureBox(scene, lower, upper);
  const WeldedFaces faces = weldFaces(scene, lower, upper, weld);
  const SceneChecks checks(scene, faces);
  const std::vector<std::uint8_t> turned = checks.turnedSurfaces();
  std::vector<std::string> reasons;
  for (const Index s : dropped) {
    const std::string& name = scene.surfaces[s].name;
    const std::vector<std::string> solid = checks.solidAround(s);
    if (!solid.empty()) {
      reasons.push_back(
          fmt::format("{}: lies wholly inside the closed solid {} and was dropped; if that is a "
                      "room, its faces are turned outward: turn it over, {}",
                      name, joinNames(solid, 4), flipOption(solid, scene.surfaces.size())));
    } else if (turned[s] != 0) {
      reasons.push_back(
          fmt::format("{}: its faces are turned against their neighbours and look into a closed, "
                      "dark space, so it was dropped; turn it over, {}",
                      name, flipOption({name}, 0)));
    } else {
      reasons.push_back(fmt::format(
          "{}: lies wholly in a dark hollow or on other surfaces and was dropped; if that "
          "is a room, its faces are turned outward",
          name));
    }
  }
  return reasons;
}

}  // namespace radiosity
