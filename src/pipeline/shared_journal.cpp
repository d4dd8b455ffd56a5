#include "pipeline/shared_journal.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace radiosity {

namespace {

std::string pathOf(const std::string& first, int rank) {
  return rank == 0 ? first : first + "." + std::to_string(rank);
}

}  // namespace

std::vector<std::string> journalsBeside(const std::string& first) {
  namespace fs = std::filesystem;
  const fs::path path(first);
  const std::string start = path.filename().string() + ".";
  std::vector<std::string> found;
  std::error_code ignored;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const bool numbered = name.starts_with(start) && name.size() > start.size() &&
                          std::all_of(name.begin() + std::ptrdiff_t(start.size()), name.end(),
                                      [](char c) { return c >= '0' && c <= '9'; });
    if (numbered) found.push_back(first + name.substr(start.size() - 1));
  }
  return found;
}

SharedJournal::SharedJournal(JournalFile& own, const std::string& first, bool resume) : own_(own) {
  if (!resume) return;
  std::vector<std::string> paths = journalsBeside(first);
  paths.push_back(first);
  for (const std::string& path : paths) {
    if (path == own.path()) continue;
    if (auto other = JournalFile::openForReading(path, own.key())) {
      others_.push_back(std::move(other));
    }
  }
}

bool SharedJournal::has(RowBlock kind, std::uint64_t number) const {
  return own_.has(kind, number) ||
         std::any_of(others_.begin(), others_.end(),
                     [&](const auto& other) { return other->has(kind, number); });
}

std::vector<std::byte> SharedJournal::kept(RowBlock kind, std::uint64_t number) const {
  if (own_.has(kind, number)) return own_.kept(kind, number);
  for (const auto& other : others_) {
    if (other->has(kind, number)) return other->kept(kind, number);
  }
  return {};
}

void SharedJournal::keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) {
  own_.keep(kind, number, bytes);
}

void FirstJournal::broadcast(Processes& processes) {
  for (std::string* text : {&path, &key}) {
    std::vector<char> letters(text->begin(), text->end());
    processes.broadcastArray(letters);
    text->assign(letters.begin(), letters.end());
  }
  processes.broadcastValue(resume);
}

std::unique_ptr<JournalFile> FirstJournal::open(int rank) const {
  if (path.empty()) return nullptr;
  try {
    return std::make_unique<JournalFile>(pathOf(path, rank), key, resume);
  } catch (const RunError&) {
    return nullptr;
  }
}

}  // namespace radiosity
