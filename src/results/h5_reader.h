// Reads groups of an HDF5 file; everything is checked before it is used.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/input_file.h"
#include "results/h5.h"

namespace radiosity::h5 {

/// An HDF5 file open for reading. Errors are InputError: file, object in it, reason and cure.
class InputFile {
 public:
  explicit InputFile(const std::string& path);
  hid_t id() const { return file_.get(); }
  const std::string& path() const { return path_; }
  /// The length of the file.
  std::size_t bytes() const;
  /// "FILE: OBJECT WHAT; make the file again".
  [[noreturn]] void fail(const std::string& object, const std::string& what) const;
  /// The same, with HDF5's own reason.
  [[noreturn]] void failDamaged(const std::string& object) const;
  /// Refuses a file with objects that are not as we write them (h5_contents.h). To be called before
  /// anything but attributes of the root is read.
  void requireOwnObjects() const;

 private:
  mutable Silence silence_;  // first: outlives the handle
  std::string path_;
  Handle file_;
};

/// Returns the result of `read` for the file at `path`, and tries again if the file seems damaged
/// and has changed. Another run may switch the file to a new state between two reads of HDF5
/// (h5_disk.h), for instance of its length and of its first page.
template <class Read>
auto readSettled(const std::string& path, const Read& read) {
  constexpr int kMostTries = 100;  // other runs may replace the file all the time
  for (int tries = 1;; ++tries) {
    const std::string state = fileState(path);
    try {
      return read();
    } catch (const InputError&) {
      if (fileState(path) == state || tries == kMostTries) throw;
    }
  }
}

class InputGroup {
 public:
  explicit InputGroup(const InputFile& file);  ///< the root
  /// Whether there is a group or dataset of that name.
  bool has(const std::string& name) const;
  bool hasAttribute(const std::string& name) const;
  InputGroup group(const std::string& name) const;
  /// Reads an attribute of exactly `count` numbers of that kind.
  void attribute(const std::string& name, Number number, std::size_t count, void* data) const;
  std::string text(const std::string& name) const;
  std::vector<std::string> strings(const std::string& name) const;

  /// Opens a dataset of numbers and checks kind and number of columns; sets `rows`.
  Handle open(const std::string& name, Number number, std::size_t columns, std::size_t& rows) const;
  /// The number of columns of a dataset of rows, 1 or more.
  int columns(const std::string& name) const;
  /// The kind of the numbers in a dataset; empty if it is none of ours.
  std::optional<Number> numberOfDataset(const std::string& name) const;
  void readAll(const std::string& name, const Handle& dataset, Number number, void* data) const;
  /// Reads rows [first, first + count) of a dataset of one dimension.
  void readRows(const std::string& name, const Handle& dataset, Number number, std::size_t first,
                std::size_t count, void* data) const;

  std::string pathOf(const std::string& name) const { return path_ + "/" + name; }
  [[noreturn]] void fail(const std::string& name, const std::string& what) const {
    file_->fail(pathOf(name), what);
  }
  /// "holds VALUE at ROW", of a dataset.
  [[noreturn]] void failAt(const std::string& name, std::size_t row, double value) const;

 private:
  InputGroup(const InputFile& file, Handle id, std::string path);
  Handle checked(hid_t id, Handle::Close close, const std::string& name) const;
  Handle openAny(const std::string& name, std::vector<hsize_t>& extent) const;
  void checkStorage(const std::string& name, const Handle& dataset, std::size_t rows,
                    std::size_t row_bytes) const;

  const InputFile* file_;
  Handle id_;
  std::string path_;
};

}  // namespace radiosity::h5
