#include "scene/grouped_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/lower_case.h"

namespace radiosity {

GroupedFaces::GroupedFaces(const std::string& path, const SceneOptions& options)
    : options_(options), builder_(scene_, options) {
  scene_.file = path;
}

Index GroupedFaces::addVertex(const Vec3& place) {
  if (scene_.vertices.size() >= kNone) {
    throw InputError(fmt::format("{}: more than {} vertices; split the scene", scene_.file, kNone));
  }
  scene_.vertices.push_back(place);
  return Index(scene_.vertices.size() - 1);
}

Index GroupedFaces::addVertex(const Vec3& place, const Vec3& colour) {
  colours_.push_back(colour);
  return addVertex(place);
}

void GroupedFaces::addFace(std::span<const Index> corners, const std::string& group,
                           std::size_t element) {
  const auto [place, is_new] = surface_of_.try_emplace(group, kNone);
  if (is_new) {
    scene_.materials.push_back(defaultMaterial(group, options_));
    if (!colours_.empty()) scene_.materials.back().reflectance = Vec3(1.0);
    place->second = builder_.surface(group, Index(scene_.materials.size() - 1));
  }
  corner_colours_.clear();
  for (std::size_t k = 0; k < corners.size() && !colours_.empty(); ++k) {
    corner_colours_.push_back(colours_[corners[k]]);
  }
  builder_.addFace(corners, {}, place->second, element, corner_colours_);
}

void GroupedFaces::addElement(const ElementShape& shape, std::span<const Index> nodes,
                              const std::string& group, std::size_t element) {
  if (shape.dimension > 2) {
    addVolume(shape, nodes, group, element);
  } else if (shape.dimension < 2) {
    ++lines_;
  } else if (shape.nodes == 0) {
    addFace(nodes, group, element);
  } else {
    if (shape.nodes > shape.corners) ++curved_;
    addFace(nodes.first(std::size_t(shape.corners)), group, element);
  }
}

void GroupedFaces::addVolume(const ElementShape& shape, std::span<const Index> nodes,
                             const std::string& group, std::size_t element) {
  ++volumes_;
  if (scene_.faceCount() > 0) {
    skin_.clear();
    skin_volumes_.clear();
    return;
  }
  if (!skin_.add(nodes.first(std::size_t(shape.corners)))) return;
  if (shape.nodes > shape.corners) ++curved_volumes_;
  if (volume_groups_.empty() || volume_groups_.back() != group) volume_groups_.push_back(group);
  skin_volumes_.push_back({Index(volume_groups_.size() - 1), element});
}

/// Adds the skin of the volumes, since light and heat only see their boundary.
void GroupedFaces::addSkin() {
  for (const VolumeSkin::Face& face : skin_.faces(scene_.vertices)) {
    const Volume& volume = skin_volumes_[face.volume];
    const auto named = side_groups_.find({face.volume, face.side});
    addFace(face.vertices(),
            named == side_groups_.end() ? volume_groups_[volume.group] : named->second,
            volume.element);
  }
  if (scene_.faceCount() == 0) return;
  scene_.notes.push_back(
      {Severity::warning,
       fmt::format("no faces, volume elements alone ({}): the sides that no two of them share are "
                   "the surfaces ({})",
                   skin_.size(), scene_.faceCount())});
  volumes_ -= skin_.size();
  curved_ = curved_volumes_;
}

void GroupedFaces::noteElements() {
  const auto note = [&](std::size_t count, Severity severity, const char* one, const char* many) {
    if (count == 0) return;
    scene_.notes.push_back({severity, fmt::format("{} {}", count, count == 1 ? one : many)});
  };
  note(curved_, Severity::warning,
       "element has nodes between its corners: it is read as flat, by its corners",
       "elements have nodes between their corners: they are read as flat, by their corners");
  note(volumes_, Severity::warning, "volume element is left out: its faces are no surfaces here",
       "volume elements are left out: their faces are no surfaces here");
  note(lines_, Severity::info, "line or point has no area and is left out",
       "lines and points have no area and are left out");
}

void GroupedFaces::refuseCloud() const {
  if (scene_.faceCount() > 0 || scene_.vertices.empty()) return;
  throw InputError(
      fmt::format("{}: is a cloud of {} points without faces; make a surface of it first (in "
                  "MeshLab: Filters, Remeshing, Surface Reconstruction)",
                  scene_.file, scene_.vertices.size()));
}

Scene GroupedFaces::finish(const std::string& cure) {
  if (scene_.faceCount() == 0) addSkin();
  if (scene_.faceCount() == 0) {
    const char* what = volumes_ > 0 ? "no faces, volume elements alone" : "no faces";
    throw InputError(fmt::format("{}: {}; {}", scene_.file, what, cure));
  }
  std::vector<std::string> groups;
  groups.reserve(scene_.surfaces.size());
  for (const Surface& surface : scene_.surfaces) groups.push_back(surface.object);
  scene_.notes.push_back(noMaterialNote(groups, !colours_.empty(), options_));
  noteElements();
  builder_.finish();
  return std::move(scene_);
}

std::optional<std::size_t> groupArrayRank(std::string_view array) {
  static constexpr std::array<std::string_view, 15> kWords = {
      "surface", "group", "region", "physical",   "gmshphysical", "part",  "material", "object",
      "label",   "zone",  "patch",  "cellentity", "entity",       "solid", "component"};
  std::string word;
  for (const char c : lowerCase(array)) {
    if (c >= 'a' && c <= 'z') word += c;
  }
  for (const std::string_view ending : {"s", "id", "index", "tag", "name"}) {
    if (word.ends_with(ending)) word.resize(word.size() - ending.size());
  }
  const auto* const found = std::find(kWords.begin(), kWords.end(), word);
  if (found == kWords.end()) return std::nullopt;
  return std::size_t(found - kWords.begin());
}

}  // namespace radiosity
