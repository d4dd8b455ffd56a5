// Compressed geometry of glTF files, unpacked before the file is parsed.
#pragma once

#include <string>

namespace radiosity {

/// Whether gltfWithoutCompression() unpacks the data of an extension.
bool isGltfCompression(const std::string& extension);

/// A glTF file (JSON or binary, checked by checkGltf()) without compressed geometry: `content` as
/// it is if it has none, else a binary file with the same nodes, meshes, materials and images,
/// whose one buffer holds the unpacked data. Unpacks KHR_draco_mesh_compression by Draco, and
/// EXT_meshopt_compression by meshoptimizer. Buffers in other files are looked for beside `path`.
/// Errors: InputError "PATH: ELEMENT: what is wrong; cure".
std::string gltfWithoutCompression(const std::string& path, std::string content);

}  // namespace radiosity
