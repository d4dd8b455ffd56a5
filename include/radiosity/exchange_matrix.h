// The form-factor matrix: storage, rows and products. It knows no geometry. What is computed from
// whole matrices is in matrix_functions.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace [[gnu::visibility("default")]] radiosity {

enum class Precision { single_precision, double_precision };

class RowPanel;
struct RowView;
struct RunRow;

/// Form factors F of N patches, N x N, and the patches' areas; G_ij = A_i F_ij is the exchange
/// area. Stored values are 32 or 64 bits, all sums are made in 64.
///
/// Row form: every row F_i. for itself, dense or as sorted (column, value) pairs, whichever is
/// smaller. The two values of a pair may be two estimates that differ.
///
/// Symmetric form: A_i F_ij = A_j F_ji by construction, and half the memory. Patches stand in an
/// order given once; F_ij is stored for j after i in that order, and F_ji = A_i F_ij / A_j follows.
/// A row leaves out its runs of zeros, so patches that do not see each other and are neighbours in
/// the order (coplanar ones) cost nothing. Storing F and not G keeps values within 0 and 1 in a
/// scene of any size.
class ExchangeMatrix {
 public:
  ExchangeMatrix();
  /// Row form, all rows empty. `area`: N finite values >= 0, m^2, else InputError.
  ExchangeMatrix(std::vector<double> area, Precision precision);
  /// Symmetric form, all rows empty. `order`: each patch once, else InputError.
  static ExchangeMatrix symmetric(std::vector<double> area, std::vector<Index> order,
                                  Precision precision);
  ExchangeMatrix(const ExchangeMatrix& other);
  ExchangeMatrix(ExchangeMatrix&& other) noexcept;
  ExchangeMatrix& operator=(const ExchangeMatrix& other);
  ExchangeMatrix& operator=(ExchangeMatrix&& other) noexcept;
  ~ExchangeMatrix();

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
  /// else InputError naming the patches. Threads and setting again: as setRow().
  void setUpperRow(std::size_t k, std::span<const double> factors);

  /// Symmetric form: row k's N - k values as they are stored, rounded.
  void upperRow(std::size_t k, std::span<double> factors) const;
  /// The same without the first, as it is packed (src/matrix/run_row.h), and the first.
  const RunRow& upperRuns(std::size_t k) const;
  double diagonal(std::size_t k) const { return diagonal_[k]; }

  /// Calls visit(column, value) over the entries of row i that are not 0, columns increasing.
  /// Symmetric form: O(N) and more, and memory for a row; for many rows use forPanels().
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const;
  /// The same for the entries with first <= column < last. O(log n + visited) in a sparse row.
  template <class Visit>
  void forRow(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const;
  /// Calls visit(panel), a RowPanel (row_panel.h), for consecutive ranges of rows that together are
  /// all rows, in order. A panel of the symmetric form holds its rows spread out, at most
  /// kPanelBytes or one row.
  template <class Visit>
  void forPanels(Visit&& visit) const;
  static constexpr std::size_t kPanelBytes = std::size_t(1) << 25;

  /// F_ij, 0 where nothing is stored. O(log n) in a sparse row, O(runs) in the symmetric form.
  double at(std::size_t i, std::size_t j) const;

  /// y = F x for all bands, one pass over what is stored, in parallel, same bits for any thread
  /// count. x, y: N * bands, row-major, not aliased. `wanted`: N flags, of the rows to compute;
  /// elsewhere y stays as it is. Empty: all.
  void product(std::span<const double> x, int bands, std::span<double> y,
               std::span<const std::uint8_t> wanted = {}) const;
  /// One row after the other, in the order of storage (row form: as numbered): calls
  /// update(i, gathered) with gathered[b] = sum_j F_ij x[j * bands + b], x as the updates so far
  /// have left it. An update may change x of patch i and of no other. Rows that are not `wanted`
  /// are passed over. One pass over what is stored, on one thread.
  using Update = std::function<void(std::size_t i, const double* gathered)>;
  void sweep(std::span<double> x, int bands, const Update& update,
             std::span<const std::uint8_t> wanted = {}) const;

  std::vector<Index> rowEntries() const;  ///< N: how many entries of a row are not 0
  std::size_t nonZeros() const;           ///< of the N x N matrix
  std::vector<double> rowSums() const;    ///< N
  std::size_t bytes() const;              ///< of the stored values and indices
  std::size_t denseRows() const;          ///< row form: how many rows are stored dense

 private:
  friend class RowPanel;
  struct Row;
  RowView viewOf(std::size_t i) const;  // row form
  std::size_t panelEnd(std::size_t first) const;
  /// Row i of `out` (N values each) becomes row first + i of the matrix.
  void spreadRows(std::size_t first, std::size_t last, std::span<double> out) const;
  void checkFactors(std::size_t k, std::span<const double> factors) const;
  void symmetricProduct(std::span<const double> x, int bands, std::span<double> y,
                        std::span<const std::uint8_t> wanted) const;
  void symmetricSweep(std::span<double> x, int bands, const Update& update,
                      std::span<const std::uint8_t> wanted) const;
  /// Symmetric form: F between positions k <= later, as stored.
  double storedUpper(std::size_t k, std::size_t later) const;

  std::vector<double> area_;
  Precision precision_ = Precision::single_precision;
  bool symmetric_ = false;
  std::vector<Row> rows_;            // row form
  std::vector<Index> order_;         // symmetric form: patch by position,
  std::vector<Index> position_;      // position by patch,
  std::vector<RunRow> upper_;        // by position k: F to positions k + 1, ...
  std::vector<double> diagonal_;     // by position
  std::vector<Index> without_area_;  // positions of patches of area 0
};

}  // namespace radiosity

#include "radiosity/row_panel.h"  // forRow() and forPanels()
