#include "formfactor/exact/assembly/task_journal.h"

#include <utility>

#include "matrix/run_bytes.h"
#include "matrix/uncertain_row.h"

namespace radiosity {

/// A row as it comes out of the journal.
struct TaskJournal::Row {
  std::vector<double> factors;  ///< as for SymmetricMatrix::setUpperRow()
  std::vector<Index> later;     ///< as for UncertainEntries::setRow()
  std::vector<double> errors;
  double backs = 0;
  std::vector<SeenBack> seen_backs;
};

namespace {

/// Counts that are added up over tasks.
void putCounts(const RowSums& sums, ByteWriter& bytes) {
  bytes.put(sums.visibility);
  bytes.put(sums.unoccluded);
  bytes.put(sums.occluded);
  bytes.put(sums.seconds_visibility);
  bytes.put(sums.seconds_unoccluded);
  bytes.put(sums.seconds_occluded);
  bytes.put(sums.seconds_assembly);
}

void takeCounts(ByteReader& bytes, RowSums& sums) {
  sums.visibility = bytes.get<VisibilityCounts>();
  sums.unoccluded = bytes.get<UnoccludedCounts>();
  sums.occluded = bytes.get<OccludedCounts>();
  sums.seconds_visibility = bytes.get<double>();
  sums.seconds_unoccluded = bytes.get<double>();
  sums.seconds_occluded = bytes.get<double>();
  sums.seconds_assembly = bytes.get<double>();
}

}  // namespace

void putSums(const RowSums& sums, std::size_t first, ByteWriter& bytes) {
  putCounts(sums, bytes);
  sums.error.put(first, bytes);
}

bool takeSums(std::size_t first, ByteReader& bytes, RowSums& sums) {
  takeCounts(bytes, sums);
  return sums.error.take(first, bytes);
}

TaskJournal::TaskJournal(RowJournal* journal, const RowContext& context, const RowTasks& tasks)
    : journal_(journal), context_(context), tasks_(tasks) {
  if (journal_ == nullptr) return;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    if (!journal_->has(RowBlock::exact_task, t)) continue;
    const Ranks ranks = ranksOf(t);
    found_ += ranks.end - ranks.first;
  }
  journal_->found(found_, context.order.ranked);
}

TaskJournal::Ranks TaskJournal::ranksOf(std::size_t task) const {
  const std::span<const ElementRange> ranges = tasks_[task];
  const std::vector<Index>& rank = context_.order.rank;
  return {rank[ranges.front().first], std::size_t(rank[ranges.back().end - 1]) + 1};
}

bool TaskJournal::take(std::size_t task, RowSums& sums) const {
  if (journal_ == nullptr || !journal_->has(RowBlock::exact_task, task)) return false;
  const std::vector<std::byte> block = journal_->kept(RowBlock::exact_task, task);
  ByteReader bytes(block);
  const Ranks ranks = ranksOf(task);
  std::vector<Row> rows;
  for (std::size_t rank = ranks.first; rank < ranks.end; ++rank) {
    rows.push_back(takeRow(rank, bytes));
  }
  RowSums found(context_.order.ranked);
  if (!takeSums(ranks.first, bytes, found) || !bytes.isWhole()) return false;
  for (std::size_t k = 0; k < rows.size(); ++k) store(ranks.first + k, std::move(rows[k]));
  sums = std::move(found);
  return true;
}

void TaskJournal::keep(std::size_t task, const RowSums& sums) const {
  if (journal_ == nullptr) return;
  const Ranks ranks = ranksOf(task);
  ByteWriter bytes;
  for (std::size_t rank = ranks.first; rank < ranks.end; ++rank) putRow(rank, bytes);
  putSums(sums, ranks.first, bytes);
  journal_->keep(RowBlock::exact_task, task, bytes.bytes());
}

void TaskJournal::putRow(std::size_t rank, ByteWriter& bytes) const {
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

TaskJournal::Row TaskJournal::takeRow(std::size_t rank, ByteReader& bytes) const {
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

void TaskJournal::store(std::size_t rank, Row row) const {
  context_.matrix.setUpperRow(rank, row.factors);
  if (context_.uncertain != nullptr && !row.later.empty()) {
    context_.uncertain->setRow(rank, row.later, row.errors);
  }
  const Index patch = context_.order.patch[rank];
  context_.backs[patch] = row.backs;
  context_.seen_backs[patch] = std::move(row.seen_backs);
}

}  // namespace radiosity
