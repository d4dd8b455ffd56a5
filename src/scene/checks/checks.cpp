// Checks light, size and single faces; check_orientation.cpp and check_overlaps.cpp check the rest.
#include "scene/checks/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

std::optional<Note> whiteMaterials(const Scene& scene) {
  const auto isWhite = [](const Vec3& colour) { return colour == Vec3(1.0); };
  const std::span<const Vec3> colours = scene.colours;
  std::vector<std::uint8_t> seen(scene.materials.size(), 0);
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    const bool is_coloured =
        !colours.empty() &&
        !std::ranges::all_of(colours.subspan(scene.face_offset[f], scene.face(f).size()), isWhite);
    if (!is_coloured) seen[scene.surfaces[scene.face_surface[f]].material] = 1;
  }
  std::set<std::string> white;
  for (std::size_t m = 0; m < seen.size(); ++m) {
    const Material& material = scene.materials[m];
    if (seen[m] == 0 || material.texture != kNone || !isWhite(material.reflectance)) continue;
    white.insert(material.name);
  }
  if (white.empty()) return std::nullopt;
  const std::vector<std::string> names(white.begin(), white.end());
  return Note{Severity::warning,
              fmt::format("reflectance 1: absorbs no light, as nothing real does, and cannot be "
                          "told from an even sky behind it (white paint has 0.8; {}): {}",
                          spelled("set", "NAME.reflectance"), joinNames(names))};
}

SceneChecks::SceneChecks(const Scene& scene, const WeldedFaces& faces)
    : scene_(scene), faces_(faces), doubled_(findDoubledFaces(faces)), is_double_(faces.size(), 0) {
  for (const DoubledFace& pair : doubled_) is_double_[pair.second] = 1;
  std::vector<std::uint8_t> two_sided(faces.size(), 0);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    two_sided[f] = scene.materialOf(f).two_sided ? 1 : 0;
  }
  topology_ = analyseTopology(faces, two_sided, is_double_);
  std::vector<Box3> boxes;
  boxes.reserve(topology_.parts.size());
  for (const ConnectedPart& part : topology_.parts) boxes.push_back({part.lower, part.upper});
  part_boxes_ = BoxTree(boxes);
}

void SceneChecks::reportLight(SceneInfo& info) const {
  bool any = false;
  bool absorbs = false;
  for (std::size_t s = 0; s < scene_.surfaces.size(); ++s) {
    const Material& material = scene_.materials[scene_.surfaces[s].material];
    const bool emitter = material.emission != Vec3(0.0);
    any |= emitter && info.surfaces[s].area > 0;
    absorbs |= material.texture != kNone || material.reflectance != Vec3(1.0);
    if (emitter && info.surfaces[s].area == 0) {
      info.problems.push_back(
          {Severity::loud,
           fmt::format("{} emits but has no area: it gives no light", scene_.surfaces[s].name)});
    }
  }
  // A closed body that faces outwards is lit by the sky all around.
  const bool sky_is_seen = !enclosed();
  const bool sky_shines = anyShinesIn(scene_.lights);
  any |= std::ranges::any_of(
      scene_.lights, [](const Light& light) { return light.shines() && !light.isFromOutside(); });
  if (!any && !(sky_is_seen && sky_shines)) {
    info.problems.push_back(
        {Severity::info,
         fmt::format("no surface emits light{}: for light, make one a lamp, {}{}; heat "
                     "takes temperatures instead",
                     sky_shines ? " and the sky does not shine in" : "",
                     spelled("set", fmt::format("'{}.radiance=10'", likelyLamp(scene_))),
                     sky_is_seen ? ", or let the sky shine in, " + spelled("sky", "1") : "")});
  }
  std::vector<std::string> textured;
  for (const SurfaceInfo& surface : info.surfaces) {
    const auto s = std::size_t(&surface - info.surfaces.data());
    const Material& material = scene_.materials[scene_.surfaces[s].material];
    if (material.emission_texture != kNone) textured.push_back(surface.name);
  }
  if (!textured.empty()) {
    info.problems.push_back(
        {Severity::info, fmt::format("emitted power as without the texture, which takes some "
                                     "of it off: {}",
                                     joinNames(textured))});
  }
  const std::optional<Note> white = whiteMaterials(scene_);
  const auto isKnown = [&](const Note& note) { return note.text == white->text; };
  if (white && std::ranges::none_of(scene_.notes, isKnown)) info.problems.push_back(*white);
  if (!absorbs && info.watertight) {
    info.problems.push_back({Severity::loud,
                             "the scene is closed and every surface has reflectance 1: light is "
                             "never absorbed and there is no solution"});
  }
}

