// Form factors stored row by row.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/exchange_matrix.h"
#include "radiosity/scratch_memory.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Each row F_i. is stored by itself, dense or as sorted (column, value) pairs, whichever is
/// smaller. The two values of a pair may be two estimates that differ.
class RowMatrix final : public ExchangeMatrix {
 public:
  /// All rows empty. `area`: N finite values >= 0, m^2, else InputError. `scratch`: holds the rows;
  /// null: they are in memory.
  RowMatrix(std::vector<double> area, Precision precision,
            std::shared_ptr<ScratchMemory> scratch = nullptr);
  RowMatrix(RowMatrix&&) noexcept;
  ~RowMatrix() override;

  /// Stores row i. Columns are strictly increasing and below N, values finite and > 0, lengths
  /// equal, else InputError naming the row. Different rows may be set from different threads at
  /// once. Setting a row again replaces it.
  void setRow(std::size_t i, std::span<const Index> columns, std::span<const double> values);

  std::size_t denseRows() const;  ///< the number of rows that are stored dense
  /// The scratch memory that holds the rows; null: they are in memory.
  const std::shared_ptr<ScratchMemory>& scratch() const { return scratch_; }

  std::vector<Index> rowEntries() const override;
  bool sweeps() const override { return true; }
  void sweep(std::span<double> x, int bands, const Update& update,
             std::span<const std::uint8_t> wanted) const override;
  std::size_t bytes() const override;

 private:
  struct Row;
  void multiply(std::span<const double> x, int bands, std::span<double> y,
                std::span<const std::uint8_t> wanted) const override;
  void readRows(std::size_t, std::size_t, std::span<const Index>, CompressedRows&) const override {}
  RowView viewOf(std::size_t i) const override;
  std::size_t panelEntries() const override { return 0; }

  std::shared_ptr<ScratchMemory> scratch_;  // outlives the rows
  std::vector<Row> rows_;
};

}  // namespace radiosity
