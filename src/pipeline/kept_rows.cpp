// Keeps rows of form factors in a journal while they are computed, until the results file has all.
#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "base/figure_text.h"
#include "pipeline/journal_file.h"
#include "pipeline/shared_journal.h"
#include "pipeline/stage_key.h"
#include "radiosity/names.h"
#include "radiosity/pipeline.h"
#include "radiosity/version.h"

namespace radiosity {

namespace {

/// The key of rows by `method`. It has the program's version, since others may compute other rows.
std::string journalKey(const StageKey& factors_key, std::string_view method) {
  return fmt::format("radiosity={} {}", RADIOSITY_VERSION, usedKey(factors_key, method).text());
}

std::string resumedText(const JournalFile::Found& at_opening, std::size_t rows, std::size_t of) {
  std::string text =
      fmt::format("resumed: {} of {} rows were there", countText(rows), countText(of));
  if (at_opening.damaged > 0) {
    text += fmt::format(", {} damaged {} left out", countText(at_opening.damaged),
                        at_opening.damaged == 1 ? "block" : "blocks");
  }
  return text;
}

/// Removes the journals of other processes that have this key.
void removeJournalsBeside(const std::string& path, const std::string& key) {
  for (const std::string& beside : journalsBeside(path)) {
    std::error_code ignored;
    if (JournalFile::keyIn(beside) == key) std::filesystem::remove(beside, ignored);
  }
}

}  // namespace

/// The method that an earlier run chose for `auto`. We keep it, since the choice depends on how
/// fast the machine was.
std::optional<FormFactorMethod> Pipeline::methodOfKeptRows(const StageKey& key) const {
  const JournalOptions& journal = options_.journal;
  if (journal.path.empty() || !journal.resume) return std::nullopt;
  if (options_.factors.method != FormFactorMethod::automatic) return std::nullopt;
  const std::optional<std::string> there = JournalFile::keyIn(journal.path);
  if (!there) return std::nullopt;
  for (const FormFactorMethod method : kAutomaticChoices) {
    if (*there == journalKey(key, nameOf(kMethodNames, method))) return method;
  }
  return std::nullopt;
}

/// If the journal cannot be opened, the rows are computed without it.
void Pipeline::openJournal(const FormFactorPlan& plan, const StageKey& key) {
  journal_.reset();
  const JournalOptions& options = options_.journal;
  if (options.path.empty()) return;
  const std::string wanted = journalKey(key, nameOf(kMethodNames, plan.method));
  const std::optional<std::string> there = JournalFile::keyIn(options.path);
  if (plan.seconds < options.from_seconds && !there) return;
  try {
    journal_ = std::make_unique<JournalFile>(options.path, wanted, options.resume);
  } catch (const RunError& error) {
    observer_.rows(*this, fmt::format("are not kept: {}", error.what()));
    return;
  }
  const JournalFile::Found at_opening = journal_->atOpening();
  if (at_opening.other_key) {
    observer_.rows(*this, options.path + " held those of other form factors; removed");
  }
  journal_->onFound([this, at_opening](std::size_t rows, std::size_t of) {
    if (at_opening.blocks + at_opening.damaged == 0) return;
    observer_.rows(*this, resumedText(at_opening, rows, of));
  });
  observer_.keepsRows(*this, options.path);
}

void Pipeline::discardKeptRows() {
  if (journal_) {
    removeJournalsBeside(journal_->path(), journal_->key());
    journal_->remove();
    journal_.reset();
    return;
  }
  // An earlier run may have ended after it wrote the results and before it removed its journals.
  const std::string& path = options_.journal.path;
  if (path.empty() || !results_.factors) return;
  const std::string key = journalKey(StageKey(results_.factors.key),
                                     nameOf(kFactorsFromNames, results_.factors->method));
  if (JournalFile::keyIn(path) != key) return;
  removeJournalsBeside(path, key);
  try {
    JournalFile(path, key, true).remove();
  } catch (const RunError&) {
    return;  // another run holds it
  }
}

}  // namespace radiosity
