#include "formfactor/exact/assembly/task_blocks.h"

#include <optional>
#include <utility>

#include "matrix/run_bytes.h"
#include "matrix/uncertain_row.h"

namespace radiosity {

/// A row as it comes out of a journal.
struct TaskBlocks::Row {
  std::vector<double> factors;  ///< as for SymmetricMatrix::setUpperRow()
  std::vector<Index> later;     ///< as for UncertainEntries::setRow()
  std::vector<double> errors;
  double backs = 0;
  std::vector<SeenBack> seen_backs;
};

namespace {

/// Writes sums over pairs of rows from the one of rank `first` on.
void putSums(const RowSums& sums, std::size_t first, ByteWriter& bytes) {
  bytes.put(sums.visibility);
  bytes.put(sums.unoccluded);
  bytes.put(sums.occluded);
  bytes.put(sums.seconds_visibility);
  bytes.put(sums.seconds_unoccluded);
  bytes.put(sums.seconds_occluded);
  bytes.put(sums.seconds_assembly);
  sums.error.put(first, bytes);
}

/// False, with `sums` of no use, if the bytes are of another number of rows.
bool takeSums(std::size_t first, ByteReader& bytes, RowSums& sums) {
  sums.visibility = bytes.get<VisibilityCounts>();
  sums.unoccluded = bytes.get<UnoccludedCounts>();
  sums.occluded = bytes.get<OccludedCounts>();
  sums.seconds_visibility = bytes.get<double>();
  sums.seconds_unoccluded = bytes.get<double>();
  sums.seconds_occluded = bytes.get<double>();
  sums.seconds_assembly = bytes.get<double>();
  return sums.error.take(first, bytes);
}

}  // namespace

RowSums TaskBlocks::sums() {
  std::optional<RowSums> all = sums_.takeAll();
  return all ? *std::move(all) : RowSums(context_.order.ranked);
}

TaskBlocks::Ranks TaskBlocks::ranksOf(BlockRange range) const {
  const std::vector<Index>& rank = context_.order.rank;
  return {rank[tasks_[range.begin].front().first],
          std::size_t(rank[tasks_[range.end - 1].back().end - 1]) + 1};
}

std::size_t TaskBlocks::steps(std::size_t block) const {
  const Ranks ranks = ranksOf({block, block + 1});
  return ranks.end - ranks.first;
}

void TaskBlocks::make(std::size_t block) {
  Worker& worker = workers_.local();
  worker.sums = RowSums(context_.order.ranked);
  worker.assembly.run(tasks_[block], worker.sums);
}

void TaskBlocks::put(std::size_t block, ByteWriter& bytes) const {
  const Ranks ranks = ranksOf({block, block + 1});
  for (std::size_t rank = ranks.first; rank < ranks.end; ++rank) putRow(rank, bytes);
  putSums(workers_.local().sums, ranks.first, bytes);
}

bool TaskBlocks::take(std::size_t block, ByteReader& bytes) {
  const Ranks ranks = ranksOf({block, block + 1});
  std::vector<Row> rows;
  for (std::size_t rank = ranks.first; rank < ranks.end; ++rank) {
    rows.push_back(takeRow(rank, bytes));
  }
  RowSums sums(context_.order.ranked);
  if (!takeSums(ranks.first, bytes, sums) || !bytes.isWhole()) return false;
  for (std::size_t k = 0; k < rows.size(); ++k) store(ranks.first + k, std::move(rows[k]));
  workers_.local().sums = std::move(sums);
  return true;
}

void TaskBlocks::finish(std::size_t block) {
  sums_.putBlock(block, std::move(workers_.local().sums));
}

void TaskBlocks::tell(BlockRange range, ByteWriter& bytes) {
  const Ranks ranks = ranksOf(range);
  putSums(sums_.takePart(range), ranks.first, bytes);
  for (std::size_t k = ranks.first; k < ranks.end; ++k) {
    const Index patch = context_.order.patch[k];
    bytes.put(context_.backs[patch]);
    bytes.putArray(std::span<const SeenBack>(context_.seen_backs[patch]));
  }
}

bool TaskBlocks::hear(BlockRange range, ByteReader& bytes) {
  const Ranks ranks = ranksOf(range);
  RowSums sums(context_.order.ranked);
  takeSums(ranks.first, bytes, sums);
  sums_.putPart(range, std::move(sums));
  for (std::size_t k = ranks.first; k < ranks.end; ++k) {
    const Index patch = context_.order.patch[k];
    context_.backs[patch] = bytes.get<double>();
    context_.seen_backs[patch] = bytes.getArray<SeenBack>();
  }
  return false;
}

void TaskBlocks::putRow(std::size_t rank, ByteWriter& bytes) const {
  const RunRow& row = context_.matrix.upperRuns(rank);
  bytes.put(context_.matrix.diagonal(rank));
  putRuns(row, context_.matrix.precision(), bytes);
  if (context_.uncertain != nullptr) {
    const UncertainEntries::Row& errors = context_.uncertain->row(rank);
    putRuns(errors.runs, errors.codes, bytes);
  }
  const Index patch = context_.order.patch[rank];
  bytes.put(context_.backs[patch]);
  bytes.putArray(std::span<const SeenBack>(context_.seen_backs[patch]));
}

TaskBlocks::Row TaskBlocks::takeRow(std::size_t rank, ByteReader& bytes) const {
  Row row;
  row.factors.assign(context_.order.ranked - rank, 0.0);
  row.factors[0] = bytes.get<double>();
  const std::size_t later = row.factors.size() - 1;
  const auto put = [&](std::size_t offset, double value) { row.factors[1 + offset] = value; };
  takeRuns(bytes, context_.matrix.precision(), later, put);
  if (context_.uncertain != nullptr) {
    takeRuns<std::uint8_t>(bytes, later, [&](std::size_t offset, std::uint8_t code) {
      row.later.push_back(Index(rank + 1 + offset));
      row.errors.push_back(errorOfCode(code));
    });
  }
  row.backs = bytes.get<double>();
  row.seen_backs = bytes.getArray<SeenBack>();
  return row;
}

void TaskBlocks::store(std::size_t rank, Row row) const {
  context_.matrix.setUpperRow(rank, row.factors);
  if (context_.uncertain != nullptr && !row.later.empty()) {
    context_.uncertain->setRow(rank, row.later, row.errors);
  }
  const Index patch = context_.order.patch[rank];
  context_.backs[patch] = row.backs;
  context_.seen_backs[patch] = std::move(row.seen_backs);
}

}  // namespace radiosity
