#include "base/image_codec.h"

#include "base/side_library.h"

namespace radiosity {

const ImageCodec& imageCodec() {
  static const auto entry = reinterpret_cast<const ImageCodec* (*)()>(
      requiredEntryOf("libradiosity_images.so", "radiosityImageCodec"));
  return *entry();
}

}  // namespace radiosity
