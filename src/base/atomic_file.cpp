#include "base/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <set>
#include <system_error>
#include <utility>

#include "radiosity/base.h"

namespace radiosity {

namespace fs = std::filesystem;

namespace {

/// Temporary and committed files of this process.
struct Files {
  std::mutex mutex;
  std::set<std::string> temporaries;
  std::size_t committed = 0;
};

Files& files() {
  static Files all;
  return all;
}

}  // namespace

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
  if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored)) {
    throw InputError(fmt::format(
        "{}: is a pipe or a device, which the output would replace; name a file", path_));
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw InputError(
        fmt::format("{}: the folder {} cannot be written; choose another", path_, folder.string()));
  }
  // The number makes the name unique among threads, and among containers that share a folder and
  // use the same process number.
  temporary_ = (folder / fmt::format(".{}.{}-{:08x}.tmp{}", target.stem().string(), getpid(),
                                     std::random_device()(), target.extension().string()))
                   .string();
  const std::lock_guard lock(files().mutex);
  files().temporaries.insert(temporary_);
}

AtomicFile::~AtomicFile() {
  if (temporary_.empty()) return;
  const std::lock_guard lock(files().mutex);
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  files().temporaries.erase(temporary_);
}

void AtomicFile::commit() {
  const std::lock_guard lock(files().mutex);
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw RunError(fmt::format("{}: cannot be written: {}", path_, error.message()));
  files().temporaries.erase(temporary_);
  ++files().committed;
  temporary_.clear();
}

std::size_t committedFiles() {
  const std::lock_guard lock(files().mutex);
  return files().committed;
}

std::unique_lock<std::mutex> discardTemporaries() {
  std::unique_lock lock(files().mutex);
  std::error_code ignored;
  for (const std::string& name : files().temporaries) fs::remove(name, ignored);
  files().temporaries.clear();
  return lock;
}

}  // namespace radiosity
