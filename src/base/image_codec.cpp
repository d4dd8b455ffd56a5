#include "base/image_codec.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "radiosity/base.h"

namespace radiosity {

namespace {

const ImageCodec& openCodec() {
  // The library is found beside this one, whose search path is $ORIGIN. It is never closed.
  void* library = dlopen("libradiosity_images.so", RTLD_LAZY | RTLD_LOCAL);
  void* entry = library == nullptr ? nullptr : dlsym(library, "radiosityImageCodec");
  if (entry == nullptr) {
    throw RunError(
        fmt::format("libradiosity_images.so cannot be used ({}); install it again beside "
                    "libradiosity.so, or in the program's library folder",
                    dlerror()));
  }
  return *reinterpret_cast<const ImageCodec* (*)()>(entry)();
}

}  // namespace

const ImageCodec& imageCodec() {
  static const ImageCodec& codec = openCodec();
  return codec;
}

}  // namespace radiosity
