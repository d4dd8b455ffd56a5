// Finds faces that are turned against their neighbours, and parts that are inside out.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <iterator>

#include "radiosity/spelling.h"
#include "scene/checks/checks.h"
#include "scene/surface_names.h"
#include "scene/text.h"

namespace radiosity {

namespace {

bool boxContains(const ConnectedPart& outer, const ConnectedPart& inner, double tolerance) {
  const auto within = [&](int k) {
    return outer.lower[k] - tolerance <= inner.lower[k] &&
           inner.upper[k] <= outer.upper[k] + tolerance;
  };
  return within(0) && within(1) && within(2);
}

/// Fans are enough, even of concave faces, since their triangles are only summed with signs.
std::vector<WindingTree::Triangle> trianglesOf(const WeldedFaces& faces,
                                               const ConnectedPart& part) {
  std::vector<WindingTree::Triangle> out;
  for (const Index f : part.faces) {
    const auto face = faces.face(f);
    for (std::size_t k = 2; k < face.size(); ++k) {
      out.push_back(
          {{faces.points[face[0]], faces.points[face[k - 1]], faces.points[face[k]]}, kNone});
    }
  }
  return out;
}

}  // namespace

/// The place of a point, given relative to the centre of the welded faces. `on`: so close to the
/// part's faces that neither side is certain.
Containment SceneChecks::placeOf(const Vec3& point, const ConnectedPart& outer) const {
  auto tree = winding_.find(&outer);
  if (tree == winding_.end()) {
    tree = winding_.emplace(&outer, WindingTree(trianglesOf(faces_, outer))).first;
  }
  const double winding = std::abs(tree->second.around(point));
  if (winding >= 0.75) return Containment::inside;
  return winding > 0.25 ? Containment::on : Containment::outside;
}

/// The place of a part. `on`: every face of `inner` lies on `outer` (a lamp panel on a ceiling).
/// Faces in contact do not count if there are others (a block on a floor).
Containment SceneChecks::placeOf(const ConnectedPart& inner, const ConnectedPart& outer) const {
  if (!boxContains(outer, inner, faces_.tolerance)) return Containment::outside;
  for (const Index f : inner.faces) {
    const Containment place = placeOf(middleOf(f), outer);
    if (place != Containment::on) return place;
  }
  return Containment::on;
}

Vec3 SceneChecks::middleOf(std::size_t face) const {
  Vec3 sum{0.0};
  for (const Index corner : faces_.face(face)) sum += faces_.points[corner];
  return sum / double(std::max<std::size_t>(1, faces_.face(face).size()));
}

bool SceneChecks::closed() const { return topology_.closed || enclosed(); }

bool SceneChecks::enclosed() const {
  const std::vector<ConnectedPart>& parts = topology_.parts;
  if (parts.empty()) return false;
  Vec3 lower = parts.front().lower;
  Vec3 upper = parts.front().upper;
  for (const ConnectedPart& part : parts) {
    lower = glm::min(lower, part.lower);
    upper = glm::max(upper, part.upper);
  }
  return std::any_of(parts.begin(), parts.end(), [&](const ConnectedPart& room) {
    // If many bodies are inside out, we only examine one that extends as far as all of them.
    return room.closed && room.volume < 0 && room.lower == lower && room.upper == upper &&
           std::all_of(parts.begin(), parts.end(), [&](const ConnectedPart& part) {
             return &part == &room || placeOf(part, room) != Containment::outside;
           });
  });
}

void SceneChecks::reportOrientation(SceneInfo& info) const {
  reportFlippedFaces(info);
  reportInsideOut(info);
  reportLoneShell(info);
}

void SceneChecks::reportFlippedFaces(SceneInfo& info) const {
  std::vector<std::size_t> flipped(scene_.surfaces.size(), 0);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    // The winding of a two-sided face does not matter.
    if (topology_.flipped[f] != 0 && !scene_.materialOf(f).two_sided) {
      ++flipped[scene_.face_surface[f]];
    }
  }
  for (std::size_t s = 0; s < flipped.size(); ++s) {
    if (flipped[s] == 0) continue;
    info.problems.push_back(
        {Severity::warning,
         fmt::format("{}: {} of {} faces turn their backs where their neighbours show the front: "
                     "{}, or {}",
                     scene_.surfaces[s].name, flipped[s], info.surfaces[s].faces,
                     flipped[s] == info.surfaces[s].faces ? flipOption({scene_.surfaces[s].name}, 0)
                                                          : "flip their normals in the file",
                     spelled("two_sided"))});
  }
  for (const ConnectedPart& part : topology_.parts) {
    if (part.orientable) continue;
    info.problems.push_back(
        {Severity::info, fmt::format("{}: has one side only, like a Moebius strip: no winding of "
                                     "its faces agrees everywhere",
                                     namesOf(part))});
  }
}

