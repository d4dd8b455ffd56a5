#include "scene/assimp/collada_cameras.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

namespace radiosity {

namespace {

/// The tangent of half an angle; 0 if the file does not give it.
double halfTangent(const pugi::xml_node& perspective, const char* name) {
  return std::tan(0.5 * perspective.child(name).text().as_double(0) * std::numbers::pi / 180);
}

Camera viewOf(const pugi::xml_node& perspective) {
  const double wide = halfTangent(perspective, "xfov");
  double high = halfTangent(perspective, "yfov");
  Camera camera;
  camera.aspect = perspective.child("aspect_ratio").text().as_double(0);
  if (!(camera.aspect > 0)) camera.aspect = wide > 0 && high > 0 ? wide / high : 0;
  // If the file does not give the height of the picture, we take 4 : 3.
  if (!(high > 0)) high = wide / (camera.aspect > 0 ? camera.aspect : 4.0 / 3);
  camera.vertical_fov = 2 * std::atan(high);
  return camera;
}

}  // namespace

ColladaCameras::ColladaCameras(const pugi::xml_document& document, FeatureNotes& notes) {
  std::map<std::string_view, std::optional<Camera>> cameras;  // empty: without perspective
  const pugi::xml_node root = document.document_element();
  for (const pugi::xml_node camera : root.child("library_cameras").children("camera")) {
    const pugi::xml_node perspective =
        camera.child("optics").child("technique_common").child("perspective");
    std::optional<Camera>& view = cameras[camera.attribute("id").value()];
    if (perspective) view = viewOf(perspective);
  }
  const pugi::xpath_node_set places = root.select_nodes("//node/instance_camera");
  for (const pugi::xpath_node& place : places) {
    std::string_view url = place.node().attribute("url").value();
    if (url.starts_with('#')) url.remove_prefix(1);
    const std::string id = place.parent().attribute("id").value();
    const std::string name = place.parent().attribute("name").value();
    const auto found = cameras.find(url);
    if (found == cameras.end() || !found->second) {
      notes.add("cameras without perspective are not used", std::string(url), Severity::warning);
    } else if (!id.empty()) {
      by_id_[id].push_back(*found->second);
    } else if (!name.empty()) {
      by_name_[name].push_back(*found->second);
    } else {
      notes.add("cameras in nodes without id and name are not used", std::string(url),
                Severity::warning);
    }
  }
}

const std::vector<Camera>& ColladaCameras::of(const std::string& id,
                                              const std::string& name) const {
  static const std::vector<Camera> none;
  const auto& where = id.empty() ? by_name_ : by_id_;
  const auto found = where.find(id.empty() ? name : id);
  return found == where.end() ? none : found->second;
}

}  // namespace radiosity
