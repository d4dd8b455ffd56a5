#include "base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <set>
#include <system_error>
#include <utility>

#include "base/hash.h"
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

bool isTemporary(const std::string& path) {
  const std::lock_guard lock(files().mutex);
  return files().temporaries.contains(path);
}

std::string folderOf(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path().string() : ".";
}

/// What all temporary files of an output have in their names, however long its own name is.
std::string temporaryStem(const std::string& name) {
  Hash hash;
  hash.text(name);
  return fmt::format(".radiosity-{}-", hash.hex());
}

/// Locks an open file for as long as it is open, without waiting. The lock is of the open file, not
/// of the process, so that writers may open and close the file, too.
bool lockWhole(int descriptor) {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  return fcntl(descriptor, F_OFD_SETLK, &whole) == 0;
}

/// Locks a file just made. True if another process has taken it for abandoned meanwhile. A system
/// without locks keeps what killed runs leave.
bool isLost(int descriptor) {
  if (!lockWhole(descriptor)) return errno == EAGAIN || errno == EACCES;
  struct stat now {};
  return fstat(descriptor, &now) == 0 && now.st_nlink == 0;
}

/// Removes the temporary files with that stem that no living process holds.
void removeAbandoned(const std::string& folder, const std::string& stem) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!it->path().filename().string().starts_with(stem)) continue;
    const int descriptor = open(it->path().c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) continue;
    if (lockWhole(descriptor)) unlink(it->path().c_str());
    close(descriptor);
  }
}

}  // namespace

std::string fileBehindLinks(const std::string& path) {
  constexpr int kMostLinks = 40;  // as Linux
  fs::path file(path);
  std::error_code error;
  for (int k = 0; k < kMostLinks && fs::is_symlink(file, error); ++k) {
    file = file.parent_path() / fs::read_symlink(file, error);
    if (error) return path;
  }
  return fs::is_symlink(file, error) ? path : file.string();
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  if (isTemporary(path_)) {
    temporary_ = path_;
    return;
  }
  const fs::path target(fileBehindLinks(path_));
  const std::string folder = folderOf(target);
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(
        fmt::format("{}: the folder {} does not exist; create it first", path_, folder));
  }
  const fs::file_status status = fs::status(target, error);
  if (status.type() == fs::file_type::directory) {
    throw InputError(fmt::format("{}: is a folder; name a file in it", path_));
  }
  if (error == std::errc::filename_too_long) {
    throw InputError(
        fmt::format("{}: the name is longer than the system allows, {} bytes; choose "
                    "a shorter one",
                    path_, target.filename().string().size()));
  }
  if (error == std::errc::too_many_symbolic_link_levels) {
    throw InputError(fmt::format("{}: is a link that leads to itself; name a file", path_));
  }
  if (fs::exists(status) && status.type() != fs::file_type::regular) {
    throw InputError(fmt::format(
        "{}: is a pipe or a device, which the output would replace; name a file", path_));
  }
  create(folder, target.filename().string());
  target_ = target.string();
}

void AtomicFile::create(const std::string& folder, const std::string& name) {
  const std::string stem = temporaryStem(name);
  removeAbandoned(folder, stem);
  const std::string extension = fs::path(name).extension().string();
  std::random_device random;
  const std::lock_guard lock(files().mutex);
  do {
    temporary_ =
        (fs::path(folder) / fmt::format("{}{:08x}.tmp{}", stem, random(), extension)).string();
    lock_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (lock_ >= 0 && isLost(lock_)) {
      close(lock_);
      lock_ = -1;
      errno = EEXIST;
    }
  } while (lock_ < 0 && errno == EEXIST);
  if (lock_ < 0) {
    throw InputError(fmt::format("{}: the folder {} cannot be written ({}); choose another", path_,
                                 folder, std::strerror(errno)));
  }
  files().temporaries.insert(temporary_);
}

AtomicFile::~AtomicFile() {
  if (lock_ < 0) return;
  const std::lock_guard lock(files().mutex);
  if (files().temporaries.erase(temporary_) > 0) unlink(temporary_.c_str());
  close(lock_);
}

void AtomicFile::commit() {
  if (target_.empty()) return;
  const std::lock_guard lock(files().mutex);
  struct stat before {};
  if (stat(target_.c_str(), &before) == 0) {
    constexpr mode_t kPermissions = 07777;
    fchmod(lock_, before.st_mode & kPermissions);
  }
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) throw RunError(fmt::format("{}: cannot be written: {}", path_, error.message()));
  files().temporaries.erase(temporary_);
  ++files().committed;
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

void writeWholeFile(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw RunError(fmt::format("{}: cannot be written; is the disk full?", path));
  file.commit();
}

}  // namespace radiosity
