// Outputs appear whole or not at all.
#pragma once

#include <string>

namespace radiosity {

/// A temporary name beside `path` with the same extension. commit() renames it to `path`; without
/// commit() the destructor removes it. Errors: InputError if the folder does not exist or cannot
/// be written, RunError if the rename fails.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  const std::string& temporary() const { return temporary_; }
  void commit();

 private:
  std::string path_;
  std::string temporary_;
};

}  // namespace radiosity
