// Memory for data that does not fit: a mapped file.
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

/// Memory in an unnamed file, which is gone when the process ends, however it ends. Pages that were
/// not used lately are on the disk alone. Code that walks through the memory reports it by
/// touched(); if more than `resident` bytes are then in memory, the process lets go of them all.
/// Values stay as they are. Any number of threads.
class ScratchMemory : public std::pmr::memory_resource {
 public:
  /// Makes a file in `folder`. RunError, which names the folder, if that fails.
  ScratchMemory(const std::string& folder, std::size_t resident);
  ~ScratchMemory() override;
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

  /// Reports that `bytes` of it are being read or written.
  void touched(std::size_t bytes);
  std::size_t resident() const { return resident_; }
  std::size_t fileBytes() const;

 private:
  struct Extent {
    std::byte* start = nullptr;
    std::size_t bytes = 0;
  };

  /// RunError if the disk is full.
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* place, std::size_t bytes, std::size_t alignment) override;
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }
  void addExtent(std::size_t bytes);

  std::string folder_;
  std::size_t resident_;
  std::atomic<std::size_t> others_;  // of other mapped files, in memory
  int file_ = -1;
  std::atomic<std::size_t> touched_{0};
  mutable std::mutex mutex_;
  std::vector<Extent> extents_;
  std::size_t used_ = 0;                            // of the last extent
  std::map<std::size_t, std::vector<void*>> free_;  // by size
};

}  // namespace radiosity
