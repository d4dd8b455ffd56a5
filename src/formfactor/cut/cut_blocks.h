// Rows that are cut, some neighbours in the tree a block.
#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/cut/row_cutter.h"
#include "formfactor/row_blocks.h"

namespace radiosity {

class CutBlocks final : public RowBlocks {
 public:
  /// `rays`: of each row, in each replicate. `cutter` and `progress` are kept by reference.
  CutBlocks(const RowCutter& cutter, std::uint32_t rays, const Progress& progress);

  /// Once all are made.
  std::vector<CutRows> takeRows() { return std::move(rows_); }
  /// By place in the tree.
  const std::vector<CutCounts>& counts() const { return counts_; }

  std::size_t count() const override { return rows_.size(); }
  std::size_t steps(std::size_t block) const override;
  void make(std::size_t block) override;
  RowBlock kind() const override { return RowBlock::cut_rows; }
  std::uint64_t number(std::size_t block) const override { return block; }
  void put(std::size_t block, ByteWriter& bytes) const override;
  bool take(std::size_t block, ByteReader& bytes) override;
  void tell(BlockRange range, ByteWriter& bytes) override;
  bool hear(BlockRange range, ByteReader& bytes) override;

 private:
  const RowCutter& cutter_;
  std::uint32_t rays_;
  const Progress& progress_;
  std::vector<CutRows> rows_;
  std::vector<CutCounts> counts_;
};

}  // namespace radiosity