void SceneChecks::reportExtent(SceneInfo& info) const {
  const double diagonal = glm::distance(info.lower, info.upper);
  // A room has a few metres; a scene of a very different size is probably in another unit.
  constexpr double kLargest = 200;
  constexpr double kSmallest = 0.02;
  if (diagonal > kLargest || diagonal < kSmallest) {
    info.problems.push_back(
        {Severity::warning,
         fmt::format(
             "the scene measures {:.6g} m across: if the file's unit is not {}, say so with "
             "{}",
             diagonal, scene_.unit, spelled("unit", "mm|cm|m|in|ft"))});
  }
  const Vec3 size = glm::max(glm::abs(info.lower), glm::abs(info.upper));
  const double rounding =
      std::numeric_limits<double>::epsilon() * std::max({size.x, size.y, size.z});
  if (faces_.tolerance > 0 && rounding > faces_.tolerance) {
    info.problems.push_back(
        {Severity::warning,
         fmt::format("the scene lies {:.3g} m from the origin: its coordinates are rounded more "
                     "coarsely than coincidence ({:.3g} m); move it closer",
                     std::max({size.x, size.y, size.z}), faces_.tolerance)});
  }
}

void SceneChecks::reportFaces(SceneInfo& info) const {
  std::vector<std::size_t> degenerate(scene_.surfaces.size(), 0);
  std::vector<std::size_t> bent(scene_.surfaces.size(), 0);
  std::vector<double> deviation(scene_.surfaces.size(), 0);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Index s = scene_.face_surface[f];
    degenerate[s] += faces_.degenerate[f];
    const double off = faces_.degenerate[f] != 0 ? 0 : planeDeviation(faces_, f);
    bent[s] += off > faces_.tolerance ? 1 : 0;
    deviation[s] = std::max(deviation[s], off);
  }
  std::map<std::pair<std::string, std::string>, std::size_t> doubled;
  for (const DoubledFace& pair : doubled_)
    ++doubled[{surfaceOf(pair.first), surfaceOf(pair.second)}];
  for (std::size_t s = 0; s < scene_.surfaces.size(); ++s) {
    const std::string& name = scene_.surfaces[s].name;
    if (degenerate[s] > 0) {
      info.problems.push_back(
          {Severity::warning,
           fmt::format("{}: {} of {} faces have no area (coinciding or collinear "
                       "corners)",
                       name, degenerate[s], info.surfaces[s].faces)});
    }
    if (bent[s] > 0) {
      info.problems.push_back(
          {Severity::info, fmt::format("{}: {} of {} faces are not planar, by up to {:.3g} m", name,
                                       bent[s], info.surfaces[s].faces, deviation[s])});
    }
  }
  for (const auto& [names, count] : doubled) {
    info.problems.push_back(
        {Severity::warning,
         names.first == names.second
             ? fmt::format("{}: faces that are there twice: {}", names.first, count)
             : fmt::format("{}: faces that are there a second time in {}: {}", names.first,
                           names.second, count)});
  }
}

std::vector<std::string> SceneChecks::surfacesOf(const ConnectedPart& part) const {
  std::set<Index> surfaces;
  for (const Index f : part.faces) surfaces.insert(scene_.face_surface[f]);
  std::vector<std::string> names;
  names.reserve(surfaces.size());
  for (const Index s : surfaces) names.push_back(scene_.surfaces[s].name);
  return names;
}

std::string SceneChecks::namesOf(const ConnectedPart& part) const {
  return joinNames(surfacesOf(part), 4);
}

}  // namespace radiosity
