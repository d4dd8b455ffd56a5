// A parsed glTF file with every reference checked, since the library checks few of them.
#pragma once

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <span>
#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// Whether we read an extension.
bool isSupportedGltfExtension(const std::string& name);

/// Points, spots and suns.
inline constexpr const char* kGltfLights = "KHR_lights_punctual";

/// Whether an extension is about materials, textures, lights or what else does not move a vertex. A
/// file that requires one that we do not read can be read without it.
bool leavesGeometry(const std::string& name);

/// A member of a value of an extension; null where the value is no object or has none so called.
inline const tinygltf::Value& memberOf(const tinygltf::Value& value, const std::string& key) {
  static const tinygltf::Value kNull;
  return value.IsObject() ? value.Get(key) : kNull;
}

struct GltfFile {
  std::string path;
  tinygltf::Model model;

  [[noreturn]] void fail(const std::string& what) const { throw InputError(path + ": " + what); }

  /// elements[index], or an InputError "PATH: WHAT refers to KIND 7, which does not exist".
  template <class Element>
  const Element& at(const std::vector<Element>& elements, int index, const char* kind,
                    const std::string& what) const {
    if (index < 0 || std::size_t(index) >= elements.size()) {
      fail(fmt::format("{} refers to {} {}, which does not exist; export the scene again", what,
                       kind, index));
    }
    return elements[std::size_t(index)];
  }

  /// All values of an accessor of `components` numbers an element, row-major; normalised integers
  /// are mapped to [-1, 1] or [0, 1]; sparse ones are filled in.
  std::vector<double> readNumbers(int accessor, int components, const std::string& what) const;

  /// All values of an index accessor.
  std::vector<Index> readIndices(int accessor, const std::string& what) const;

  /// The RGB values of a colour attribute; alpha is ignored.
  std::vector<Vec3> readColours(int accessor, const std::string& what) const;

  /// The encoded image (PNG, JPEG); empty if its file is missing.
  std::span<const unsigned char> imageBytes(const tinygltf::Image& image,
                                            const std::string& what) const;

 private:
  const unsigned char* viewBytes(int view, std::size_t offset, std::size_t stride,
                                 std::size_t element, std::size_t count,
                                 const std::string& what) const;
  void requireData(const tinygltf::Accessor& accessor, const std::string& what) const;
  void applySparse(const tinygltf::Accessor& accessor, int components, std::vector<double>& values,
                   const std::string& what) const;
};

/// The content of a glTF file, JSON or binary, with its version and required extensions checked and
/// its geometry without compression.
std::string readGltf(const std::string& path);

/// Parses such content; `path` tells where other files lie. Images stay encoded.
GltfFile parseGltfContent(const std::string& path, const std::string& content);

/// Reads and parses a file.
GltfFile parseGltf(const std::string& path);

}  // namespace radiosity
