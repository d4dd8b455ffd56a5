// Reading the rows of a matrix: the basis of ExchangeMatrix's templates.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "radiosity/exchange_matrix.h"

namespace [[gnu::visibility("default")]] radiosity {

/// A stored row of the row form. One of `floats` and `doubles` is empty, by precision.
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

/// Some consecutive rows of a matrix, for reading.
class RowPanel {
 public:
  /// first <= last <= N. Takes O(N + entries of the triangle) and memory for the entries of the
  /// rows in the symmetric form, and for rows of several processes.
  RowPanel(const ExchangeMatrix& matrix, std::size_t first, std::size_t last);
  /// No rows, until read() is called.
  explicit RowPanel(const ExchangeMatrix& matrix) : matrix_(&matrix) {}
  /// Holds rows first to last - 1 from now on. `entries`: the matrix's rowEntries(); empty: they
  /// are counted. Memory of earlier rows is used again.
  void read(std::size_t first, std::size_t last, std::span<const Index> entries = {});
  std::size_t first() const { return first_; }
  std::size_t last() const { return last_; }  ///< one beyond

  /// As ExchangeMatrix::forRow(), first() <= i < last().
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const {
    forRow(i, 0, matrix_->size(), visit);
  }
  template <class Visit>
  void forRow(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const {
    if (starts_.empty()) {
      matrix_->viewOf(i).forEntries(first, last, visit);
      return;
    }
    const auto begin = columns_.begin() + std::ptrdiff_t(starts_[i - first_]);
    const auto end = columns_.begin() + std::ptrdiff_t(starts_[i - first_ + 1]);
    for (auto at = std::lower_bound(begin, end, first); at != end && *at < last; ++at) {
      visit(*at, values_[std::size_t(at - columns_.begin())]);
    }
  }

  /// Bytes per entry.
  static constexpr std::size_t kEntryBytes = sizeof(Index) + sizeof(double);

 private:
  const ExchangeMatrix* matrix_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  // Symmetric form, or rows of several processes: compressed, none of them 0. Else empty. Columns
  // and values can be longer than the rows.
  std::vector<std::size_t> starts_;
  std::vector<Index> columns_;
  std::vector<double> values_;
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