void SceneChecks::reportInsideOut(SceneInfo& info) const {
  for (const ConnectedPart& part : topology_.parts) {
    if (part.closed && part.volume != 0 && isOneSided(part)) reportPart(part, info);
  }
}

bool SceneChecks::isOneSided(const ConnectedPart& part) const {
  return std::any_of(part.faces.begin(), part.faces.end(),
                     [&](Index f) { return !materialOf(f).two_sided; });
}

/// Notes a solid that is all there is, which may be meant as a room.
void SceneChecks::reportLoneShell(SceneInfo& info) const {
  if (topology_.parts.size() != 1 || !scene_.cameras.empty()) return;
  const ConnectedPart& part = topology_.parts.front();
  if (!part.closed || !(part.volume > 0) || !isOneSided(part)) return;
  info.problems.push_back(
      {anyShinesIn(scene_.lights) ? Severity::info : Severity::warning,
       fmt::format("{}: closed, faces outwards and is all there is: nothing inside sees anything; "
                   "if it is a room, turn it over, {}",
                   namesOf(part), flipOption(surfacesOf(part), scene_.surfaces.size()))});
}

std::vector<std::uint8_t> SceneChecks::turnedSurfaces() const {
  std::vector<double> balance(scene_.surfaces.size(), 0.0);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const double area = glm::length(faces_.area_vector[f]);
    balance[scene_.face_surface[f]] += topology_.flipped[f] != 0 ? area : -area;
  }
  std::vector<std::uint8_t> turned(balance.size(), 0);
  std::ranges::transform(balance, turned.begin(), [](double b) { return b > 0 ? 1 : 0; });
  return turned;
}

std::vector<std::string> SceneChecks::solidAround(Index surface) const {
  const auto first = std::ranges::find(scene_.face_surface, surface);
  if (first == scene_.face_surface.end()) return {};
  const auto f = std::size_t(first - scene_.face_surface.begin());
  const ConnectedPart* around = nullptr;
  part_boxes_.query({middleOf(f), middleOf(f)}, [&](Index k) {
    const ConnectedPart& part = topology_.parts[k];
    const bool solid = part.closed && part.volume > 0 && isOneSided(part);
    if (!solid || topology_.part_of[f] == k) return true;
    const bool smaller = around == nullptr || part.volume < around->volume;
    if (smaller && placeOf(middleOf(f), part) != Containment::outside) around = &part;
    return true;
  });
  return around == nullptr ? std::vector<std::string>() : surfacesOf(*around);
}

std::vector<std::size_t> SceneChecks::partsNear(const ConnectedPart& part) const {
  std::vector<std::size_t> near;
  part_boxes_.query({part.lower, part.upper}, [&](Index k) {
    near.push_back(k);
    return true;
  });
  std::sort(near.begin(), near.end());
  return near;
}

