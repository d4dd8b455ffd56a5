#include "base/process_memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace radiosity {

std::size_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0;
  std::size_t resident = 0;
  if (!(file >> all >> resident)) return 0;
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

std::size_t peakBytes() {
  rusage usage{};
  constexpr std::size_t kKibibyte = 1024;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? std::size_t(usage.ru_maxrss) * kKibibyte : 0;
}

void returnFreedMemory() { malloc_trim(0); }

}  // namespace radiosity
