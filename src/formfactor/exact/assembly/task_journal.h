// Tasks of the exact method in a journal: their rows and their sums.
#pragma once

#include <cstddef>
#include <vector>

#include "base/byte_stream.h"
#include "formfactor/exact/assembly/row_assembly.h"
#include "formfactor/exact/assembly/row_tasks.h"
#include "radiosity/row_journal.h"

namespace radiosity {

/// Writes sums over pairs of rows from the one of rank `first` on, and reads them back: false, with
/// `sums` of no use, if the bytes are of another number of rows.
void putSums(const RowSums& sums, std::size_t first, ByteWriter& bytes);
bool takeSums(std::size_t first, ByteReader& bytes, RowSums& sums);

/// A block a task: its rows as they are stored, the errors of their entries, the black backs that
/// they see, and the task's part of the sums over all pairs, which error figures need to be those
/// of a run in one go.
class TaskJournal {
 public:
  /// Keeps all by reference. `journal`: null if nothing is kept. Tells it how many rows it has.
  TaskJournal(RowJournal* journal, const RowContext& context, const RowTasks& tasks);

  /// The number of rows that the journal has.
  std::size_t rows() const { return found_; }

  /// Puts the task's rows where RowAssembly would, and its sums into `sums`, which hold nothing
  /// yet. False if the journal has no such task: then nothing has changed. Thread-safe for
  /// different tasks.
  bool take(std::size_t task, RowSums& sums) const;
  /// Called after RowAssembly has run the task. `sums`: its own and no others.
  void keep(std::size_t task, const RowSums& sums) const;

 private:
  struct Row;
  struct Ranks {
    std::size_t first;
    std::size_t end;
  };
  Ranks ranksOf(std::size_t task) const;
  void putRow(std::size_t rank, ByteWriter& bytes) const;
  Row takeRow(std::size_t rank, ByteReader& bytes) const;
  void store(std::size_t rank, Row row) const;

  RowJournal* journal_;
  const RowContext& context_;
  const RowTasks& tasks_;
  std::size_t found_ = 0;
};

}  // namespace radiosity
