// The form-factor matrix: storage, rows and products. It knows no geometry. Functions of whole
// matrices are in matrix_functions.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/scratch_memory.h"

namespace [[gnu::visibility("default")]] radiosity {

enum class Precision { single_precision, double_precision };

class RowPanel;
class SharedRows;
struct RowView;
struct RunRow;

/// Form factors F of N patches, N x N, and the patches' areas; G_ij = A_i F_ij is the exchange
/// area. Stored values have 32 or 64 bits, all sums have 64.
///
/// Row form: each row F_i. is stored by itself, dense or as sorted (column, value) pairs, whichever
/// is smaller. The two values of a pair may be two estimates that differ.
///
/// Symmetric form: A_i F_ij = A_j F_ji by construction, in half the memory. The patches have an
/// order that is given once. F_ij is stored for j after i in that order, and F_ji = A_i F_ij / A_j
/// follows. A row leaves out its runs of zeros, so patches that do not see each other and are
/// neighbours in the order (coplanar ones) cost nothing. Storing F and not G keeps values within 0
/// and 1 in a scene of any size.
class ExchangeMatrix {
 public:
  ExchangeMatrix();
  /// Row form, all rows empty. `area`: N finite values >= 0, m^2, else InputError. `scratch`: holds
  /// the rows; null: they are in memory. Copies of the matrix are in memory.
  ExchangeMatrix(std::vector<double> area, Precision precision,
                 std::shared_ptr<ScratchMemory> scratch = nullptr);
  /// Symmetric form, all rows empty. `order`: each patch once, else InputError.
  static ExchangeMatrix symmetric(std::vector<double> area, std::vector<Index> order,
                                  Precision precision,
                                  std::shared_ptr<ScratchMemory> scratch = nullptr);
  /// A matrix whose rows lie in several processes (src/matrix/shared_rows.h). Its rows cannot be
  /// set. Functions that walk over stored rows one after the other (sweep(), upperRow() and its
  /// kin, closure, aggregation) throw RunError.
  static ExchangeMatrix shared(std::shared_ptr<const SharedRows> rows);
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

  /// Row form: stores row i. Columns are strictly increasing and below N, values finite and > 0,
  /// lengths equal, else InputError naming the row. Different rows may be set from different
  /// threads at once. Setting a row again replaces it.
  void setRow(std::size_t i, std::span<const Index> columns, std::span<const double> values);
  /// Symmetric form: factors[m] is F from patch order[k] to patch order[k + m]; m = 0 is the patch
  /// itself. At most N - k values, the rest are 0. Values are finite, >= 0, and 0 for a patch
  /// without area, else InputError naming the patches. Threads and setting again: as setRow().
  void setUpperRow(std::size_t k, std::span<const double> factors);
  /// The same for a row with few values, in O(values): factors[m] is F to the patch at
  /// positions[m]. Positions are strictly increasing, from k to below N, else InputError.
  void setUpperRow(std::size_t k, std::span<const Index> positions,
                   std::span<const double> factors);

  /// Symmetric form: copies the N - k stored (rounded) values of row k.
  void upperRow(std::size_t k, std::span<double> factors) const;
  /// The entries of row k that are not 0: their positions, from k on, and the values.
  struct UpperEntries {
    std::vector<Index> positions;
    std::vector<double> factors;
  };
  UpperEntries upperEntries(std::size_t k) const;
  /// Row k without its first value, in packed form (src/matrix/run_row.h), and that value.
  const RunRow& upperRuns(std::size_t k) const;
  double diagonal(std::size_t k) const { return diagonal_[k]; }

  /// Calls visit(column, value) over the entries of row i that are not 0, columns increasing.
  /// Symmetric form: O(N) or more, and memory for a row; use forPanels() for many rows.
  template <class Visit>
  void forRow(std::size_t i, Visit&& visit) const;
  /// The same for the entries with first <= column < last. O(log n + visited) in a sparse row.
  template <class Visit>
  void forRow(std::size_t i, std::size_t first, std::size_t last, Visit&& visit) const;
  /// Calls visit(panel), with a RowPanel (row_panel.h), for consecutive ranges of rows, which
  /// together are all rows in order. A panel of the symmetric form holds its entries, in at most
  /// panelBytes(), or it is one row.
  template <class Visit>
  void forPanels(Visit&& visit) const;
  /// The size makes at most about 50 panels, since each takes a walk over all stored rows.
  static std::size_t panelBytes(std::size_t matrix_bytes) {
    return std::max(kLeastPanelBytes, matrix_bytes / 8);
  }
  static constexpr std::size_t kLeastPanelBytes = std::size_t(1) << 25;

