#include "base/side_library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>
#include <unistd.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

namespace {

[[noreturn]] void failWithout(const char* name, const char* why) {
  throw RunError(
      fmt::format("{} cannot be used ({}); install it again beside libradiosity.so, or in the "
                  "program's library folder",
                  name, why));
}

/// The folders in which the loader looks for libraries that this code opens.
std::vector<std::string> searchPath() {
  Dl_info info{};
  link_map* self = nullptr;
  Dl_serinfo sizes{};
  if (dladdr1(reinterpret_cast<void*>(&searchPath), &info, reinterpret_cast<void**>(&self),
              RTLD_DL_LINKMAP) == 0 ||
      dlinfo(self, RTLD_DI_SERINFOSIZE, &sizes) != 0) {
    return {};
  }
  const std::size_t units = sizes.dls_size / sizeof(Dl_serinfo) + 1;
  const auto memory = std::make_unique<Dl_serinfo[]>(units);
  Dl_serinfo* const found = memory.get();
  found->dls_size = sizes.dls_size;
  found->dls_cnt = sizes.dls_cnt;
  if (dlinfo(self, RTLD_DI_SERINFO, found) != 0) return {};
  std::vector<std::string> folders;
  const Dl_serpath* const paths = found->dls_serpath;
  for (unsigned k = 0; k < found->dls_cnt; ++k) folders.emplace_back(paths[k].dls_name);
  return folders;
}

}  // namespace

void* entryOf(const char* name, const char* entry) {
  void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  return library == nullptr ? nullptr : dlsym(library, entry);
}

void* requiredEntryOf(const char* name, const char* entry) {
  if (void* address = entryOf(name, entry)) return address;
  failWithout(name, dlerror());
}

std::string requiredFileOf(const char* name) {
  for (const std::string& folder : searchPath()) {
    std::string path = folder + "/" + name;
    if (access(path.c_str(), X_OK) == 0) return path;
  }
  failWithout(name, "no such file");
}

}  // namespace radiosity
