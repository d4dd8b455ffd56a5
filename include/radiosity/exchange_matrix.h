// The form-factor matrix as storage and products. It knows no geometry.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

enum class Precision { single, real };  // `double` is a keyword: `real` is 64 bits

/// Which of a matrix's values: those stored first, what closure adds to them, or the sum.
enum class Part { corrected, raw, correction };

/// `skip` zeros that are left out and then `count` stored values. Longer stretches are several
/// runs.
struct Run {
  std::uint16_t skip = 0;
  std::uint16_t count = 0;
};

/// One row of a triangle as runs. The values are in `single` or in `real`, by precision.
struct RunRow {
  std::vector<Run> runs;
  std::vector<float> single;
  std::vector<double> real;
};

/// Form factors F of N patches, N x N, and the patches' areas; G_ij = A_i F_ij is the exchange
/// area. Stored values are 32 or 64 bits, all sums are made in 64.
///
/// Row form: every row F_i. for itself, dense or as sorted (column, value) pairs, whichever is
/// smaller. The two values of a pair may be two estimates that differ.
///
/// Symmetric form: A_i F_ij = A_j F_ji by construction, and half the memory. Patches stand in an
/// order given once; stored is F_ij for j after i in that order, and F_ji = A_i F_ij / A_j follows.
/// A row leaves out its runs of zeros, so patches that do not see each other and are neighbours in
/// the order (coplanar ones) cost nothing. Storing F and not G keeps values within 0 and 1 in a
/// scene of any size. A correction, likewise symmetric, may stand beside the stored values: all
/// that reads the matrix then reads the sum, unless it asks for a part.
class ExchangeMatrix {
 public:
  ExchangeMatrix() = default;
  /// Row form, all rows empty. `area`: N finite values >= 0, m^2, else InputError.
  ExchangeMatrix(std::vector<double> area, Precision precision);
  /// Symmetric form, all rows empty. `order`: each patch once, else InputError.
  static ExchangeMatrix symmetric(std::vector<double> area, std::vector<Index> order,
                                  Precision precision);

  std::size_t size() const { return area_.size(); }
  Precision precision() const { return precision_; }
  std::span<const double> area() const { return area_; }
  bool isSymmetric() const { return symmetric_; }
  /// Symmetric form: the patches in the order they are stored; else empty.
  std::span<const Index> order() const { return order_; }

  /// Row form: stores row i; columns strictly increasing and below N, values finite and > 0,
  /// lengths equal, else InputError naming the row. Different rows may be set from different
  /// threads at once. Setting a row again replaces it.
  void setRow(std::size_t i, std::span<const Index> columns, std::span<const double> values);

  /// Symmetric form: factors[m] is F from patch order[k] to patch order[k + m], m = 0 being the
  /// patch itself; at most N - k values, the rest are 0. Finite, >= 0, 0 where a patch has no area,
  /// else InputError naming the patches. Different rows may be set from different threads at once.
  /// Setting a row again replaces it. Not in a corrected matrix.
  void setUpperRow(std::size_t k, std::span<const double> factors);

  /// Symmetric form: from now on row k is what setUpperRow() stored plus changes[k], whose first
  /// value stands for position k + 1. N rows, values by the matrix's precision; a sum below 0 is an
  /// InputError. No rows: no correction.
  void setCorrection(std::vector<RunRow> changes);
  /// Row k of the triangle as setUpperRow() stored it, from position k + 1 on.
  const RunRow& upperRuns(std::size_t k) const { return upper_[k]; }
  double diagonal(std::size_t k) const { return diagonal_[k]; }  ///< its first value
  bool isCorrected() const { return !correction_.empty(); }

  /// Symmetric form: row k's N - k values as they are stored, rounded.
  void upperRow(std::size_t k, std::span<double> factors, Part part = Part::corrected) const;

  /// Calls visit(column, value) over the entries of row i that are not 0, columns increasing.
  /// Symmetric form: O(N) and more, and memory for a row; for many rows use forPanels().
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const;

