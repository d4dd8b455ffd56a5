// The journals of rows that the processes of a run keep.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/processes.h"
#include "pipeline/journal_file.h"

namespace radiosity {

/// What a process keeps goes to a file of its own, since a file belongs to one process; what is
/// found is looked up in those of all: of any number of processes, whoever has rows to do now.
class SharedJournal : public RowJournal {
 public:
  /// `own`: this process's, `first`: the path of process 0's. `resume`: others are looked at.
  SharedJournal(JournalFile& own, const std::string& first, bool resume);

  bool has(RowBlock kind, std::uint64_t number) const override;
  std::vector<std::byte> kept(RowBlock kind, std::uint64_t number) const override;
  void keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) override;
  void found(std::size_t rows, std::size_t of) override { own_.found(rows, of); }

 private:
  JournalFile& own_;
  std::vector<std::unique_ptr<JournalFile>> others_;
};

/// What process 0 tells the others of the journal that it keeps.
struct JournalTold {
  std::string path;  ///< of process 0's; empty: rows are not kept
  std::string key;
  bool resume = true;

  /// By all; what process 0 has comes to the others.
  void broadcast(Processes& processes);
  /// Of another process; null where it cannot be opened: its rows are not kept then.
  std::unique_ptr<JournalFile> open(int rank) const;
};

/// The files of other processes than number 0 beside its own, `first`, that are there.
std::vector<std::string> journalsBeside(const std::string& first);

}  // namespace radiosity
