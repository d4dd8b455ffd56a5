// Chunks of datasets, written into their places in a file without HDF5: by many threads, and by
// processes that share the file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/h5.h"

namespace radiosity::h5 {

/// A dataset of one dimension in a file whose chunks have their places and no values yet
/// (OutputGroup::reserve()).
struct ReservedColumn {
  std::string path;       ///< in the file
  std::size_t chunk = 1;  ///< values in a chunk; the last chunk is as long as the others
  std::vector<std::uint64_t> places;  ///< in the file, by chunk
};

/// A chunk as HDF5 stores it: the bytes and their Fletcher-32 checksum ("HDF5 File Format
/// Specification", IV.A.2.l). `data`: an even number of bytes below 2^25.
std::vector<unsigned char> storedChunk(std::span<const unsigned char> data);

/// A file into which chunks are written. Errors: RunError.
class ChunkFile {
 public:
  /// Opens the existing file `path`; messages call it `shown`.
  ChunkFile(const std::string& path, std::string shown);
  ~ChunkFile();
  ChunkFile(const ChunkFile&) = delete;
  ChunkFile& operator=(const ChunkFile&) = delete;
  /// Writes a chunk's values, with their checksum. Threads may do so together.
  void write(const ReservedColumn& column, std::size_t chunk,
             std::span<const unsigned char> data) const;
  /// Some systems report only now what they could not write.
  void close();
  const std::string& path() const { return path_; }
  const std::string& shown() const { return shown_; }

 private:
  [[noreturn]] void fail(const std::string& object) const;

  std::string path_;
  std::string shown_;
  int descriptor_ = -1;
};

}  // namespace radiosity::h5
