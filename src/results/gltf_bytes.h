// Stores numbers of glTF accessors as bytes.
#pragma once

#include <span>
#include <string>

namespace radiosity {

/// Stores a value as a component of `type` (glTF 2.0, 3.6.2.2); a normalised integer stands for a
/// fraction. Returns the stored number.
double storeComponent(double value, int type, bool normalised, char* bytes);

/// "VEC3" of TINYGLTF_TYPE_VEC3.
std::string gltfTypeName(int type);

/// "image/png", "image/jpeg" or "image/webp", by the first bytes; empty for others.
std::string mimeTypeOf(std::span<const unsigned char> image);

}  // namespace radiosity
