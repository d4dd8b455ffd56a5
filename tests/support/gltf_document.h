// glTF documents that tests write, with their bytes embedded.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/scene_files.h"

namespace radiosity::test {

using Json = nlohmann::json;

inline std::string base64(const std::string& bytes) {
  static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t word = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      word = word << 8 | (k + b < bytes.size() ? std::uint8_t(bytes[k + b]) : 0u);
    }
    for (std::size_t d = 0; d < 4; ++d) {
      text += k + d <= bytes.size() ? kDigits[word >> (18 - 6 * d) & 63] : '=';
    }
  }
  return text;
}

/// A glTF document that grows: one buffer, one view and accessor a call of add().
struct Document {
  Json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  std::string bytes;

  template <class T>
  int add(const std::vector<T>& values, int component_type, const char* type, int components) {
    while (bytes.size() % 4 != 0) bytes += '\0';
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component_type},
                                 {"count", values.size() / std::size_t(components)},
                                 {"type", type}});
    return int(json["accessors"].size()) - 1;
  }
  int positions(const std::vector<float>& values) { return add(values, 5126, "VEC3", 3); }

  std::string text() {
    json["buffers"] = {{{"uri", "data:application/octet-stream;base64," + base64(bytes)},
                        {"byteLength", bytes.size()}}};
    return json.dump();
  }
};

/// One triangle with corners (0,0,0), (1,0,0), (0,1,0) in a node "tri".
inline Document triangle() {
  Document d;
  d.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  d.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
  d.json["nodes"] = {{{"mesh", 0}, {"name", "tri"}}};
  d.json["scenes"] = {{{"nodes", {0}}}};
  return d;
}

/// Reads documents.
class GltfFiles : public SceneFiles {
 protected:
  Scene load(Document d, const SceneOptions& options = {}) {
    return loadScene(write("scene.gltf", d.text()), options);
  }
  std::string errorOf(Document d) {
    const std::string file = write("scene.gltf", d.text());
    return inputErrorOf([&] { loadScene(file); });
  }
};

}  // namespace radiosity::test