  /// F_ij, 0 if not stored. O(log n) in a sparse row, O(runs) in the symmetric form.
  double at(std::size_t i, std::size_t j) const;

  /// y = F x for all bands in one pass over the stored values, in parallel, with the same bits for
  /// any thread count. x, y: N * bands, row-major, not aliased. `wanted`: N flags of the rows to
  /// compute; others of y stay as they are. Empty: all.
  void product(std::span<const double> x, int bands, std::span<double> y,
               std::span<const std::uint8_t> wanted = {}) const;
  /// Calls update(i, gathered) for each row, in the order of storage (row form: as numbered), with
  /// gathered[b] = sum_j F_ij x[j * bands + b], where x includes the updates so far. An update may
  /// change x of patch i and of no other. Rows that are not `wanted` are skipped. One pass over the
  /// stored values, on one thread.
  using Update = std::function<void(std::size_t i, const double* gathered)>;
  void sweep(std::span<double> x, int bands, const Update& update,
             std::span<const std::uint8_t> wanted = {}) const;

  std::vector<Index> rowEntries() const;  ///< N: the number of entries of each row that are not 0
  std::size_t nonZeros() const;           ///< of the N x N matrix
  std::vector<double> rowSums() const;    ///< N
  std::size_t bytes() const;              ///< of the stored values and indices
  std::size_t denseRows() const;          ///< row form: the number of rows that are stored dense
  /// The scratch memory that holds the rows; null: they are in memory.
  const std::shared_ptr<ScratchMemory>& scratch() const { return scratch_.memory; }
  /// The processes that hold the rows; null: this one does.
  const SharedRows* sharedRows() const { return shared_.get(); }

 private:
  friend class RowPanel;
  struct Row;
  /// Not copied with the rows.
  struct Scratch {
    Scratch() = default;
    Scratch(const Scratch&) {}
    Scratch(Scratch&&) noexcept = default;
    Scratch& operator=(const Scratch&) = delete;
    std::shared_ptr<ScratchMemory> memory;
  };
  RowView viewOf(std::size_t i) const;  // row form
  void requireRows(const char* what) const;
  /// The panels of forPanels(): the end of each, and rowEntries(), empty in the row form. None has
  /// more than panelBytes() unless it is one row.
  struct Panels {
    std::vector<std::size_t> ends;
    std::vector<Index> entries;
  };
  Panels panels() const;
  void checkFactors(std::size_t k, std::span<const double> factors) const;
  void checkPositions(std::size_t k, std::span<const Index> positions,
                      std::span<const double> factors) const;
  void storeUpper(std::size_t k, double itself, RunRow row);
  void symmetricProduct(std::span<const double> x, int bands, std::span<double> y,
                        std::span<const std::uint8_t> wanted) const;
  void symmetricSweep(std::span<double> x, int bands, const Update& update,
                      std::span<const std::uint8_t> wanted) const;
  /// Symmetric form: F between positions k <= later, as stored.
  double storedUpper(std::size_t k, std::size_t later) const;

  Scratch scratch_;  // outlives the rows
  std::vector<double> area_;
  Precision precision_ = Precision::single_precision;
  bool symmetric_ = false;
  std::vector<Row> rows_;                     // row form
  std::vector<Index> order_;                  // symmetric form: patch by position,
  std::vector<Index> position_;               // position by patch,
  std::vector<RunRow> upper_;                 // by position k: F to positions k + 1, ...
  std::vector<double> diagonal_;              // by position
  std::vector<Index> without_area_;           // positions of patches of area 0
  std::shared_ptr<const SharedRows> shared_;  // null: the rows are in this process
};

}  // namespace radiosity

#include "radiosity/row_panel.h"  // forRow() and forPanels()
