// What we use of a scene that Assimp read, and its bytes on the way from the process that runs
// Assimp (src/assimp) to this one.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace radiosity {

struct AssimpTexture {
  std::string path;
  std::uint8_t by_coordinates = 1;
  std::uint32_t set = 0;  ///< of texture coordinates
  float blend = 1;
  std::array<std::uint32_t, 2> wrap = {};  ///< aiTextureMapMode
  std::optional<std::uint32_t> embedded;   ///< index into AssimpScene::images
};

struct AssimpFileMaterial {
  std::string name;
  std::optional<std::array<float, 3>> diffuse, emissive;
  std::optional<std::int32_t> two_sided;
  std::optional<float> opacity;
  // Numbers of textures.
  std::uint32_t diffuse_textures = 0, emissive_textures = 0, opacity_textures = 0;
  std::uint32_t normal_textures = 0, height_textures = 0;
  std::optional<AssimpTexture> texture;  ///< the first diffuse one
};

struct AssimpMesh {
  std::string name;
  std::uint32_t material = 0;
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<float, 3>> colours;    ///< a vertex, or none
  std::vector<std::array<float, 2>> texcoords;  ///< a vertex, or none; the set of the texture
  std::vector<std::uint32_t> corners;           ///< a face: their number
  std::vector<std::uint32_t> indices;           ///< vertices of all corners
};

struct AssimpNode {
  std::uint32_t parent = 0;  ///< stands before it; the root is its own
  std::string name, collada_id;
  std::array<float, 16> place = {};  ///< relative to the parent, by rows
  std::vector<std::uint32_t> meshes;
};

struct AssimpCamera {
  std::string node;
  float aspect = 0, horizontal_angle = 0;
  std::array<float, 3> eye = {}, up = {}, forward = {};
};

struct AssimpLight {
  std::string node;
  std::uint32_t kind = 0;  ///< aiLightSourceType
  std::array<float, 3> place = {}, direction = {}, colour = {};
  float inner = 0, outer = 0;  ///< radians, of a spot's cones
};

struct AssimpImage {
  std::uint8_t is_bare = 0;  ///< of bare texels, which are left out
  std::string bytes;         ///< of an image file
};

struct AssimpScene {
  std::vector<AssimpNode> nodes;  ///< parents before children, in the file's order
  std::vector<AssimpMesh> meshes;
  std::vector<AssimpFileMaterial> materials;
  std::vector<AssimpCamera> cameras;
  std::vector<AssimpImage> images;
  std::vector<AssimpLight> lights;
  std::optional<double> centimetres;  ///< a unit, if the file says so
};

/// Appends values to bytes.
class AssimpWriter {
 public:
  template <class Number>
  void number(const Number& value) {
    raw(&value, sizeof(value));
  }
  template <class List>
  void length(const List& list) {
    number(std::uint64_t(list.size()));
  }
  template <class List>
  void whole(const List& list) {
    length(list);
    raw(list.data(), list.size() * sizeof(list[0]));
  }
  template <class Value>
  const Value* present(const std::optional<Value>& value) {
    number(std::uint8_t(value.has_value()));
    return value ? &*value : nullptr;
  }
  std::string bytes;

 private:
  void raw(const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  }
};

/// Takes values from bytes; std::runtime_error if there are too few. No list is longer than the
/// bytes that are left.
class AssimpParser {
 public:
  explicit AssimpParser(std::string_view bytes) : rest_(bytes) {}
  template <class Number>
  void number(Number& value) {
    raw(&value, sizeof(value));
  }
  template <class List>
  void length(List& list) {
    list.resize(count(1));
  }
  template <class List>
  void whole(List& list) {
    list.resize(count(sizeof(list[0])));
    raw(list.data(), list.size() * sizeof(list[0]));
  }
  template <class Value>
  Value* present(std::optional<Value>& value) {
    std::uint8_t given = 0;
    number(given);
    return given != 0 ? &value.emplace() : nullptr;
  }
  bool atEnd() const { return rest_.empty(); }

 private:
  std::size_t count(std::size_t size) {
    std::uint64_t given = 0;
    number(given);
    if (given > rest_.size() / size) throw std::runtime_error("too short");
    return std::size_t(given);
  }
  void raw(void* out, std::size_t size) {
    if (size > rest_.size()) throw std::runtime_error("too short");
    if (size > 0) std::memcpy(out, rest_.data(), size);
    rest_.remove_prefix(size);
  }

  std::string_view rest_;
};

// One function a structure passes it either way: with an AssimpWriter or an AssimpParser.

template <class Stream, class Value>
void passNumber(Stream& stream, Value& value) {
  if (auto* const number = stream.present(value)) stream.number(*number);
}

template <class Stream, class Material>
void passMaterial(Stream& stream, Material& material) {
  stream.whole(material.name);
  passNumber(stream, material.diffuse);
  passNumber(stream, material.emissive);
  passNumber(stream, material.two_sided);
  passNumber(stream, material.opacity);
  stream.number(material.diffuse_textures);
  stream.number(material.emissive_textures);
  stream.number(material.opacity_textures);
  stream.number(material.normal_textures);
  stream.number(material.height_textures);
  auto* const texture = stream.present(material.texture);
  if (texture == nullptr) return;
  stream.whole(texture->path);
  stream.number(texture->by_coordinates);
  stream.number(texture->set);
  stream.number(texture->blend);
  stream.number(texture->wrap);
  passNumber(stream, texture->embedded);
}

template <class Stream, class Mesh>
void passMesh(Stream& stream, Mesh& mesh) {
  stream.whole(mesh.name);
  stream.number(mesh.material);
  stream.whole(mesh.vertices);
  stream.whole(mesh.colours);
  stream.whole(mesh.texcoords);
  stream.whole(mesh.corners);
  stream.whole(mesh.indices);
}

template <class Stream, class Node>
void passNode(Stream& stream, Node& node) {
  stream.number(node.parent);
  stream.whole(node.name);
  stream.whole(node.collada_id);
  stream.number(node.place);
  stream.whole(node.meshes);
}

template <class Stream, class Camera>
void passCamera(Stream& stream, Camera& camera) {
  stream.whole(camera.node);
  stream.number(camera.aspect);
  stream.number(camera.horizontal_angle);
  stream.number(camera.eye);
  stream.number(camera.up);
  stream.number(camera.forward);
}

template <class Stream, class Light>
void passLight(Stream& stream, Light& light) {
  stream.whole(light.node);
  stream.number(light.kind);
  stream.number(light.place);
  stream.number(light.direction);
  stream.number(light.colour);
  stream.number(light.inner);
  stream.number(light.outer);
}

template <class Stream, class Scene>
void passScene(Stream& stream, Scene& scene) {
  const auto all = [&stream](auto& list, const auto& pass) {
    stream.length(list);
    for (auto& element : list) pass(element);
  };
  all(scene.nodes, [&](auto& node) { passNode(stream, node); });
  all(scene.meshes, [&](auto& mesh) { passMesh(stream, mesh); });
  all(scene.materials, [&](auto& material) { passMaterial(stream, material); });
  all(scene.cameras, [&](auto& camera) { passCamera(stream, camera); });
  all(scene.images, [&](auto& image) {
    stream.number(image.is_bare);
    stream.whole(image.bytes);
  });
  all(scene.lights, [&](auto& light) { passLight(stream, light); });
  passNumber(stream, scene.centimetres);
}

}  // namespace radiosity
