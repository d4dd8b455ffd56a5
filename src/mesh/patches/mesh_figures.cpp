#include "mesh/patches/mesh_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <string>
#include <utility>

namespace radiosity {

namespace {

/// The smallest interior angle and its patch (kNone: no patch has an area).
std::pair<double, Index> smallestCorner(const PatchMesh& mesh) {
  std::pair<double, Index> smallest = {360.0, kNone};
  for (Index i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0)) continue;
    const auto outline = mesh.outline(i);
    const std::size_t n = outline.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3& here = mesh.vertices[outline[k]];
      const Vec3 back = mesh.vertices[outline[(k + n - 1) % n]] - here;
      const Vec3 ahead = mesh.vertices[outline[(k + 1) % n]] - here;
      double angle = glm::degrees(
          std::atan2(glm::dot(glm::cross(ahead, back), mesh.normal[i]), glm::dot(ahead, back)));
      if (angle < 0) angle += 360.0;
      if (angle < smallest.first) smallest = {angle, i};
    }
  }
  return smallest;
}

}  // namespace

std::size_t PatchMesh::frontCount() const {
  return std::size_t(std::count(side.begin(), side.end(), std::uint8_t(0)));
}

double smallestAngle(const PatchMesh& mesh) {
  const auto [angle, patch] = smallestCorner(mesh);
  return patch == kNone ? 0.0 : angle;
}

void fillFigures(const PatchMesh& mesh, MeshReport& report) {
  report.polygons = mesh.polygons.size();
  report.triangles = report.quads = 0;
  report.longest_edge = 0;
  for (std::size_t s = report.surfaces.size(); s < mesh.surface_names.size(); ++s) {
    report.surfaces.emplace_back().name = mesh.surface_names[s];
  }
  // A long double: with 10^6 patches a sum in doubles loses the twelfth digit.
  std::vector<long double> kept(mesh.surface_names.size(), 0.0L);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    const std::size_t n = outline.size();
    report.triangles += n == 3 ? 1 : 0;
    report.quads += n == 4 ? 1 : 0;
    if (mesh.side[i] == 0) kept[mesh.surface[i]] += mesh.area[i];
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 edge = mesh.vertices[outline[(k + 1) % n]] - mesh.vertices[outline[k]];
      report.longest_edge = std::max(report.longest_edge, glm::length(edge));
    }
  }
  for (std::size_t s = 0; s < kept.size(); ++s) report.surfaces[s].kept = double(kept[s]);
  const auto [angle, patch] = smallestCorner(mesh);
  report.smallest_angle = patch == kNone ? 0.0 : angle;
  report.smallest_angle_surface =
      patch == kNone ? std::string() : mesh.surface_names[mesh.surface[patch]];
}

void noteTJunctions(const PatchMesh& mesh, double coincidence, MeshReport& report) {
  const std::vector<Index> patches = patchesAtTJunctions(mesh, coincidence);
  report.t_junctions = patches.size();
  std::map<std::string, std::size_t> by_surface;
  for (const Index i : patches) ++by_surface[mesh.surface_names[mesh.surface[i]]];
  for (const auto& [name, count] : by_surface) {
    report.notes.push_back(
        {Severity::info,
         fmt::format("{}: {} vertices lie on edges of patches without being their ends (nearer "
                     "than the coincidence of {:.3g} m): details there are about that small",
                     name, count, coincidence)});
  }
}

}  // namespace radiosity
