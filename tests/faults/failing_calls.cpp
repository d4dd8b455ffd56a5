// Preloaded into the program: lets the k-th call of a system function fail, as a full disk, a torn
// network file or a lack of memory would. By environment variables:
//   FAULT_CALL   write (all that put bytes into a file), sync, rename, read, allocate
//   FAULT_AT     k, from 1; 0: none, calls are only counted
//   FAULT_LASTS  1: every later call fails, too, as on a full disk
//   FAULT_COUNT  a file that gets the numbers of calls of each kind when the process ends
// Reads and writes count if they are of regular files, allocations if they are of 64 KiB or more:
// smaller ones fail in every library alike, and no system refuses them.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum class Call { write, sync, rename, read, allocate, none };

struct Plan {
  Call call = Call::none;
  long at = 0;
  bool lasts = false;
  const char* count_file = nullptr;
};

Plan plan;
constexpr int kKinds = 5;
std::atomic<long> calls[kKinds];
thread_local bool inside = false;  // dlsym() and the like call these functions, too

Call callNamed(const char* name) {
  const char* const names[kKinds] = {"write", "sync", "rename", "read", "allocate"};
  for (int k = 0; k < kKinds; ++k) {
    if (std::strcmp(name, names[k]) == 0) return Call(k);
  }
  return Call::none;
}

__attribute__((constructor)) void readPlan() {
  const char* call = std::getenv("FAULT_CALL");
  const char* at = std::getenv("FAULT_AT");
  const char* lasts = std::getenv("FAULT_LASTS");
  plan = {call == nullptr ? Call::none : callNamed(call), at == nullptr ? 0 : std::atol(at),
          lasts != nullptr && lasts[0] == '1', std::getenv("FAULT_COUNT")};
}

__attribute__((destructor)) void tellCount() {
  if (plan.count_file == nullptr) return;
  char text[128];
  const int length =
      std::snprintf(text, sizeof text, "%ld %ld %ld %ld %ld", calls[0].load(), calls[1].load(),
                    calls[2].load(), calls[3].load(), calls[4].load());
  const int file = open(plan.count_file, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0 || write(file, text, std::size_t(length)) != length) std::abort();
  close(file);
}

/// Counts a call; true if it must fail.
bool fails(Call call) {
  const long number = ++calls[int(call)];
  return plan.call == call && plan.at > 0 &&
         (number == plan.at || (plan.lasts && number > plan.at));
}

/// Whether the descriptor is of a file on a disk: those of /proc have no size.
bool isFile(int descriptor, bool written) {
  struct stat state {};
  return fstat(descriptor, &state) == 0 && S_ISREG(state.st_mode) && (written || state.st_size > 0);
}

bool writeFails(int descriptor) {
  if (!isFile(descriptor, true) || !fails(Call::write)) return false;
  errno = ENOSPC;
  return true;
}

bool readFails(int descriptor) {
  if (!isFile(descriptor, false) || !fails(Call::read)) return false;
  errno = EIO;
  return true;
}

bool allocationFails(std::size_t bytes) {
  constexpr std::size_t kLeast = 65536;
  if (bytes < kLeast || inside || !fails(Call::allocate)) return false;
  errno = ENOMEM;
  return true;
}

/// The function that this library stands before.
template <class Function>
Function next(const char* name) {
  inside = true;
  auto* found = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
  inside = false;
  return found;
}

}  // namespace

#define NEXT(name) static auto* const before = next<decltype(&::name)>(#name)

// glibc declares some of them with exception specifications of its own.
extern "C" {

ssize_t write(int file, const void* data, std::size_t size) {
  NEXT(write);
  return writeFails(file) ? -1 : before(file, data, size);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  static auto* const before = next<ssize_t (*)(int, const struct iovec*, int)>("writev");
  return writeFails(file) ? -1 : before(file, parts, count);
}

ssize_t pwrite(int file, const void* data, std::size_t size, off_t at) {
  NEXT(pwrite);
  return writeFails(file) ? -1 : before(file, data, size, at);
}

ssize_t pwrite64(int file, const void* data, std::size_t size, off_t at) {
  NEXT(pwrite);
  return writeFails(file) ? -1 : before(file, data, size, at);
}

ssize_t pwritev(int file, const struct iovec* parts, int count, off_t at) {
  static auto* const before = next<ssize_t (*)(int, const struct iovec*, int, off_t)>("pwritev");
  return writeFails(file) ? -1 : before(file, parts, count, at);
}

int ftruncate(int file, off_t size) noexcept {
  NEXT(ftruncate);
  return writeFails(file) ? -1 : before(file, size);
}

// The C library's streams call their own write().
std::size_t fwrite(const void* data, std::size_t size, std::size_t count, FILE* stream) {
  NEXT(fwrite);
  return writeFails(fileno(stream)) ? 0 : before(data, size, count, stream);
}

int fclose(FILE* stream) {
  NEXT(fclose);
  const bool failed = writeFails(fileno(stream));
  const int result = before(stream);
  if (!failed) return result;
  errno = ENOSPC;
  return EOF;
}

int fsync(int file) {
  NEXT(fsync);
  if (!fails(Call::sync)) return before(file);
  errno = EIO;
  return -1;
}

int fdatasync(int file) {
  NEXT(fdatasync);
  if (!fails(Call::sync)) return before(file);
  errno = EIO;
  return -1;
}

int rename(const char* from, const char* to) noexcept {
  NEXT(rename);
  if (!fails(Call::rename)) return before(from, to);
  errno = EIO;
  return -1;
}

ssize_t read(int file, void* data, std::size_t size) {
  NEXT(read);
  return readFails(file) ? -1 : before(file, data, size);
}

ssize_t pread(int file, void* data, std::size_t size, off_t at) {
  NEXT(pread);
  return readFails(file) ? -1 : before(file, data, size, at);
}

ssize_t pread64(int file, void* data, std::size_t size, off_t at) {
  NEXT(pread);
  return readFails(file) ? -1 : before(file, data, size, at);
}

std::size_t fread(void* data, std::size_t size, std::size_t count, FILE* stream) {
  NEXT(fread);
  return readFails(fileno(stream)) ? 0 : before(data, size, count, stream);
}

// NOLINTBEGIN(readability-identifier-naming): glibc's
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* place, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
// NOLINTEND(readability-identifier-naming)

void* malloc(std::size_t bytes) noexcept {
  return allocationFails(bytes) ? nullptr : __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) noexcept {
  return allocationFails(count * bytes) ? nullptr : __libc_calloc(count, bytes);
}

void* realloc(void* place, std::size_t bytes) noexcept {
  return allocationFails(bytes) ? nullptr : __libc_realloc(place, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  return allocationFails(bytes) ? nullptr : __libc_memalign(alignment, bytes);
}

int posix_memalign(void** place, std::size_t alignment, std::size_t bytes) noexcept {
  if (allocationFails(bytes)) return ENOMEM;
  *place = __libc_memalign(alignment, bytes);
  return *place == nullptr ? ENOMEM : 0;
}

}  // extern "C"
