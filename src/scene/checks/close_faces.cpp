#include "scene/checks/close_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "base/geometry/box.h"
#include "base/geometry/plane_frame.h"
#include "radiosity/spelling.h"

namespace radiosity {
namespace {

/// Distances below this share of the largest coordinate are rounding.
constexpr double kRounding = 0x1p-48;

/// The least height of the second face's corners over the plane of the first.
double heightOver(const Scene& scene, Index first, Index second) {
  const auto face = scene.face(first);
  const Vec3& base = scene.vertices[face[0]];
  const Vec3 area =
      vectorArea(face.size(), [&](std::size_t k) { return scene.vertices[face[k]] - base; });
  const double size = glm::length(area);
  if (!(size > 0)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Index v : scene.face(second)) {
    least = std::min(least, glm::dot(scene.vertices[v] - base, area / size));
  }
  return least;
}

}  // namespace

double gapBetween(const Scene& scene, Index first, Index second) {
  const double gap = std::min(heightOver(scene, first, second), heightOver(scene, second, first));
  double largest = 0;
  for (const Index v : scene.face(first)) {
    for (int axis = 0; axis < 3; ++axis) {
      largest = std::max(largest, std::abs(scene.vertices[v][axis]));
    }
  }
  return gap > kRounding * largest ? gap : 0;
}

void LostGaps::add(const Scene& scene, Index first, Index second, double gap) {
  const std::pair<Index, Index> pair =
      std::minmax(scene.face_surface[first], scene.face_surface[second]);
  const auto [place, is_new] = least_.try_emplace(pair, gap);
  if (!is_new) place->second = std::min(place->second, gap);
}

std::vector<Note> LostGaps::notes(const Scene& scene, double coincidence) const {
  Box3 box;
  for (const Index v : scene.corners) box.add(scene.vertices[v]);
  std::vector<Note> out;
  out.reserve(least_.size());
  for (const auto& [pair, gap] : least_) {
    out.push_back(
        {Severity::warning,
         fmt::format("{} and {} face each other {:.3g} m apart, closer than the coincidence of "
                     "{:.3g} m: they are one sheet and see nothing of each other ({} "
                     "keeps them apart)",
                     scene.surfaces[pair.first].name, scene.surfaces[pair.second].name, gap,
                     coincidence,
                     spelled("weld", fmt::format("{:.1g}", 0.1 * gap / box.diagonal())))});
  }
  return out;
}

}  // namespace radiosity
