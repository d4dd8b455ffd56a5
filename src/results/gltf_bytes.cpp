#include "results/gltf_bytes.h"

#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

namespace radiosity {
namespace {

template <class T>
double storeAs(double value, bool normalised, char* bytes) {
  if constexpr (std::is_integral_v<T>) {
    value = std::round(normalised ? value * double(std::numeric_limits<T>::max()) : value);
  }
  const auto stored = T(value);
  std::memcpy(bytes, &stored, sizeof stored);
  return double(stored);
}

}  // namespace

double storeComponent(double value, int type, bool normalised, char* bytes) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return storeAs<std::int8_t>(value, normalised, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return storeAs<std::uint8_t>(value, normalised, bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return storeAs<std::int16_t>(value, normalised, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return storeAs<std::uint16_t>(value, normalised, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return storeAs<std::uint32_t>(value, normalised, bytes);
    default:
      return storeAs<float>(value, false, bytes);
  }
}

std::string gltfTypeName(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return "SCALAR";
    case TINYGLTF_TYPE_VEC2:
      return "VEC2";
    case TINYGLTF_TYPE_VEC3:
      return "VEC3";
    default:
      return "VEC4";  // attributes are never matrices
  }
}

std::string mimeTypeOf(std::span<const unsigned char> image) {
  const std::string_view bytes(reinterpret_cast<const char*>(image.data()), image.size());
  if (bytes.starts_with("\x89PNG")) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
  if (bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.substr(8, 4) == "WEBP") {
    return "image/webp";
  }
  return {};
}

}  // namespace radiosity
