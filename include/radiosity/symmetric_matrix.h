// Form factors stored as a triangle, one value a pair.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/exchange_matrix.h"
#include "radiosity/scratch_memory.h"

namespace [[gnu::visibility("default")]] radiosity {

struct RunRow;

/// A_i F_ij = A_j F_ji by construction, in half the memory of rows. The patches have an order that
/// is given once. F_ij is stored for j after i in that order, and F_ji = A_i F_ij / A_j follows. A
/// row leaves out its runs of zeros, so patches that do not see each other and are neighbours in
/// the order (coplanar ones) cost nothing. Storing F and not G keeps values within 0 and 1 in a
/// scene of any size. at() takes O(runs).
class SymmetricMatrix final : public ExchangeMatrix {
 public:
  /// All rows empty. `area`, `scratch`: as RowMatrix. `order`: each patch once, else InputError.
  SymmetricMatrix(std::vector<double> area, std::vector<Index> order, Precision precision,
                  std::shared_ptr<ScratchMemory> scratch = nullptr);
  SymmetricMatrix(SymmetricMatrix&&) noexcept;
  ~SymmetricMatrix() override;

  /// factors[m] is F from patch order[k] to patch order[k + m]; m = 0 is the patch itself. At most
  /// N - k values, the rest are 0. Values are finite, >= 0, and 0 for a patch without area, else
  /// InputError naming the patches. Different rows may be set from different threads at once.
  /// Setting a row again replaces it.
  void setUpperRow(std::size_t k, std::span<const double> factors);
  /// The same for a row with few values, in O(values): factors[m] is F to the patch at
  /// positions[m]. Positions are strictly increasing, from k to below N, else InputError.
  void setUpperRow(std::size_t k, std::span<const Index> positions,
                   std::span<const double> factors);

  /// Copies the N - k stored (rounded) values of row k.
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

  /// The scratch memory that holds the rows; null: they are in memory.
  const std::shared_ptr<ScratchMemory>& scratch() const { return scratch_; }

  double at(std::size_t i, std::size_t j) const override;
  std::vector<Index> rowEntries() const override;
  bool sweeps() const override { return true; }
  /// In the order of storage.
  void sweep(std::span<double> x, int bands, const Update& update,
             std::span<const std::uint8_t> wanted) const override;
  /// The connected components, numbered by the first patch stored. The search walks once over the
  /// stored entries and ends as soon as all patches are joined.
  Rooms rooms() const override;
  std::size_t bytes() const override;

 private:
  void multiply(std::span<const double> x, int bands, std::span<double> y,
                std::span<const std::uint8_t> wanted) const override;
  void readRows(std::size_t first, std::size_t last, std::span<const Index> entries,
                CompressedRows& rows) const override;
  std::size_t panelEntries() const override;
  void checkFactors(std::size_t k, std::span<const double> factors) const;
  void checkPositions(std::size_t k, std::span<const Index> positions,
                      std::span<const double> factors) const;
  void storeUpper(std::size_t k, double itself, RunRow row);
  /// F between positions k <= later, as stored.
  double storedUpper(std::size_t k, std::size_t later) const;

  std::shared_ptr<ScratchMemory> scratch_;  // outlives the rows
  std::vector<Index> position_;             // position by patch
  std::vector<RunRow> upper_;               // by position k: F to positions k + 1, ...
  std::vector<double> diagonal_;            // by position
  std::vector<Index> without_area_;         // positions of patches of area 0
};

}  // namespace radiosity
