#include "formfactor/rays/cast_blocks.h"

#include <utility>

#include "base/scratch_rows.h"

namespace radiosity {

CastBlocks::CastBlocks(const RayScene& scene, std::vector<RowToCast> todo,
                       std::vector<RayRow>& rows, int round, const RowRun& run)
    : scene_(scene), run_(run), todo_(std::move(todo)), rows_(&rows), round_(round) {
  broadcastTodo();
}

CastBlocks::CastBlocks(const RayScene& scene, const RowRun& run) : scene_(scene), run_(run) {
  broadcastTodo();
  counted_.resize(todo_.size());
}

void CastBlocks::endRounds(const RowRun& run) {
  if (run.processes == nullptr) return;
  std::vector<RowToCast> none;
  run.processes->broadcastArray(none, [&run] { run.progress.check(); });
}

void CastBlocks::broadcastTodo() {
  if (run_.processes == nullptr) return;
  run_.processes->broadcastArray(todo_, [this] { run_.progress.check(); });
}

void CastBlocks::make(std::size_t block) {
  const RowToCast& todo = todo_[block];
  if (rows_ == nullptr) {
    counted_[block].rays = todo.from;
    scene_.cast(todo.position, todo.to, counted_[block], run_.progress);
    return;
  }
  RayRow& row = (*rows_)[todo.position];
  scene_.cast(todo.position, todo.to, row, run_.progress);
  touchRows(run_.scratch.get(), row.bytes());
}

void CastBlocks::put(std::size_t block, ByteWriter& bytes) const {
  putRayRow((*rows_)[todo_[block].position], bytes);
}

bool CastBlocks::take(std::size_t block, ByteReader& bytes) {
  RayRow kept = takeRayRow(bytes);
  if (!bytes.isWhole() || kept.rays != todo_[block].to) return false;
  (*rows_)[todo_[block].position] = std::move(kept);
  return true;
}

void CastBlocks::tell(BlockRange range, ByteWriter& bytes) {
  for (std::size_t block = range.begin; block < range.end; ++block) {
    putRayRow(counted_[block], bytes);
    counted_[block] = RayRow();
  }
}

bool CastBlocks::hear(BlockRange range, ByteReader& bytes) {
  for (std::size_t block = range.begin; block < range.end; ++block) {
    RayRow& row = (*rows_)[todo_[block].position];
    row.add(takeRayRow(bytes));
    touchRows(run_.scratch.get(), row.bytes());
  }
  return true;
}

}  // namespace radiosity
