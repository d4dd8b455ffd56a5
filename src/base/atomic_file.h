// Outputs appear whole or not at all.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>

namespace radiosity {

/// The file that a name stands for: behind links, also where it does not exist yet. Outputs are
/// written there, and links stay. A link that leads to itself is returned as it is.
std::string fileBehindLinks(const std::string& path);

/// An empty temporary file beside the file that `path` stands for, with the same extension.
/// commit() renames it to that file, with the permissions of a file that it replaces; without
/// commit() the destructor removes it. A file that a killed run left beside the same output is
/// removed first. On the temporary file of another AtomicFile of this process it is that file: a
/// writer that makes its own need not know. Errors: InputError if the folder does not exist or
/// cannot be written, if the name is too long, or if it stands for no file; RunError if the rename
/// fails.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  const std::string& temporary() const { return temporary_; }
  void commit();

 private:
  void create(const std::string& folder, const std::string& name);

  std::string path_;    ///< as given
  std::string target_;  ///< behind links; empty: within another AtomicFile
  std::string temporary_;
  int lock_ = -1;  ///< holds a lock on the temporary file as long as this process lives
};

/// Writes a file whole. Errors: as AtomicFile; RunError if it cannot be written.
void writeWholeFile(const std::string& path, std::string_view text);

/// The number of files that this process has committed.
std::size_t committedFiles();

/// Removes the temporary files that are not committed, for a process that is about to end without
/// destructors. While the returned lock is held, no file is committed, made or removed.
std::unique_lock<std::mutex> discardTemporaries();

}  // namespace radiosity
