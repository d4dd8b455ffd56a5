#include "radiosity/scratch_memory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "base/process_memory.h"
#include "radiosity/spelling.h"

namespace radiosity {

namespace {

/// The file grows by this many bytes, or by the size of a larger block.
constexpr std::size_t kExtent = std::size_t(1) << 26;
constexpr std::size_t kPage = std::size_t(1) << 12;
constexpr std::size_t kAlignment = 64;
/// We check the resident bytes after each sixteenth of the permitted bytes is touched: the system
/// maps up to 16 pages around a touched one.
constexpr std::size_t kLooks = 16;

/// Rounds up to block sizes an eighth apart, so that freed blocks can be used again.
std::size_t sizeClass(std::size_t bytes) {
  constexpr std::size_t kSteps = 8;
  const std::size_t step =
      std::max(kAlignment, std::bit_floor(std::max<std::size_t>(bytes, 1)) / kSteps);
  return (bytes + step - 1) / step * step;
}

}  // namespace

ScratchMemory::ScratchMemory(const std::string& folder, std::size_t resident)
    : folder_(folder), resident_(resident), others_(residentFileBytes()) {
  std::string name = folder + "/radiosity-scratch-XXXXXX";
  file_ = mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) {
    throw RunError(
        fmt::format("{}: no scratch file can be made here: {}; raise {}, or "
                    "write the output to another folder",
                    folder, std::strerror(errno), spelled("memory_limit")));
  }
  unlink(name.c_str());
}

ScratchMemory::~ScratchMemory() {
  for (const Extent& extent : extents_) munmap(extent.start, extent.bytes);
  close(file_);
}

void ScratchMemory::touched(std::size_t bytes) {
  if (touched_.fetch_add(bytes, std::memory_order_relaxed) + bytes < resident_ / kLooks) return;
  touched_.store(0, std::memory_order_relaxed);
  if (residentFileBytes() < others_ + resident_) return;
  const std::lock_guard lock(mutex_);
  // The pages of a shared mapping stay in the file, changed ones too, and are read when needed.
  for (const Extent& extent : extents_) madvise(extent.start, extent.bytes, MADV_DONTNEED);
  others_ = residentFileBytes();
}

std::size_t ScratchMemory::fileBytes() const {
  const std::lock_guard lock(mutex_);
  std::size_t total = 0;
  for (const Extent& extent : extents_) total += extent.bytes;
  return total;
}

void ScratchMemory::addExtent(std::size_t bytes) {
  std::size_t end = 0;
  for (const Extent& extent : extents_) end += extent.bytes;
  const auto refuse = [&](int error) {
    throw RunError(
        fmt::format("{}: a scratch file of {:.1f} GiB does not fit here: {}; make room, "
                    "raise {} or mesh with fewer patches",
                    folder_, double(end + bytes) / double(std::size_t(1) << 30),
                    std::strerror(error), spelled("memory_limit")));
  };
  // We allocate the space now: writing to a hole in the file on a full disk would kill the process.
  if (const int error = posix_fallocate(file_, off_t(end), off_t(bytes)); error != 0) refuse(error);
  void* start = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, off_t(end));
  if (start == MAP_FAILED) refuse(errno);
  extents_.push_back({static_cast<std::byte*>(start), bytes});
  used_ = 0;
}

void* ScratchMemory::do_allocate(std::size_t bytes, std::size_t /*alignment*/) {
  const std::size_t size = sizeClass(bytes);
  const std::lock_guard lock(mutex_);
  if (const auto found = free_.find(size); found != free_.end() && !found->second.empty()) {
    void* place = found->second.back();
    found->second.pop_back();
    return place;
  }
  if (extents_.empty() || extents_.back().bytes - used_ < size) {
    addExtent(std::max(kExtent, (size + kPage - 1) / kPage * kPage));
  }
  void* place = extents_.back().start + used_;
  used_ += size;
  return place;
}

void ScratchMemory::do_deallocate(void* place, std::size_t bytes, std::size_t /*alignment*/) {
  const std::lock_guard lock(mutex_);
  free_[sizeClass(bytes)].push_back(place);
}

}  // namespace radiosity
