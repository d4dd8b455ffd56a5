#include "base/draco_codec.h"

#include "base/side_library.h"

namespace radiosity {

const DracoCodec& dracoCodec() {
  static const auto entry = reinterpret_cast<const DracoCodec* (*)()>(
      requiredEntryOf("libradiosity_draco.so", "radiosityDracoCodec"));
  return *entry();
}

}  // namespace radiosity
