// Rows of form factors kept as they are computed, so that an interrupted run need not begin anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The kind of a journal's block. Files store these numbers.
enum class RowBlock : std::uint32_t {
  exact_task = 1,  ///< rows of one task of the exact method, and its sums
  row = 2,         ///< one row
  ray_round = 3,   ///< how many rays each row gets by the end of a round, and why
  ray_row = 4,     ///< the counts of one row at the end of a round
  cut_rows = 5     ///< some neighbouring rows, cut through a tree
};

/// Keeps the rows that computeFormFactors() has computed, in blocks of bytes with a kind and a
/// number, and returns those of an earlier run of the same form factors: the same options, method
/// and mesh. The owner must see to it that they are the same. The rows have the same bits with
/// these blocks as without. The pipeline keeps one in a file beside the results.
class RowJournal {
 public:
  RowJournal() = default;
  virtual ~RowJournal() = default;
  RowJournal(const RowJournal&) = delete;
  RowJournal& operator=(const RowJournal&) = delete;

  // ---- Called from any thread, several at once.

  /// Whether an earlier run has left that block.
  virtual bool has(RowBlock kind, std::uint64_t number) const = 0;
  /// Its bytes, as they were kept; empty if there is none.
  virtual std::vector<std::byte> kept(RowBlock kind, std::uint64_t number) const = 0;
  /// Keeps a block of at least one byte; a later one of the same kind and number replaces it. If
  /// that fails, the computation goes on without it.
  virtual void keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) = 0;

  // ---- Called from the thread that computes.

  /// Called before the other rows are computed: `rows` of `of` exist. Rays: in their current round.
  virtual void found(std::size_t /*rows*/, std::size_t /*of*/) {}
};

}  // namespace radiosity
