// Arrays of an XML VTK file: text, base64 in place, or appended, packed or not.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/base.h"
#include "scene/mesh_cursor.h"

namespace radiosity {

enum class VtkPacking { none, zlib, lz4, lzma };

/// How a file packs blocks, by the name of the compressor; empty: not at all. None: it is not
/// known.
std::optional<VtkPacking> vtkPacking(std::string_view compressor);

/// The file as a whole.
struct VtkFile {
  std::string path;
  Encoding order = Encoding::little;  ///< of bytes
  bool wide_header = false;           ///< header_type UInt64, not UInt32
  VtkPacking packing = VtkPacking::none;
  bool appended_is_raw = false;  ///< else base64
  std::string_view appended;     ///< what stands behind the underscore
};

/// One DataArray element.
struct VtkArray {
  std::string name;
  std::string type;    ///< Float32, Int64, String, ...
  std::string format;  ///< ascii, binary or appended
  std::string_view text;
  std::size_t offset = 0;  ///< into VtkFile::appended
};

/// Numbers of an array that are coordinates, finite.
std::vector<double> vtkNumbers(const VtkFile& file, const VtkArray& array);
/// Whole numbers of an array of integers.
std::vector<long long> vtkIntegers(const VtkFile& file, const VtkArray& array);
/// Words of an array of type String: characters, each word with a 0 at its end.
std::vector<std::string> vtkWords(const VtkFile& file, const VtkArray& array);

}  // namespace radiosity
