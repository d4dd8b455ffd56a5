// Meshes without materials: faces by the names of their groups, elements of analysis programs.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "radiosity/scene.h"
#include "radiosity/volume_skin.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// What an element of a mesh is; the first `corners` of its nodes are its corners, in order.
struct ElementShape {
  int dimension;  ///< 0 point, 1 line, 2 face, 3 volume
  int corners;    ///< of a face, of a volume (0: one whose sides are not known)
  int nodes;      ///< 0: any number, and all are corners
};

/// Makes a scene of faces with names. Each name is a surface with a material of the same name and
/// the default reflectance, so that a surface is called in the program as it is in its file.
class GroupedFaces {
 public:
  /// `options` must outlive it.
  GroupedFaces(const std::string& path, const SceneOptions& options);

  /// The scene so far, for notes and cameras.
  Scene& scene() { return scene_; }

  /// Adds a vertex of finite coordinates, in file units. InputError beyond what an Index counts.
  Index addVertex(const Vec3& place);
  /// `element`: how the file calls the face, for Scene::face_element.
  void addFace(std::span<const Index> corners, const std::string& group, std::size_t element);
  /// The same for an element of any shape: lines and points are left out, of curved faces the
  /// corners count, of volumes the skin where there are no faces; finish() says so.
  void addElement(const ElementShape& shape, std::span<const Index> nodes, const std::string& group,
                  std::size_t element);
  /// A side of a volume is of a group of its own: as VolumeSkin::Face counts them.
  void nameSide(Index volume, int side, const std::string& group) {
    side_groups_[{volume, side}] = group;
  }

  /// InputError where there are vertices alone, as scanners write them.
  void refuseCloud() const;
  /// InputError, with `cure`, where there are no faces.
  Scene finish(const std::string& cure);

 private:
  void addVolume(const ElementShape& shape, std::span<const Index> nodes, const std::string& group,
                 std::size_t element);
  void addSkin();
  void noteElements();

  const SceneOptions& options_;
  Scene scene_;
  SceneBuilder builder_;
  std::map<std::string, Index> surface_of_;
  std::size_t curved_ = 0;
  std::size_t volumes_ = 0;
  VolumeSkin skin_;  ///< while there are no faces
  struct Volume {
    Index group;  ///< into volume_groups_
    std::size_t element;
  };
  std::vector<Volume> skin_volumes_;  ///< by skin_'s volumes
  std::vector<std::string> volume_groups_;
  std::map<std::pair<Index, int>, std::string> side_groups_;
  std::size_t curved_volumes_ = 0;
  std::size_t lines_ = 0;
};

/// Whether an array of numbers or names of faces, called `array`, says which part of the scene they
/// belong to ("group", "RegionId", "PhysicalIds", "material_index" and the like): how far down it
/// stands in the list of such names, the likeliest first. None: it does not.
std::optional<std::size_t> groupArrayRank(std::string_view array);

/// Nodes by their numbers, which need not be consecutive.
class NodeNumbers {
 public:
  /// False where there is a node of that number already.
  bool add(long long number, Index vertex) { return vertex_of_.emplace(number, vertex).second; }
  /// kNone where there is none.
  Index find(long long number) const {
    const auto found = vertex_of_.find(number);
    return found == vertex_of_.end() ? kNone : found->second;
  }

 private:
  std::unordered_map<long long, Index> vertex_of_;
};

}  // namespace radiosity
