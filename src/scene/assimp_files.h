// Files in memory that Assimp reads in place of those on disk.
#pragma once

#include <assimp/cfileio.h>

#include <exception>
#include <functional>
#include <map>
#include <string>

namespace radiosity {

/// What Assimp opens, each path asked for once.
class AssimpFiles {
 public:
  /// The content that a path stands for; what it throws is kept for rethrow().
  using Read = std::function<std::string(const std::string& path)>;

  explicit AssimpFiles(Read read);
  AssimpFiles(const AssimpFiles&) = delete;
  AssimpFiles& operator=(const AssimpFiles&) = delete;

  /// For aiImportFileExWithProperties(); valid as long as this is.
  aiFileIO* io() { return &io_; }
  /// Throws the first of what reading threw, if anything did.
  void rethrow() const;

 private:
  static aiFile* open(aiFileIO* io, const char* path, const char* mode);
  static void close(aiFileIO* io, aiFile* file);

  Read read_;
  aiFileIO io_{};
  std::map<std::string, std::string> content_;  ///< by path
  std::map<std::string, int> open_;             ///< by path: how many times at this moment
  std::exception_ptr failed_;
};

}  // namespace radiosity
