// Checks a glTF file before the library reads it, since the library trusts sizes and nesting.
#pragma once

#include <string>
#include <string_view>

namespace radiosity {

/// The JSON of a .gltf or, once checkGltf() has seen it, of a .glb.
std::string_view gltfJson(const std::string& path, std::string_view content);

/// Checks the chunks of a .glb (glTF 2.0, 4.4), the nesting of the JSON, the version and the
/// required extensions. Errors: InputError "PATH: what is wrong; cure".
void checkGltf(const std::string& path, std::string_view content);

}  // namespace radiosity
