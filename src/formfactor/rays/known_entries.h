// Rows that are known beforehand, by their positions in the order of the matrix.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/known_rows.h"

namespace radiosity {

/// The pairs that need no rays: all of some rows, and their columns in all others.
class KnownEntries {
 public:
  struct Entry {
    Index position;
    double exchange;  ///< G, m^2
    double error;     ///< of it
  };

  KnownEntries() = default;
  /// `position`: K, of each unknown.
  KnownEntries(std::vector<KnownRow> rows, std::span<const Index> position);

  bool empty() const { return rows_.empty(); }
  /// Of the unknown at a position, where all of it is known; else null.
  const KnownRow* rowAt(std::size_t position) const {
    return empty() || row_at_[position] == kNone ? nullptr : &rows_[row_at_[position]];
  }
  /// What is known of a row, positions increasing.
  std::span<const Entry> at(std::size_t position) const {
    return empty() ? std::span<const Entry>() : std::span<const Entry>(entries_[position]);
  }

  /// The same for the same rows.
  std::uint64_t identity() const;

  /// Held by this for so many pairs.
  static std::size_t bytes(std::size_t pairs) {
    return 2 * pairs * (sizeof(Entry) + sizeof(KnownExchange));
  }

 private:
  std::vector<KnownRow> rows_;
  std::vector<Index> row_at_;  ///< by position; kNone
  std::vector<std::vector<Entry>> entries_;
};

}  // namespace radiosity
