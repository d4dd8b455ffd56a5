// Writes groups of an HDF5 file, or only counts their bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/h5.h"
#include "results/h5_chunks.h"
#include "results/h5_disk.h"

namespace radiosity::h5 {

/// An HDF5 file being written. Every method throws RunError if HDF5 cannot write. The format is
/// that of HDF5 1.10 (2016), in which every piece of metadata has a checksum.
class OutputFile {
 public:
  /// Writes `path`; messages call it `shown`.
  OutputFile(const std::string& path, std::string shown);
  /// Opens an existing file for extension (Disk); null if that is not possible.
  static std::unique_ptr<OutputFile> extend(const std::string& path);
  /// Flushes and closes. Without this call the destructor closes and ignores errors.
  void close();
  /// Closes an extended file. False if it could not be switched to its new state: then it is
  /// unchanged.
  bool closeExtended();
  /// The old end of an extended file.
  std::uint64_t oldEnd() const { return disk_.oldEnd(); }
  hid_t id() const { return file_.get(); }
  Disk& disk() { return disk_; }
  /// The same file, to write reserved chunks into.
  const ChunkFile& chunks();
  [[noreturn]] void fail(const std::string& object) const;
  /// Throws if the disk has refused anything so far.
  void check(const std::string& object) const {
    if (disk_.error() != 0) fail(object);
  }

 private:
  explicit OutputFile(Disk::Mode mode) : disk_(mode) {}

  Silence silence_;  // these two first: they outlive the handle
  Disk disk_;
  std::string path_;
  std::string shown_;
  Handle file_;
  std::optional<ChunkFile> chunks_;
};

/// A group to put attributes, datasets and groups into.
class OutputGroup {
 public:
  explicit OutputGroup(OutputFile& file);  ///< the root
  OutputGroup group(const std::string& name);
  void attribute(const std::string& name, Number number, std::size_t count, const void* data);
  void text(const std::string& name, const std::string& value);
  /// `unit` becomes an attribute; empty: none.
  void dataset(const std::string& name, const Shape& shape, const void* data,
               const std::string& unit);
  void strings(const std::string& name, const std::vector<std::string>& values);
  /// A second name for an object of `target`; takes no data.
  void link(const std::string& name, const OutputGroup& target, const std::string& target_name);
  bool has(const std::string& name) const;
  /// Gives the object `fresh` the name `name`. The object that had the name is lost.
  void replace(const std::string& name, const std::string& fresh);
  void remove(const std::string& name);
  /// The number in an attribute; empty if there is none.
  std::optional<std::uint64_t> number(const std::string& name) const;
  /// Whether the text `name` of the group `group` in this one is `value`.
  bool says(const std::string& group, const std::string& name, const std::string& value) const;
  /// Makes a dataset of one dimension, of more than kCompactBytes, whose chunks have their places;
  /// the caller writes them (ChunkFile).
  ReservedColumn reserve(const std::string& name, Number number, std::size_t count);
  /// The file, to write reserved chunks into.
  const ChunkFile& chunks() { return file_->chunks(); }

 private:
  OutputGroup(OutputFile& file, Handle id, std::string path);
  std::string pathOf(const std::string& name) const { return path_ + "/" + name; }
  Handle create(const std::string& name, const Shape& shape, const std::string& unit);
  Handle checked(hid_t id, Handle::Close close, const std::string& name) const;
  void writeText(hid_t object, const std::string& name, const std::string& value);

  OutputFile* file_;
  Handle id_;
  std::string path_;
};

/// Takes the same calls as OutputGroup and adds up the bytes that they would write.
class SizeCounter {
 public:
  explicit SizeCounter(std::size_t& bytes) : bytes_(&bytes) {}
  SizeCounter group(const std::string& name);
  void attribute(const std::string& name, Number number, std::size_t count, const void* data);
  void text(const std::string& name, const std::string& value);
  void dataset(const std::string& name, const Shape& shape, const void* data,
               const std::string& unit);
  void strings(const std::string& name, const std::vector<std::string>& values);
  void link(const std::string& name, const SizeCounter& target, const std::string& target_name);

 private:
  void raw(const std::string& name, const Shape& shape, const std::string& unit);
  std::size_t* bytes_;
};

/// The width of the fixed-length column for all of `values`; at least 1.
std::size_t columnWidth(const std::vector<std::string>& values);

}  // namespace radiosity::h5
