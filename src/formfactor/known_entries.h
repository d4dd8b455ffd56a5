// Rows that are known beforehand, by their positions in the order of the matrix.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/known_rows.h"

namespace radiosity {

/// Fronts, backs and sky of a row.
struct RowAccount {
  double fronts = 0;
  double backs = 0;
  double sky = 0;
};

/// The pairs that need no estimate: all of some rows, and their columns in all others.
class KnownEntries {
 public:
  struct Entry {
    Index position;
    double exchange;  ///< G, m^2
    double error;     ///< of the exchange
  };

  KnownEntries() = default;
  /// `position`: that of each patch, K values.
  KnownEntries(std::vector<KnownRow> rows, std::span<const Index> position);

  bool empty() const { return rows_.empty(); }
  /// The row of the patch at a position if all of it is known, else null.
  const KnownRow* rowAt(std::size_t position) const {
    return empty() || row_at_[position] == kNone ? nullptr : &rows_[row_at_[position]];
  }
  /// The known entries of a row, positions increasing.
  std::span<const Entry> at(std::size_t position) const {
    return empty() ? std::span<const Entry>() : std::span<const Entry>(entries_[position]);
  }

  /// What a row of `area` m^2 sees of known patches: the sum of its known form factors.
  double share(std::size_t position, double area) const;
  /// The account of a row that is known whole. If it is `closed`, without sky, its fronts are 1
  /// less its backs.
  RowAccount account(std::size_t position, double area, bool closed) const;

  /// A number that is the same for the same rows.
  std::uint64_t identity() const;

  /// Bytes held by this for `pairs` pairs with exchange.
  static std::size_t bytes(double pairs) {
    return std::size_t(pairs * (2 * sizeof(Entry) + sizeof(KnownExchange)));
  }

 private:
  std::vector<KnownRow> rows_;
  std::vector<Index> row_at_;  ///< by position, into rows_; or kNone
  std::vector<std::vector<Entry>> entries_;
};

}  // namespace radiosity
