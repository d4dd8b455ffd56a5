// Files in memory that Assimp reads instead of those on disk.
#pragma once

#include <assimp/cfileio.h>

#include <functional>
#include <map>
#include <string>

namespace radiosity {

/// The files that Assimp opens; each path is read once.
class AssimpFiles {
 public:
  /// Returns the content of a path; the words of exceptions are kept.
  using Read = std::function<std::string(const std::string& path)>;

  explicit AssimpFiles(Read read);
  AssimpFiles(const AssimpFiles&) = delete;
  AssimpFiles& operator=(const AssimpFiles&) = delete;

  /// For aiImportFileExWithProperties(); valid as long as this object lives.
  aiFileIO* io() { return &io_; }
  /// The words of the first exception of reading; empty if there was none.
  const std::string& refusal() const { return refusal_; }

 private:
  static aiFile* open(aiFileIO* io, const char* path, const char* mode);
  static void close(aiFileIO* io, aiFile* file);

  Read read_;
  aiFileIO io_{};
  std::map<std::string, std::string> content_;  ///< by path
  std::map<std::string, int> open_;             ///< by path: how many times it is open now
  std::string refusal_;
};

}  // namespace radiosity
