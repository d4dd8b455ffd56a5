// The chunks of a binary glTF file (glTF 2.0, 4.4).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace radiosity {

/// The next multiple of 4: chunks end and attributes begin there.
constexpr std::size_t paddedTo4(std::size_t size) { return (size + 3) / 4 * 4; }

/// True for a binary file, with any extension.
bool isGlb(std::string_view content);

struct GlbChunks {
  std::string_view json;
  std::string_view binary;  ///< empty if there is none
};

/// The chunks of a .glb, which must lie within the file. Errors: InputError "PATH: what is wrong;
/// cure".
GlbChunks glbChunks(const std::string& path, std::string_view content);

/// All of a .glb before the `binary_size` bytes, a multiple of 4, of its binary chunk. Errors:
/// RunError if the file would hold more than 4 GiB.
std::string glbBeginning(const std::string& path, std::string_view json, std::size_t binary_size);

}  // namespace radiosity