  /// The same for the entries with first <= column < last. O(log n + visited) in a sparse row.
  template <class Visit>
  void forRow(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const;

  /// Calls visit(panel) for consecutive ranges of rows that together are all rows, in order. A
  /// panel of the symmetric form holds its rows spread out, at most kPanelBytes or one row.
  template <class Visit>
  void forPanels(Visit&& visit, Part part = Part::corrected) const;

  /// F_ij, 0 where nothing is stored. O(log n) in a sparse row, O(runs) in the symmetric form.
  double at(std::size_t i, std::size_t j) const;

  /// y = F x for all bands, one pass over what is stored, in parallel, same bits for any thread
  /// count. x, y: N * bands, row-major, not aliased. `wanted`: N flags, of the rows to compute;
  /// elsewhere y stays as it is. Empty: all.
  void product(std::span<const double> x, int bands, std::span<double> y,
               std::span<const std::uint8_t> wanted = {}) const {
    productOf(Part::corrected, x, bands, y, wanted);
  }

  /// The same with some of the values.
  void productOf(Part part, std::span<const double> x, int bands, std::span<double> y,
                 std::span<const std::uint8_t> wanted = {}) const;

  /// One row after the other, in the order of storage (row form: as numbered): calls
  /// update(i, gathered) with gathered[b] = sum_j F_ij x[j * bands + b], x as the updates so far
  /// have left it. An update may change x of patch i and of no other. Rows that are not `wanted`
  /// are passed over. One pass over what is stored, on one thread.
  using Update = std::function<void(std::size_t i, const double* gathered)>;
  void sweep(std::span<double> x, int bands, const Update& update,
             std::span<const std::uint8_t> wanted = {}) const;

  /// N: how many entries of a row are not 0.
  std::vector<Index> rowEntries(Part part = Part::corrected) const;
  std::size_t nonZeros(Part part = Part::corrected) const;  ///< of the N x N matrix
  std::vector<double> rowSums(Part part = Part::corrected) const;
  std::size_t bytes() const;      ///< of the stored values and indices
  std::size_t denseRows() const;  ///< row form: how many rows are stored dense

  /// Bytes that N rows with `entries_per_row` entries would take, stored as they would be stored in
  /// row form.
  static std::size_t estimateBytes(std::size_t n, double entries_per_row, Precision precision);
  /// The most that a symmetric matrix with that many entries a row takes, however they lie.
  static std::size_t estimateSymmetricBytes(std::size_t n, double entries_per_row,
                                            Precision precision);

  /// Most bytes of a panel's spread rows.
  static constexpr std::size_t kPanelBytes = std::size_t(1) << 25;

 private:
  friend class RowPanel;
  struct Row {
    std::vector<Index> columns;  ///< empty for a dense row
    std::vector<float> single;
    std::vector<double> real;
    bool dense = false;
  };
  template <class Visit>  // row form
  void forStored(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const;
  std::size_t panelEnd(std::size_t first) const;
  /// Row i of `out` (N values each) becomes row first + i of the matrix.
  void spreadRows(std::size_t first, std::size_t last, Part part, std::span<double> out) const;
  void checkFactors(std::size_t k, std::span<const double> factors) const;
  void rowProduct(std::size_t i, std::span<const double> x, int bands, double* out) const;
  void symmetricProduct(Part part, std::span<const double> x, int bands, std::span<double> y,
                        std::span<const std::uint8_t> wanted) const;
  void symmetricSweep(std::span<double> x, int bands, const Update& update,
                      std::span<const std::uint8_t> wanted) const;
  /// Symmetric form: F between positions k <= later, as stored.
  double storedUpper(std::size_t k, std::size_t later) const;

  std::vector<double> area_;
  Precision precision_ = Precision::single;
  bool symmetric_ = false;
  std::vector<Row> rows_;            // row form
  std::vector<Index> order_;         // symmetric form: patch by position,
  std::vector<Index> position_;      // position by patch,
  std::vector<RunRow> upper_;        // by position k: F to positions k + 1, ...
  std::vector<RunRow> correction_;   // likewise; empty without a correction
  std::vector<double> diagonal_;     // by position
  std::vector<Index> without_area_;  // positions of patches of area 0
};

/// Some consecutive rows of a matrix, for reading.
class RowPanel {
 public:
  RowPanel(const ExchangeMatrix& matrix, std::size_t first, std::size_t last, Part part)
      : matrix_(&matrix), first_(first), last_(last) {
    if (!matrix.isSymmetric()) return;
    spread_.resize((last - first) * matrix.size());
    matrix.spreadRows(first, last, part, spread_);
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
      matrix_->forStored(i, first, last, visit);
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
  RowPanel(*this, i, i + 1, Part::corrected).forRow(i, first, last, visit);
}

template <class Visit>
void ExchangeMatrix::forPanels(Visit&& visit, Part part) const {
  for (std::size_t first = 0; first < size();) {
    const std::size_t last = panelEnd(first);
    visit(RowPanel(*this, first, last, part));
    first = last;
  }
}

template <class Visit>
void ExchangeMatrix::forStored(std::size_t i, std::size_t first, std::size_t last,
                               Visit&& visit) const {
  const Row& row = rows_[i];
  std::size_t begin = first;
  std::size_t end = std::min(last, row.single.size() + row.real.size());
  if (!row.dense) {
    const auto lower = [&](std::size_t column) {
      const auto found = std::lower_bound(row.columns.begin(), row.columns.end(), column);
      return std::size_t(found - row.columns.begin());
    };
    begin = lower(first);
    end = lower(last);
  }
  for (std::size_t k = begin; k < end; ++k) {
    const double value = precision_ == Precision::real ? row.real[k] : double(row.single[k]);
    if (!row.dense) {
      visit(row.columns[k], value);
    } else if (value != 0) {
      visit(Index(k), value);
    }
  }
}

/// sum_ij A_i F_ij^2, m^2: what errors in the area-weighted L2 norm are relative to.
double weightedSquares(const ExchangeMatrix& matrix, Part part = Part::corrected);

/// sqrt(sum_ij (G_ij - G_ji)^2 / sum_ij G_ij^2): how far the two estimates of each pair differ.
/// It detects errors, it does not bound them. 0 for an empty matrix.
double reciprocityResidual(const ExchangeMatrix& matrix);

/// Merges the two estimates of every pair, G_ij = w_i A_i F_ij + w_j A_j F_ji with
/// w_i = A_j^2 / (A_i^2 + A_j^2) (the bias of the estimate made at i goes as A_i / d^2). The result
/// has A_i F_ij = A_j F_ji and row sums that are no longer what they were: restore closure
/// (closure.h) before solving in a closed scene.
ExchangeMatrix symmetrized(const ExchangeMatrix& matrix);

}  // namespace radiosity
