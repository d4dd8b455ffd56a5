// Outputs appear whole or not at all.
#pragma once

#include <cstddef>
#include <mutex>
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

/// The number of files that this process has committed.
std::size_t committedFiles();

/// Removes the temporary files that are not committed, for a process that is about to end without
/// destructors. While the returned lock is held, no file is committed, made or removed.
std::unique_lock<std::mutex> discardTemporaries();

}  // namespace radiosity
