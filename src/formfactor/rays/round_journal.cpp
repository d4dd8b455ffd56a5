#include "formfactor/rays/round_journal.h"

#include <algorithm>
#include <utility>

namespace radiosity {

void RoundJournal::keep(int round, const RayRound& decided) const {
  if (journal_ == nullptr) return;
  ByteWriter bytes;
  bytes.put(known_);
  bytes.putArray(std::span(decided.rays));
  bytes.putArray(std::span(decided.before));
  bytes.putArray(std::span(decided.now));
  bytes.put(decided.common);
  bytes.put(decided.usual_norm);
  bytes.put(decided.usual_whole_norm);
  bytes.put(decided.loosened);
  journal_->keep(RowBlock::ray_round, std::uint64_t(round), bytes.bytes());
}

std::optional<RayRound> RoundJournal::take(int round) const {
  if (journal_ == nullptr || !journal_->has(RowBlock::ray_round, std::uint64_t(round))) return {};
  const std::vector<std::byte> block = journal_->kept(RowBlock::ray_round, std::uint64_t(round));
  ByteReader bytes(block);
  if (bytes.get<std::uint64_t>() != known_) return {};
  RayRound decided;
  decided.rays = bytes.getArray<std::uint32_t>();
  decided.before = bytes.getArray<RowState>();
  decided.now = bytes.getArray<RowState>();
  decided.common = bytes.get<CommonError>();
  decided.usual_norm = bytes.get<double>();
  decided.usual_whole_norm = bytes.get<double>();
  decided.loosened = bytes.get<double>();
  const bool fits =
      decided.rays.size() == rows_ && decided.before.size() == rows_ && decided.now.size() == rows_;
  if (!bytes.isWhole() || !fits) return {};
  return decided;
}

/// Columns as distances from the one before, and all in as few bytes as they need: most counts of
/// most rows are small.
void putRayRow(const RayRow& row, ByteWriter& bytes) {
  bytes.put(row.rays);
  bytes.put(row.sky);
  bytes.put(row.window);
  bytes.putVarint(row.columns.size());
  Index before = 0;
  for (std::size_t e = 0; e < row.columns.size(); ++e) {
    bytes.putVarint(row.columns[e] - before);
    for (const std::uint32_t hits : row.hits[e]) bytes.putVarint(hits);
    before = row.columns[e];
  }
}

RayRow takeRayRow(ByteReader& bytes) {
  RayRow row;
  row.rays = bytes.get<std::uint32_t>();
  row.sky = bytes.get<std::array<std::uint32_t, kReplicates>>();
  row.window = bytes.get<double>();
  // An entry takes a byte or more: there are no more entries than bytes left.
  const std::size_t entries = std::min<std::size_t>(bytes.getVarint(), bytes.left());
  row.columns.reserve(entries);
  row.hits.reserve(entries);
  Index column = 0;
  for (std::size_t e = 0; e < entries; ++e) {
    column += Index(bytes.getVarint());
    row.columns.push_back(column);
    auto& hits = row.hits.emplace_back();
    for (std::uint32_t& of_replicate : hits) of_replicate = std::uint32_t(bytes.getVarint());
  }
  return row;
}

bool RoundJournal::hasRow(int round, std::size_t position) const {
  return journal_ != nullptr && journal_->has(RowBlock::ray_row, number(round, position, rows_));
}

bool RoundJournal::takeRow(int round, std::size_t position, std::uint32_t rays, RayRow& row) const {
  if (!hasRow(round, position)) return false;
  const std::vector<std::byte> block =
      journal_->kept(RowBlock::ray_row, number(round, position, rows_));
  ByteReader bytes(block);
  RayRow kept = takeRayRow(bytes);
  if (!bytes.isWhole() || kept.rays != rays) return false;
  row = std::move(kept);
  return true;
}

}  // namespace radiosity
