// Arrays of an XML VTK file: text, inline base64, or appended; packed or not.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/base.h"
#include "scene/mesh_cursor.h"

namespace radiosity {

enum class VtkPacking { none, zlib, lz4, lzma };

/// The packing of blocks by the name of the compressor; an empty name means no packing. Empty for
/// an unknown compressor.
std::optional<VtkPacking> vtkPacking(std::string_view compressor);

/// The file as a whole.
struct VtkFile {
  std::string path;
  Encoding order = Encoding::little;  ///< of bytes
  bool wide_header = false;           ///< header_type UInt64, not UInt32
  VtkPacking packing = VtkPacking::none;
  bool appended_is_raw = false;  ///< else base64
  std::string_view appended;     ///< the data after the underscore
};

/// One DataArray element.
struct VtkArray {
  std::string name;
  std::string type;    ///< Float32, Int64, String, ...
  std::string format;  ///< ascii, binary or appended
  std::string_view text;
  std::size_t offset = 0;  ///< into VtkFile::appended
  std::size_t most = 0;    ///< values to which it may unpack, as the file declares them
};

/// The numbers of an array of coordinates, all finite.
std::vector<double> vtkNumbers(const VtkFile& file, const VtkArray& array);
/// The numbers of an array of integers.
std::vector<long long> vtkIntegers(const VtkFile& file, const VtkArray& array);
/// The words of an array of type String: characters, with a 0 at the end of each word.
std::vector<std::string> vtkWords(const VtkFile& file, const VtkArray& array);

}  // namespace radiosity
