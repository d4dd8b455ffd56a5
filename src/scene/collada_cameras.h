// Cameras of Collada files, whose angles Assimp gets wrong unless xfov is there.
#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// The cameras that each <node> holds, by <instance_camera>. They look along -z, with +y up.
class ColladaCameras {
 public:
  /// Notes cameras that are not used: without perspective, or in a node that has neither id nor
  /// name. `document` may go.
  ColladaCameras(const pugi::xml_document& document, FeatureNotes& notes);

  /// Vertical angle (0 where the file gives none) and aspect ratio (COLLADA 1.4.1, <perspective>)
  /// of the cameras in the node with this id, or without an id, with this name. The rest of a
  /// Camera follows from the node.
  const std::vector<Camera>& of(const std::string& id, const std::string& name) const;

 private:
  std::map<std::string, std::vector<Camera>> by_id_;
  std::map<std::string, std::vector<Camera>> by_name_;
};

}  // namespace radiosity
