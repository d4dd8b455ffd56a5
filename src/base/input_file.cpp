#include "base/input_file.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "radiosity/base.h"

namespace radiosity {

namespace fs = std::filesystem;

namespace {

/// The files that were found, by device and number. Files beside a scene are opened by readers and
/// by libraries' callbacks, so that no caller has a list of them.
class FoundFiles {
 public:
  void add(const std::string& path) {
    const Id id = idOf(path);
    const std::lock_guard lock(mutex_);
    ids_.insert(id);
  }
  bool contains(const std::string& path) {
    const Id id = idOf(path);
    const std::lock_guard lock(mutex_);
    return id != Id() && ids_.contains(id);
  }

 private:
  using Id = std::pair<dev_t, ino_t>;
  static Id idOf(const std::string& path) {
    struct stat s {};
    return stat(path.c_str(), &s) == 0 ? Id(s.st_dev, s.st_ino) : Id();
  }
  std::mutex mutex_;
  std::set<Id> ids_;
};

FoundFiles& foundFiles() {
  static FoundFiles files;
  return files;
}

}  // namespace

bool wasFound(const std::string& path) { return foundFiles().contains(path); }

std::string whyNotAFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  switch (status.type()) {
    case fs::file_type::regular:
      if (access(path.c_str(), R_OK) == 0) {
        foundFiles().add(path);
        return {};
      }
      return fmt::format("cannot be opened ({}); check the permissions",
                         std::generic_category().message(errno));
    case fs::file_type::not_found:
      return "no such file; check the name and the folder";
    case fs::file_type::directory:
      return "is a folder; name a file in it";
    case fs::file_type::none:
    case fs::file_type::unknown:
      return fmt::format("cannot be opened ({}); check the name and the permissions",
                         error.message());
    default:
      return "is a pipe or a device, not a file; copy what it holds into a file first";
  }
}

void requireFile(const std::string& path) {
  const std::string why = whyNotAFile(path);
  if (!why.empty()) throw InputError(fmt::format("{}: {}", path, why));
}

std::string readWholeFile(const std::string& path) {
  requireFile(path);
  std::error_code ignored;
  const auto size = fs::file_size(path, ignored);
  if (size == 0) {
    throw InputError(fmt::format("{}: the file is empty; export it again", path));
  }
  std::string content;
  try {
    content.resize(size);
  } catch (const std::exception&) {  // bad_alloc, or longer than a string can be
    throw RunError(fmt::format("{}: its {} bytes do not fit into memory", path, size));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream.read(content.data(), std::streamsize(size))) {
    throw InputError(fmt::format("{}: cannot be read; check its permissions", path));
  }
  return content;
}

std::string fileState(const std::string& path) {
  struct stat s {};
  if (stat(path.c_str(), &s) != 0) return {};
  return fmt::format("{}:{}:{}:{}.{}", s.st_dev, s.st_ino, s.st_size, s.st_mtim.tv_sec,
                     s.st_mtim.tv_nsec);
}

}  // namespace radiosity
