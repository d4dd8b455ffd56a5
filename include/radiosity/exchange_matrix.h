// Form factors of which each pair's value is stored: what writes or lists them. RowMatrix and
// SymmetricMatrix hold them; functions of whole matrices are in matrix_functions.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "radiosity/exchange_operator.h"

namespace [[gnu::visibility("default")]] radiosity {

class RowPanel;

/// A row where it is stored. One of `floats` and `doubles` is empty, by precision.
struct RowView {
  std::span<const Index> columns;  ///< empty in a dense row
  std::span<const float> floats;
  std::span<const double> doubles;
  bool dense = false;

  /// Calls visit(column, value) for first <= column < last, zeros left out.
  template <class Visit>
  void forEntries(std::size_t first, std::size_t last, Visit&& visit) const {
    std::size_t begin = first;
    std::size_t end = std::min(last, floats.size() + doubles.size());
    if (!dense) {
      const auto lower = [&](std::size_t column) {
        const auto found = std::lower_bound(columns.begin(), columns.end(), column);
        return std::size_t(found - columns.begin());
      };
      begin = lower(first);
      end = lower(last);
    }
    for (std::size_t k = begin; k < end; ++k) {
      const double value = floats.empty() ? doubles[k] : double(floats[k]);
      if (!dense) {
        visit(columns[k], value);
      } else if (value != 0) {
        visit(Index(k), value);
      }
    }
  }
};

/// Some consecutive rows in compressed form, columns increasing, no value 0.
struct CompressedRows {
  std::size_t first = 0;
  std::vector<std::size_t> starts;  ///< a row more than there are
  std::vector<Index> columns;       ///< these two can be longer than the rows
  std::vector<double> values;

  /// As ExchangeMatrix::forRow().
  template <class Visit>
  void forRow(std::size_t i, std::size_t first_column, std::size_t last_column,
              Visit&& visit) const {
    const auto begin = columns.begin() + std::ptrdiff_t(starts[i - first]);
    const auto end = columns.begin() + std::ptrdiff_t(starts[i - first + 1]);
    for (auto at = std::lower_bound(begin, end, first_column); at != end && *at < last_column;
         ++at) {
      visit(*at, values[std::size_t(at - columns.begin())]);
    }
  }
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const {
    for (std::size_t at = starts[i - first]; at < starts[i - first + 1]; ++at) {
      visit(columns[at], values[at]);
    }
  }
};

/// Form factors that are stored pair by pair.
class ExchangeMatrix : public ExchangeOperator {
 public:
  Precision precision() const { return precision_; }
  /// Symmetric: the patches in the order in which they are stored; else empty.
  std::span<const Index> order() const { return order_; }

  /// Calls visit(column, value) over the entries of row i that are not 0, columns increasing. O(N)
  /// or more, and memory for a row, unless it is a RowMatrix; use forPanels() for many rows.
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const;
  /// The same for the entries with first <= column < last.
  template <class Visit>
  void forRow(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const;
  /// Calls visit(panel), with a RowPanel, for consecutive ranges of rows, which together are all
  /// rows in order. A panel takes at most panelBytes(), or it is one row.
  template <class Visit>
  void forPanels(Visit&& visit) const;
  /// The size makes at most about 50 panels, since each takes a walk over all stored rows.
  static std::size_t panelBytes(std::size_t matrix_bytes) {
    return std::max(kLeastPanelBytes, matrix_bytes / 8);
  }
  static constexpr std::size_t kLeastPanelBytes = std::size_t(1) << 25;

  virtual std::vector<Index> rowEntries() const = 0;  ///< N: entries of each row that are not 0
  std::size_t nonZeros() const;                       ///< of the N x N matrix
  /// Sets values[(j - first) * N + i] = F_ij for columns j from first to last - 1. `values` must
  /// hold (last - first) * N zeros.
  virtual void columns(std::size_t first, std::size_t last, std::span<double> values) const;

  std::vector<double> row(std::size_t i) const override;
  double at(std::size_t i, std::size_t j) const override;
  std::vector<double> dense() const override;

 protected:
  /// `order`: each patch once, else InputError; not symmetric: empty.
  ExchangeMatrix(std::vector<double> area, bool symmetric, std::vector<Index> order,
                 Precision precision);
  ExchangeMatrix(ExchangeMatrix&&) noexcept = default;

 private:
  friend class RowPanel;
  /// Reads rows first to last - 1. `entries`: rowEntries(); empty: they are counted. Does nothing
  /// where viewOf() shows rows.
  virtual void readRows(std::size_t first, std::size_t last, std::span<const Index> entries,
                        CompressedRows& rows) const = 0;
  virtual RowView viewOf(std::size_t i) const;
  /// The most entries of a panel; 0: rows are shown by viewOf(), all in one panel.
  virtual std::size_t panelEntries() const = 0;
  /// The panels of forPanels(): the end of each, and rowEntries(), empty if they are views.
  struct Panels {
    std::vector<std::size_t> ends;
    std::vector<Index> entries;
  };
  Panels panels() const;

  Precision precision_;
  std::vector<Index> order_;
};

/// The matrix that it is. Errors: InputError if no pairs are stored.
const ExchangeMatrix& pairsOf(const ExchangeOperator& factors);

/// Some consecutive rows of a matrix, for reading.
class RowPanel {
 public:
  /// first <= last <= N. Takes O(N + all stored entries) and memory for the entries of the rows,
  /// unless it is a RowMatrix.
  RowPanel(const ExchangeMatrix& matrix, std::size_t first, std::size_t last) : matrix_(&matrix) {
    read(first, last);
  }
  /// No rows, until read() is called.
  explicit RowPanel(const ExchangeMatrix& matrix) : matrix_(&matrix) {}
  /// Holds rows first to last - 1 from now on. `entries`: the matrix's rowEntries(); empty: they
  /// are counted. Memory of earlier rows is used again.
  void read(std::size_t first, std::size_t last, std::span<const Index> entries = {}) {
    rows_.first = first;
    last_ = last;
    matrix_->readRows(first, last, entries, rows_);
  }
  std::size_t first() const { return rows_.first; }
  std::size_t last() const { return last_; }  ///< one beyond

  /// As ExchangeMatrix::forRow(), first() <= i < last().
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const {
    forRow(i, 0, matrix_->size(), visit);
  }
  template <class Visit>
  void forRow(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const {
    if (rows_.starts.empty()) {
      matrix_->viewOf(i).forEntries(first, last, visit);
    } else {
      rows_.forRow(i, first, last, visit);
    }
  }

  /// Bytes per entry.
  static constexpr std::size_t kEntryBytes = sizeof(Index) + sizeof(double);

 private:
  const ExchangeMatrix* matrix_;
  CompressedRows rows_;  ///< without `starts`: rows are views
  std::size_t last_ = 0;
};

template <class Visit>
void ExchangeMatrix::forRow(std::size_t i, Visit&& visit) const {
  forRow(i, 0, size(), visit);
}

template <class Visit>
void ExchangeMatrix::forRow(std::size_t i, std::size_t first, std::size_t last,
                            Visit&& visit) const {
  RowPanel(*this, i, i + 1).forRow(i, first, last, visit);
}

template <class Visit>
void ExchangeMatrix::forPanels(Visit&& visit) const {
  const Panels all = panels();
  RowPanel panel(*this);
  for (const std::size_t last : all.ends) {
    panel.read(panel.last(), last, all.entries);
    visit(std::as_const(panel));
  }
}

}  // namespace radiosity
