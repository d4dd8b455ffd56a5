// The entry of libFuzzer. RADIOSITY_FUZZ names the reader; tools/fuzz sets it.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "fuzz/readers.h"

namespace {

const radiosity::FuzzReader* reader = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*count*/, char*** /*words*/) {
  const char* const name = std::getenv("RADIOSITY_FUZZ");
  for (const radiosity::FuzzReader& each : radiosity::RADIOSITY_FUZZ_READERS()) {
    if (name != nullptr && std::string_view(name) == each.name) reader = &each;
  }
  if (reader != nullptr) return 0;
  for (const radiosity::FuzzReader& each : radiosity::RADIOSITY_FUZZ_READERS()) {
    std::puts(each.name);
  }
  std::exit(name == nullptr ? EXIT_SUCCESS : EXIT_FAILURE);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  radiosity::readOrRefuse(*reader, {reinterpret_cast<const char*>(bytes), size});
  return 0;
}
