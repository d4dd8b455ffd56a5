// Rows of form factors made in blocks: by all threads and processes, and from the journal of an
// earlier run. A method says what a block is; all else is here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/byte_stream.h"
#include "base/processes.h"
#include "radiosity/row_journal.h"
#include "radiosity/scratch_memory.h"

namespace radiosity {

/// What rows are made with.
struct RowRun {
  Progress& progress;
  RowJournal* journal = nullptr;             ///< null: nothing is kept
  Processes* processes = nullptr;            ///< null: this one alone
  std::shared_ptr<ScratchMemory> scratch{};  ///< holds entries of rows; null: they are in memory
};

/// Consecutive blocks.
struct BlockRange {
  std::size_t begin;
  std::size_t end;
};

/// What one pass over rows makes, in blocks that do not depend on each other. Functions of
/// different blocks are called from several threads at once.
class RowBlocks {
 public:
  RowBlocks() = default;
  virtual ~RowBlocks() = default;
  RowBlocks(const RowBlocks&) = delete;
  RowBlocks& operator=(const RowBlocks&) = delete;

  virtual std::size_t count() const = 0;
  /// The work of a block, in steps of the progress bar.
  virtual std::size_t steps(std::size_t /*block*/) const { return 1; }

  /// Makes a block and stores it. May throw Cancelled.
  virtual void make(std::size_t block) = 0;
  /// Makes some of `blocks` at once, by a device, and calls made(block), from any thread, for each
  /// that is stored. It steps the progress itself. Those left over are made one by one.
  virtual void makeByDevice(std::span<const std::size_t> /*blocks*/,
                            const std::function<void(std::size_t)>& /*made*/) {}
  /// Called for each block that is stored, and kept: what does not belong into a journal.
  virtual void finish(std::size_t /*block*/) {}

  // ---- A block in the journal.

  virtual RowBlock kind() const = 0;
  virtual std::uint64_t number(std::size_t block) const = 0;
  /// Writes all that make() stores: right after that, by the same thread, or after hear().
  virtual void put(std::size_t block, ByteWriter& bytes) const = 0;
  /// Stores the same. False, with nothing changed, if the bytes are of another block.
  virtual bool take(std::size_t block, ByteReader& bytes) = 0;

  // ---- Blocks that another process has made, for process 0.

  /// The beginnings of about `most` ranges of about as many steps, each made by one process, and
  /// the end.
  virtual std::vector<std::size_t> starts(std::size_t most) const;
  /// Whether rows stay in the process that makes them: then none may make many more than others.
  virtual bool rowsStay() const { return false; }
  /// Writes what process 0 needs of them.
  virtual void tell(BlockRange range, ByteWriter& bytes) = 0;
  /// Called in process 0, by one thread. True if the blocks now are as if it had made them, and
  /// belong into its journal.
  virtual bool hear(BlockRange range, ByteReader& bytes) = 0;
};

/// Makes all blocks, as far as the journal does not have them. If there are other processes, all
/// must call it with the same number of blocks. Steps the progress by what is made. Throws
/// Cancelled.
void makeBlocks(RowBlocks& blocks, const RowRun& run);

/// The same as a stage of progress, "form factors". Tells the journal how many rows, a step each,
/// it has.
void makeAllRows(RowBlocks& blocks, const RowRun& run);

}  // namespace radiosity
