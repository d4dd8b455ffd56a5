// Rows of form factors kept as they are computed, so that a run that is broken off need not begin
// anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace [[gnu::visibility("default")]] radiosity {

/// What a block of a journal holds. The values stand in files.
enum class RowBlock : std::uint32_t {
  exact_task = 1,    ///< rows of one task of the exact method, and its sums
  hemicube_row = 2,  ///< one row
  ray_round = 3,     ///< how many rays each row is to have by the end of a round, and why
  ray_row = 4        ///< what one row has counted by the end of a round
};

/// Where computeFormFactors() leaves what it has computed, in blocks of bytes with a kind and a
/// number, and finds what an earlier run of the same form factors has left: the same options,
/// method and mesh. That they are the same is for its owner to see to. With what it finds the rows
/// have the same bits as without. The pipeline keeps one in a file beside the results.
class RowJournal {
 public:
  RowJournal() = default;
  virtual ~RowJournal() = default;
  RowJournal(const RowJournal&) = delete;
  RowJournal& operator=(const RowJournal&) = delete;

  // ---- Called from any thread, several at once.

  /// Whether an earlier run has left that block.
  virtual bool has(RowBlock kind, std::uint64_t number) const = 0;
  /// Its bytes, as they were kept; empty where there is none.
  virtual std::vector<std::byte> kept(RowBlock kind, std::uint64_t number) const = 0;
  /// Keeps a block of at least one byte; of two with one kind and number, the later. Where that
  /// fails, the computation goes on without.
  virtual void keep(RowBlock kind, std::uint64_t number, std::span<const std::byte> bytes) = 0;

  // ---- Called from the thread that computes.

  /// Before the others are computed: so many rows are there. Rays: in the round that they are at.
  virtual void found(std::size_t /*rows*/, std::size_t /*of*/) {}
};

}  // namespace radiosity
