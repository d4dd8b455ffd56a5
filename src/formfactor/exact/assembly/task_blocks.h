// Tasks of the exact method as blocks of rows.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <vector>

#include "base/byte_stream.h"
#include "formfactor/block_sums.h"
#include "formfactor/exact/assembly/row_assembly.h"
#include "formfactor/exact/assembly/row_tasks.h"
#include "formfactor/row_blocks.h"

namespace radiosity {

/// A block a task. In a journal it is the task's rows as they are stored, the errors of their
/// entries, the black backs that they see, and the task's part of the sums over all pairs. Rows
/// stay in the process that makes them; process 0 gets their backs and the sums.
class TaskBlocks final : public RowBlocks {
 public:
  /// The first `count` tasks. Keeps the others by reference.
  TaskBlocks(const RowContext& context, const RowTasks& tasks, std::size_t count)
      : context_(context), tasks_(tasks), sums_(count), count_(count), workers_([this] {
          return Worker(context_);
        }) {}

  /// Of all tasks, once they are made. In process 0.
  RowSums sums();

  std::size_t count() const override { return count_; }
  std::size_t steps(std::size_t block) const override;
  void make(std::size_t block) override;
  RowBlock kind() const override { return RowBlock::exact_task; }
  std::uint64_t number(std::size_t block) const override { return block; }
  void put(std::size_t block, ByteWriter& bytes) const override;
  bool take(std::size_t block, ByteReader& bytes) override;
  void finish(std::size_t block) override;
  std::vector<std::size_t> starts(std::size_t most) const override { return sums_.starts(most); }
  void tell(BlockRange range, ByteWriter& bytes) override;
  bool hear(BlockRange range, ByteReader& bytes) override;

 private:
  struct Row;
  struct Ranks {
    std::size_t first;
    std::size_t end;
  };
  Ranks ranksOf(BlockRange range) const;
  void putRow(std::size_t rank, ByteWriter& bytes) const;
  Row takeRow(std::size_t rank, ByteReader& bytes) const;
  void store(std::size_t rank, Row row) const;

  /// What a thread holds.
  struct Worker {
    explicit Worker(const RowContext& context) : assembly(context), sums(context.order.ranked) {}
    RowAssembly assembly;
    RowSums sums;  ///< of its last task
  };
  const RowContext& context_;
  const RowTasks& tasks_;
  BlockSums<RowSums> sums_;
  std::size_t count_;
  mutable tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace radiosity