std::vector<const ConnectedPart*> SceneChecks::cavitiesOf(const ConnectedPart& solid) const {
  std::vector<const ConnectedPart*> cavities;
  if (!(solid.volume > 0)) return cavities;
  for (const std::size_t k : partsNear(solid)) {
    const ConnectedPart& part = topology_.parts[k];
    if (part.closed && part.volume < 0 && placeOf(part, solid) == Containment::inside) {
      cavities.push_back(&part);
    }
  }
  return cavities;
}

bool SceneChecks::isCavity(const ConnectedPart& part) const {
  const std::vector<std::size_t> near = partsNear(part);
  return std::any_of(near.begin(), near.end(), [&](std::size_t k) {
    const ConnectedPart& solid = topology_.parts[k];
    return solid.closed && solid.volume > 0 && placeOf(part, solid) == Containment::inside;
  });
}

std::vector<std::string> SceneChecks::contentsOf(const ConnectedPart& outer,
                                                 std::span<const ConnectedPart* const> cavities,
                                                 std::size_t most) const {
  std::vector<std::string> contents;
  const auto is_known = [&](const std::string& name) {
    return std::find(contents.begin(), contents.end(), name) != contents.end();
  };
  for (const std::size_t k : partsNear(outer)) {
    const ConnectedPart& part = topology_.parts[k];
    if (contents.size() >= most) break;
    const std::vector<std::string> surfaces = surfacesOf(part);
    const bool adds = !std::all_of(surfaces.begin(), surfaces.end(), is_known);
    if (!adds || &part == &outer || placeOf(part, outer) != Containment::inside) continue;
    const bool is_in_cavity =
        std::any_of(cavities.begin(), cavities.end(), [&](const ConnectedPart* cavity) {
          return &part == cavity || placeOf(part, *cavity) != Containment::outside;
        });
    if (is_in_cavity) continue;
    std::copy_if(surfaces.begin(), surfaces.end(), std::back_inserter(contents),
                 [&](const std::string& name) { return !is_known(name); });
  }
  return contents;
}

/// Reports a closed part that seems to be inside out. A part that faces inwards is a room, with
/// parts inside, or a solid's cavity. A part that faces outwards is a solid, with parts only in its
/// cavities. A part that is alone may be either.
void SceneChecks::reportPart(const ConnectedPart& part, SceneInfo& info) const {
  const bool has_others = topology_.parts.size() > 1;
  const std::vector<const ConnectedPart*> cavities = cavitiesOf(part);
  std::vector<std::string> contents = contentsOf(part, cavities, part.volume < 0 ? 1 : 5);
  bool camera_inside = false;
  for (const Camera& camera : scene_.cameras) {
    const Vec3 eye = camera.eye - faces_.centre;
    camera_inside |= placeOf(eye, part) == Containment::inside &&
                     std::none_of(cavities.begin(), cavities.end(), [&](const ConnectedPart* in) {
                       return placeOf(eye, *in) == Containment::inside;
                     });
  }
  const bool emits_inwards =
      std::any_of(part.faces.begin(), part.faces.end(), [&](Index f) { return emits(f); });
  if (part.volume < 0 && contents.empty() && !camera_inside && has_others && !isCavity(part)) {
    info.problems.push_back(
        {emits_inwards ? Severity::loud : Severity::warning,
         fmt::format("{}: closed, faces inwards and holds nothing: a solid with flipped normals?{}",
                     namesOf(part), emits_inwards ? " Its light stays inside" : "")});
  }
  if (part.volume > 0 && (!contents.empty() || camera_inside)) {
    const std::string names = namesOf(part);
    std::replace(contents.begin(), contents.end(), names, std::string("another part of it"));
    if (camera_inside) contents.emplace_back("a camera");
    info.problems.push_back(
        {Severity::loud,
         fmt::format("{}: closed, faces outwards and holds {}: a room with flipped normals? What "
                     "lies inside a solid is dropped; {} turns it over",
                     names, joinNames(contents, 4),
                     flipOption(surfacesOf(part), scene_.surfaces.size()))});
  }
}

}  // namespace radiosity
