// Rows that a round of rays continues, a block each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formfactor/rays/ray_scene.h"
#include "formfactor/rays/round_journal.h"
#include "formfactor/row_blocks.h"

namespace radiosity {

/// A row that is to have `to` rays in each replicate and has `from`, fewer.
struct RowToCast {
  Index position;
  std::uint32_t from;
  std::uint32_t to;
};

/// Process 0 has all rows; the others send it what they count. Rays are numbered and counts are
/// whole numbers: the sums do not depend on who casts them.
class CastBlocks final : public RowBlocks {
 public:
  /// In process 0, which tells the others. `todo`: at least one. Keeps `scene` and `rows` by
  /// reference; rows are by position, with todo.from rays.
  CastBlocks(const RayScene& scene, std::vector<RowToCast> todo, std::vector<RayRow>& rows,
             int round, const RowRun& run);
  /// In the others: the round that process 0 begins; empty if there is none any more.
  CastBlocks(const RayScene& scene, const RowRun& run);
  /// Tells them, in process 0, that there is none any more.
  static void endRounds(const RowRun& run);

  std::size_t count() const override { return todo_.size(); }
  std::size_t steps(std::size_t block) const override {
    return kReplicates * std::size_t(todo_[block].to - todo_[block].from);
  }
  void make(std::size_t block) override;
  RowBlock kind() const override { return RowBlock::ray_row; }
  std::uint64_t number(std::size_t block) const override {
    return RoundJournal::number(round_, todo_[block].position, scene_.size());
  }
  void put(std::size_t block, ByteWriter& bytes) const override;
  bool take(std::size_t block, ByteReader& bytes) override;
  void tell(BlockRange range, ByteWriter& bytes) override;
  bool hear(BlockRange range, ByteReader& bytes) override;

 private:
  void broadcastTodo();

  const RayScene& scene_;
  RowRun run_;
  std::vector<RowToCast> todo_;
  std::vector<RayRow>* rows_ = nullptr;  ///< by position, in process 0
  std::vector<RayRow> counted_;          ///< by block, in the others
  int round_ = 0;
};

}  // namespace radiosity
