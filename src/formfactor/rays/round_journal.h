// Rounds of rays in a journal: the rays that each row is to have, and its counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/byte_stream.h"
#include "formfactor/rays/ray_rows.h"
#include "radiosity/row_journal.h"

namespace radiosity {

/// A row's rays, norms and errors.
struct RowState {
  std::uint32_t rays = 0;
  std::uint32_t is_unknown = 0;  ///< 1 for RowAccuracy::isUnknown(), else 0
  double error = 0;              ///< RowAccuracy::expectedError()
  double norm = 0;
  double backs_error = 0;
  double whole_norm = 0;  ///< of fronts and backs
};

/// The decisions at the beginning of a round. Vectors go by position.
struct RayRound {
  std::vector<std::uint32_t> rays;  ///< each row is to have in each replicate, if it has fewer
  std::vector<RowState> before;     ///< by the measurement before the last,
  std::vector<RowState> now;        ///< and by the last
  CommonError common;               ///< of all rows measured up to the last
  double usual_norm = 0;            ///< of the last,
  double usual_whole_norm = 0;      ///< and of fronts and backs
  double loosened = 1;              ///< times the tolerance aimed at
};

/// A row as bytes, and back.
void putRayRow(const RayRow& row, ByteWriter& bytes);
RayRow takeRayRow(ByteReader& bytes);

/// Blocks of all rounds and rows stay. Each holds a whole row, not the counts that a round adds: if
/// one is damaged, that of the round before is still good.
class RoundJournal {
 public:
  /// For `rows` rows. `journal`: null if nothing is kept. `known`: identifies their known entries,
  /// on which rounds depend and rays do not.
  RoundJournal(RowJournal* journal, std::size_t rows, std::uint64_t known)
      : journal_(journal), rows_(rows), known_(known) {}

  void keep(int round, const RayRound& decided) const;
  std::optional<RayRound> take(int round) const;

  /// The block of a row at the end of a round that has continued it; `rows` in all.
  static std::uint64_t number(int round, std::size_t position, std::size_t rows) {
    return std::uint64_t(round) * rows + position;
  }
  bool hasRow(int round, std::size_t position) const;
  /// `rays`: what the row must then have. False, with `row` unchanged, if it is not there.
  bool takeRow(int round, std::size_t position, std::uint32_t rays, RayRow& row) const;

  /// See RowJournal::found().
  void found(std::size_t rows) const {
    if (journal_ != nullptr) journal_->found(rows, rows_);
  }

 private:
  RowJournal* journal_;
  std::size_t rows_;
  std::uint64_t known_;
};

}  // namespace radiosity
