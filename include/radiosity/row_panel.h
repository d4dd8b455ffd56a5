// Reading the rows of a matrix: what ExchangeMatrix's templates are made of.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
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
  RowPanel(const ExchangeMatrix& matrix, std::size_t first, std::size_t last)
      : matrix_(&matrix), first_(first), last_(last) {
    if (!matrix.isSymmetric()) return;
    spread_.resize((last - first) * matrix.size());
    matrix.spreadRows(first, last, spread_);
  }
  std::size_t first() const { return first_; }
  std::size_t last() const { return last_; }  ///< one beyond

  /// As ExchangeMatrix::forRow(), first() <= i < last().
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const {
    forRow(i, 0, matrix_->size(), visit);
  }
  template <class Visit>
  void forRow(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const {
    if (!matrix_->isSymmetric()) {
      matrix_->viewOf(i).forEntries(first, last, visit);
      return;
    }
    const double* row = spread_.data() + (i - first_) * matrix_->size();
    for (std::size_t j = first; j < std::min(last, matrix_->size()); ++j) {
      if (row[j] != 0) visit(Index(j), row[j]);
    }
  }

 private:
  const ExchangeMatrix* matrix_;
  std::size_t first_;
  std::size_t last_;
  std::vector<double> spread_;
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
  for (std::size_t first = 0; first < size();) {
    const std::size_t last = panelEnd(first);
    visit(RowPanel(*this, first, last));
    first = last;
  }
}

}  // namespace radiosity
