// Makes scenes of meshes without materials: faces by the names of their groups, and elements of
// analysis programs.
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

/// The shape of an element; the first `corners` of its nodes are its corners, in order.
struct ElementShape {
  int dimension;  ///< 0 point, 1 line, 2 face, 3 volume
  int corners;    ///< of a face or a volume (0: a volume whose sides are not known)
  int nodes;      ///< 0: any number, and all are corners
};

/// Makes a scene of faces with names. Each name is a surface with a material of the same name and
/// the default reflectance, so that a surface has the same name in the program as in its file.
class GroupedFaces {
 public:
  /// `options` must outlive it.
  GroupedFaces(const std::string& path, const SceneOptions& options);

  /// The scene so far, for notes and cameras.
  Scene& scene() { return scene_; }

  /// Adds a vertex of finite coordinates, in file units. Errors: InputError if there are too many
  /// for an Index.
  Index addVertex(const Vec3& place);
  /// The same with a colour, which is the reflectance there. All vertices have one, or none has.
  Index addVertex(const Vec3& place, const Vec3& colour);
  /// `element`: the number of the face in the file, for Scene::face_element.
  void addFace(std::span<const Index> corners, const std::string& group, std::size_t element);
  /// The same for an element of any shape. Lines and points are left out; of curved faces only the
  /// corners count; of volumes the skin counts if there are no faces. finish() notes this.
  void addElement(const ElementShape& shape, std::span<const Index> nodes, const std::string& group,
                  std::size_t element);
  /// Gives a side of a volume a group of its own. Volumes and sides are counted as in
  /// VolumeSkin::Face.
  void nameSide(Index volume, int side, const std::string& group) {
    side_groups_[{volume, side}] = group;
  }

  /// Throws InputError if there are only vertices, as in files of scanners.
  void refuseCloud() const;
  /// Returns the scene. Errors: InputError, with `cure`, if there are no faces.
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
  std::vector<Vec3> colours_;         ///< of vertices, or empty
  std::vector<Vec3> corner_colours_;  ///< of the present face
  std::size_t curved_ = 0;
  std::size_t volumes_ = 0;
  VolumeSkin skin_;  ///< used if there are no faces
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

/// The rank of an array of numbers or names of faces, called `array`, among names that usually
/// stand for parts of a scene ("group", "RegionId", "PhysicalIds", "material_index" and the like),
/// the likeliest first. Empty for other names.
std::optional<std::size_t> groupArrayRank(std::string_view array);

/// Nodes by their numbers, which need not be consecutive.
class NodeNumbers {
 public:
  /// Adds a node; false if there is a node of that number already.
  bool add(long long number, Index vertex) { return vertex_of_.emplace(number, vertex).second; }
  /// The vertex of a node; kNone if there is none.
  Index find(long long number) const {
    const auto found = vertex_of_.find(number);
    return found == vertex_of_.end() ? kNone : found->second;
  }

 private:
  std::unordered_map<long long, Index> vertex_of_;
};

}  // namespace radiosity
