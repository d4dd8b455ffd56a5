// Finds surfaces that overlap in one plane, summed over pairs of surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "scene/checks/checks.h"

namespace radiosity {

namespace {

/// The most pairs that are named; the rest is counted.
constexpr std::size_t kNamedPairs = 10;

}  // namespace

void SceneChecks::reportOverlaps(SceneInfo& info) const {
  std::map<std::pair<Index, Index>, double> alike;  // surfaces, m^2
  std::map<Index, double> covered;                  // one-sided emitters face to face with others
  const OverlapSearch search = findOverlaps(faces_, is_double_);
  if (!search.complete) {
    info.problems.push_back({Severity::warning,
                             "faces crowd so much that not all of them were checked for overlaps "
                             "in one plane; overlaps may be missing here (not in the mesh)"});
  }
  for (const Overlap& overlap : search.overlaps) {
    const Index first = scene_.face_surface[overlap.first];
    const Index second = scene_.face_surface[overlap.second];
    if (overlap.alike) {
      alike[std::minmax(first, second)] += overlap.area;
      continue;
    }
    // Faces in contact (a block on a floor) are usual, but a lamp whose front is covered is not.
    for (const Index face : {overlap.first, overlap.second}) {
      if (emits(face) && !materialOf(face).two_sided) {
        covered[scene_.face_surface[face]] += overlap.area;
      }
    }
  }
  std::vector<std::tuple<double, Index, Index>> largest;
  largest.reserve(alike.size());
  for (const auto& [pair, area] : alike) largest.emplace_back(-area, pair.first, pair.second);
  std::sort(largest.begin(), largest.end());
  for (std::size_t k = 0; k < std::min(largest.size(), kNamedPairs); ++k) {
    const auto& [negative_area, first, second] = largest[k];
    const auto emitter = [&](Index s) {
      return scene_.materials[scene_.surfaces[s].material].emission != Vec3(0.0);
    };
    const bool lamp = emitter(first) != emitter(second);
    const bool second_on_top =
        lamp ? emitter(second) : info.surfaces[second].area < info.surfaces[first].area;
    const Index on_top = second_on_top ? second : first;
    const Index below = on_top == first ? second : first;
    info.problems.push_back(
        {lamp ? Severity::info : Severity::warning,
         first == second
             ? fmt::format("{}: faces overlap in one plane on {:.4g} m^2",
                           scene_.surfaces[first].name, -negative_area)
             : fmt::format("{} overlaps {} in one plane on {:.4g} m^2: the {} counts there",
                           scene_.surfaces[on_top].name, scene_.surfaces[below].name,
                           -negative_area, lamp ? "emitter" : "smaller surface")});
  }
  if (largest.size() > kNamedPairs) {
    info.problems.push_back({Severity::warning, fmt::format("{} more pairs of surfaces overlap",
                                                            largest.size() - kNamedPairs)});
  }
  for (const auto& [surface, area] : covered) {
    // We require half of the area: the underside of a lamp on a table is no mistake.
    if (area < 0.5 * info.surfaces[surface].area) continue;
    info.problems.push_back(
        {Severity::loud,
         fmt::format("{}: {:.4g} of {:.4g} m^2 lie face to face on another surface and give no "
                     "light: flip its normals or move it",
                     scene_.surfaces[surface].name, area, info.surfaces[surface].area)});
  }
}

}  // namespace radiosity
