#include "base/process_memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace radiosity {

namespace {

struct ResidentPages {
  std::size_t all = 0;
  std::size_t of_files = 0;
};

ResidentPages residentPages() {
  std::ifstream file("/proc/self/statm");
  std::size_t mapped = 0;
  ResidentPages pages;
  if (!(file >> mapped >> pages.all >> pages.of_files)) return {};
  return pages;
}

std::size_t pageBytes() { return std::size_t(sysconf(_SC_PAGESIZE)); }

}  // namespace

std::size_t residentBytes() { return residentPages().all * pageBytes(); }

std::size_t residentFileBytes() { return residentPages().of_files * pageBytes(); }

std::size_t peakBytes() {
  rusage usage{};
  constexpr std::size_t kKibibyte = 1024;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? std::size_t(usage.ru_maxrss) * kKibibyte : 0;
}

void returnFreedMemory() { malloc_trim(0); }

}  // namespace radiosity
