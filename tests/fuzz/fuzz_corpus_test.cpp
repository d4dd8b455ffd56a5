// Every input of the fuzzers' corpus is read or refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fuzz/readers.h"

namespace radiosity {

namespace {

void replay(std::span<const FuzzReader> readers) {
  for (const FuzzReader& reader : readers) {
    std::size_t inputs = 0;
    const std::filesystem::path corpus = RADIOSITY_SOURCE_DIR "/tests/fuzz/corpus";
    for (const auto& entry : std::filesystem::directory_iterator(corpus / reader.name)) {
      SCOPED_TRACE(entry.path().string());
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      EXPECT_NO_THROW(readOrRefuse(reader, bytes));
      ++inputs;
    }
    EXPECT_GT(inputs, 0U) << reader.name;
  }
}

TEST(FuzzCorpus, ScenesAreReadOrRefused) { replay(sceneReaders()); }

TEST(FuzzCorpus, ResultsAreReadOrRefused) { replay(resultsReaders()); }

}  // namespace

}  // namespace radiosity
