// Reads the cameras of Collada files: Assimp gets their angles wrong unless the file has xfov.
#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// The cameras of each <node>, by <instance_camera>. They look along -z, with +y up.
class ColladaCameras {
 public:
  /// Notes unused cameras: those without perspective, or in a node that has neither id nor name.
  /// `document` is not needed afterwards.
  ColladaCameras(const pugi::xml_document& document, FeatureNotes& notes);

  /// The cameras in the node with this id or, if it has no id, with this name. They have the
  /// vertical angle (0 if the file gives none) and the aspect ratio (COLLADA 1.4.1, <perspective>);
  /// the rest follows from the node.
  const std::vector<Camera>& of(const std::string& id, const std::string& name) const;

 private:
  std::map<std::string, std::vector<Camera>> by_id_;
  std::map<std::string, std::vector<Camera>> by_name_;
};

}  // namespace radiosity
