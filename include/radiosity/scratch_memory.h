// Memory for what does not fit: a file that is mapped.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <memory_resource>
#include <mutex>
#include <string>
#include <vector>

#include "radiosity/base.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Memory that stands in a file without a name, which is gone when the process ends, however it
/// ends. What was not looked at lately is on the disk alone: those who walk through it say so by
/// touched(), and where more than `resident` bytes are in memory the process lets go of them all.
/// Values stay as they are. Any number of threads.
class ScratchMemory : public std::pmr::memory_resource {
 public:
  /// A file in `folder`. RunError, which names the folder, where it cannot be made.
  ScratchMemory(const std::string& folder, std::size_t resident);
  ~ScratchMemory() override;
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

  /// So many bytes of it are being read or written.
  void touched(std::size_t bytes);
  std::size_t resident() const { return resident_; }
  std::size_t fileBytes() const;

 private:
  struct Extent {
    std::byte* start = nullptr;
    std::size_t bytes = 0;
  };

  /// RunError where the disk is full.
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* place, std::size_t bytes, std::size_t alignment) override;
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }
  void addExtent(std::size_t bytes);

  std::string folder_;
  std::size_t resident_;
  std::atomic<std::size_t> others_;  // of mapped files but this one, in memory
  int file_ = -1;
  std::atomic<std::size_t> touched_{0};
  mutable std::mutex mutex_;
  std::vector<Extent> extents_;
  std::size_t used_ = 0;                            // of the last extent
  std::map<std::size_t, std::vector<void*>> free_;  // by size
};

}  // namespace radiosity
