// Lights of a file that Assimp read.
#pragma once

#include <assimp/types.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "radiosity/scene.h"
#include "scene/assimp/assimp_scene.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// Makes points, spots and suns of them. The formats give no unit: a strength is taken as Blender
/// writes it, watts of a point or a spot in all directions, W/m^2 of a sun. Spots are those of FBX:
/// what other formats say of cones does not come through Assimp. All are named in notes.
class AssimpLights {
 public:
  /// `extension`: of the file, with its dot. `scale`: metres a unit.
  AssimpLights(const std::vector<AssimpLight>& lights, std::string extension, double scale,
               FeatureNotes& notes);

  /// Places one of the lights that belong to a node of that name; `place`: of the node.
  void addNode(const std::string& node, const aiMatrix4x4& place);
  /// Adds those that were placed. Errors: InputError for numbers that no light has.
  void addTo(Scene& scene);

 private:
  bool isRead(const AssimpLight& given) const;

  std::string extension_;
  double scale_;
  FeatureNotes& notes_;
  std::multimap<std::string, const AssimpLight*> light_of_;  ///< by node; not placed yet
  UniqueNames names_ = lightNames();
  std::vector<Light> placed_;
};

}  // namespace radiosity
