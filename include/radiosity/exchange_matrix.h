// The form-factor matrix as storage and products. It knows no geometry.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

enum class Precision { single, real };  // `double` is a keyword: `real` is 64 bits

/// Rows F_i. of an N x N matrix of form factors; with the areas it holds, G_ij = A_i F_ij is the
/// exchange area. A row is stored dense or as sorted (column, value) pairs, whichever is smaller;
/// values are 32 or 64 bits, all sums are made in 64.
class ExchangeMatrix {
 public:
  ExchangeMatrix() = default;
  /// All rows empty. `area`: N finite values >= 0, m^2, else InputError.
  ExchangeMatrix(std::vector<double> area, Precision precision);

  std::size_t size() const { return area_.size(); }
  Precision precision() const { return precision_; }
  std::span<const double> area() const { return area_; }

  /// Stores row i; columns strictly increasing and below N, values finite and > 0, lengths equal,
  /// else InputError naming the row. Different rows may be set from different threads at once.
  /// Setting a row again replaces it.
  void setRow(std::size_t i, std::span<const Index> columns, std::span<const double> values);

  /// Calls visit(column, value) over the stored entries of row i, columns increasing.
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const;

  /// The same for the entries with first <= column < last. O(log n + visited) in a sparse row.
  template <class Visit>
  void forRow(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const;

  /// F_ij, 0 where nothing is stored. O(log n) in a sparse row.
  double at(std::size_t i, std::size_t j) const;

  /// out[b] = sum_j F_ij x[j * bands + b], in 64-bit, for one row; the same bits whether the row is
  /// stored dense or sparse. x: N * bands, row-major; bands >= 1.
  void rowProduct(std::size_t i, std::span<const double> x, int bands, double* out) const;

  /// y = F x for all rows and bands, one pass over the matrix, in parallel, same bits for any
  /// thread count. x, y: N * bands, row-major, not aliased.
  void product(std::span<const double> x, int bands, std::span<double> y) const;

  std::size_t nonZeros() const;
  std::size_t bytes() const;      ///< of the stored values and indices
  std::size_t denseRows() const;  ///< how many rows are stored dense
  std::vector<double> rowSums() const;

  /// Bytes that N rows with `entries_per_row` entries would take, stored as they would be stored.
  static std::size_t estimateBytes(std::size_t n, double entries_per_row, Precision precision);

 private:
  struct Row {
    std::vector<Index> columns;  ///< empty for a dense row
    std::vector<float> single;
    std::vector<double> real;
    bool dense = false;
  };
  std::vector<double> area_;
  Precision precision_ = Precision::single;
  std::vector<Row> rows_;
};

template <class Visit>
void ExchangeMatrix::forRow(std::size_t i, Visit&& visit) const {
  forRow(i, 0, size(), visit);
}

template <class Visit>
void ExchangeMatrix::forRow(std::size_t i, std::size_t first, std::size_t last,
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

/// sqrt(sum_ij (G_ij - G_ji)^2 / sum_ij G_ij^2): how far the two estimates of each pair differ.
/// It detects errors, it does not bound them. 0 for an empty matrix.
double reciprocityResidual(const ExchangeMatrix& matrix);

/// Merges the two estimates of every pair, G_ij = w_i A_i F_ij + w_j A_j F_ji with
/// w_i = A_j^2 / (A_i^2 + A_j^2) (the bias of the estimate made at i goes as A_i / d^2). The result
/// has A_i F_ij = A_j F_ji and row sums that are no longer what they were: restore closure before
/// solving in a closed scene.
ExchangeMatrix symmetrized(const ExchangeMatrix& matrix);

/// Scales a symmetric exchange matrix to prescribed row sums by symmetric positive factors,
/// G_ij <- d_i d_j G_ij, iterated until every row is within `tolerance` of its target (van
/// Leersum-like, keeps zeros, non-negativity and reciprocity). Rows without entries keep sum 0.
/// Targets: N finite values >= 0, else InputError. Not every target can be reached (two plates that
/// see only each other exchange the same area): it stops where the residual no longer halves in 50
/// iterations, and the report says what is left.
struct ClosureReport {
  int iterations = 0;
  double largest_residual_before = 0;  ///< max |row sum - target|
  double largest_residual = 0;         ///< after
  double largest_move = 0;             ///< max |F' - F|
  double relative_move = 0;            ///< area-weighted relL2 of F' - F
};
ClosureReport restoreClosure(ExchangeMatrix& matrix, std::span<const double> target_row_sums,
                             double tolerance = 1e-12, int max_iterations = 1000);

}  // namespace radiosity
