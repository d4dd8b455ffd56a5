#include "base/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "radiosity/base.h"

namespace radiosity {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  const fs::path target(path_);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    throw InputError(
        fmt::format("{}: the folder {} does not exist; create it first", path_, folder.string()));
  }
  if (fs::is_directory(target, ignored)) {
    throw InputError(fmt::format("{}: is a folder; name a file in it", path_));
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw InputError(
        fmt::format("{}: the folder {} cannot be written; choose another", path_, folder.string()));
  }
  temporary_ = (folder / fmt::format(".{}.{}.tmp{}", target.stem().string(), getpid(),
                                     target.extension().string()))
                   .string();
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw RunError(fmt::format("{}: cannot be written: {}", path_, error.message()));
  temporary_.clear();
}

}  // namespace radiosity
