#include <array>

#include "fuzz/readers.h"
#include "pipeline/journal_file.h"
#include "radiosity/heat.h"
#include "radiosity/matrix_files.h"
#include "radiosity/results.h"

namespace radiosity {

namespace {

FuzzReader fileReader(const char* name, const char* ending,
                      const std::function<void(const std::string& path)>& read) {
  return {name, [ending, read](std::string_view bytes) { withFile(bytes, ending, read); }};
}

/// The key in it opens it, as the run that wrote it would.
void readJournal(const std::string& path) {
  const auto key = JournalFile::keyIn(path);
  if (!key) return;
  const auto journal = JournalFile::openForReading(path, *key);
  if (!journal) return;
  for (std::uint64_t number = 0; number < 4; ++number) {
    if (journal->has(RowBlock{}, number)) journal->kept(RowBlock{}, number);
  }
}

}  // namespace

std::span<const FuzzReader> resultsReaders() {
  static const std::array kReaders = {
      fileReader("h5", ".h5",
                 [](const std::string& path) {
                   sceneInResults(path);
                   readResults(path);
                 }),
      fileReader("journal", ".rows", readJournal),
      fileReader("mtx", ".mtx",
                 [](const std::string& path) {
                   Progress progress;
                   readMatrixFile(path, progress);
                 }),
      fileReader("areas", ".csv", [](const std::string& path) { readAreas(path); }),
      fileReader("conditions", ".csv",
                 [](const std::string& path) { readConditionText(path, {}, {}); })};
  return kReaders;
}

}  // namespace radiosity
