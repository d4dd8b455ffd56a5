// The journals of rows of all processes of a run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/processes.h"
#include "pipeline/journal_file.h"

namespace radiosity {

/// Each process keeps blocks in a journal of its own, since a file belongs to one process. It looks
/// blocks up in the journals of all processes, also of an earlier run with another number of them.
class SharedJournal : public RowJournal {
 public:
  /// `own`: the journal of this process. `first`: the path of that of process 0. `resume`: also
  /// reads the journals of other processes.
  SharedJournal(JournalFile& own, const std::string& first, bool resume);

  bool has(RowBlock kind, std::uint64_t number) const override;
  std::vector<std::byte> kept(RowBlock kind, std::uint64_t number) const override;
  void keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) override;
  void found(std::size_t rows, std::size_t of) override { own_.found(rows, of); }

 private:
  JournalFile& own_;
  std::vector<std::unique_ptr<JournalFile>> others_;
};

/// The description of process 0's journal that it sends to the other processes.
struct FirstJournal {
  std::string path;  ///< of process 0's journal; empty: rows are not kept
  std::string key;
  bool resume = true;

  /// Sends the values of process 0 to the others. All processes must call it.
  void broadcast(Processes& processes);
  /// Opens the journal of process `rank`. Null if it cannot be opened: then its rows are not kept.
  std::unique_ptr<JournalFile> open(int rank) const;
};

/// The existing journals of processes other than 0; `first` is the path of process 0's.
std::vector<std::string> journalsBeside(const std::string& first);

}  // namespace radiosity
