#include "base/side_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "radiosity/base.h"

namespace radiosity {

void* entryOf(const char* name, const char* entry) {
  void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  return library == nullptr ? nullptr : dlsym(library, entry);
}

void* requiredEntryOf(const char* name, const char* entry) {
  if (void* address = entryOf(name, entry)) return address;
  throw RunError(
      fmt::format("{} cannot be used ({}); install it again beside libradiosity.so, or in the "
                  "program's library folder",
                  name, dlerror()));
}

}  // namespace radiosity
