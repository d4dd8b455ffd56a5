// The readers of foreign bytes, by name: what the fuzzer (tools/fuzz) and the replay of its corpus
// give inputs to.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace radiosity {

struct FuzzReader {
  const char* name;  ///< the folder of its inputs in tests/fuzz/corpus
  /// Reads bytes. Errors: InputError; anything else is a fault.
  std::function<void(std::string_view)> read;
};

/// Those of the rooms base and scene.
std::span<const FuzzReader> sceneReaders();
/// Those of the rooms above them.
std::span<const FuzzReader> resultsReaders();

/// Gives `read` the path of a file with these bytes and this end of its name; removes the file.
void withFile(std::string_view bytes, const char* ending,
              const std::function<void(const std::string& path)>& read);

/// Reads; a refusal is as good. All else passes through.
void readOrRefuse(const FuzzReader& reader, std::string_view bytes);

}  // namespace radiosity
