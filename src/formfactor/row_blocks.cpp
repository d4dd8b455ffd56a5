#include "formfactor/row_blocks.h"

#include <algorithm>
#include <atomic>

#include "base/hand_out.h"
#include "base/parallel.h"

namespace radiosity {
namespace {

/// Ranges for each process: many, so that nobody waits long for the slowest.
constexpr std::size_t kRangesAProcess = 32;
/// A process gets at most so many where rows stay with it: its memory is bounded.
constexpr std::size_t kMostRangesAProcess = 40;

void keep(const RowBlocks& blocks, std::size_t block, RowJournal* journal) {
  if (journal == nullptr) return;
  ByteWriter bytes;
  blocks.put(block, bytes);
  journal->keep(blocks.kind(), blocks.number(block), bytes.bytes());
}

bool isKept(const RowBlocks& blocks, std::size_t block, const RowJournal* journal) {
  return journal != nullptr && journal->has(blocks.kind(), blocks.number(block));
}

bool takeKept(RowBlocks& blocks, std::size_t block, const RowJournal* journal) {
  if (!isKept(blocks, block, journal)) return false;
  const std::vector<std::byte> kept = journal->kept(blocks.kind(), blocks.number(block));
  ByteReader bytes(kept);
  return blocks.take(block, bytes);
}

void makeByDevice(RowBlocks& blocks, BlockRange range, std::vector<std::uint8_t>& stored,
                  const RowRun& run) {
  std::vector<std::size_t> left;
  for (std::size_t k = 0; k < stored.size(); ++k) {
    if (stored[k] == 0) left.push_back(range.begin + k);
  }
  blocks.makeByDevice(left, [&](std::size_t block) {
    keep(blocks, block, run.journal);
    blocks.finish(block);
    stored[block - range.begin] = 1;
  });
}

/// Takes or makes the blocks of a range. Returns the steps of those that it made.
std::size_t makeRange(RowBlocks& blocks, BlockRange range, const RowRun& run) {
  std::vector<std::uint8_t> stored(range.end - range.begin, 0);
  if (run.journal != nullptr) {
    parallelFor(stored.size(), 1, [&](std::size_t k) {
      if (run.progress.cancelled() || !takeKept(blocks, range.begin + k, run.journal)) return;
      blocks.finish(range.begin + k);
      stored[k] = 1;
    });
  }
  makeByDevice(blocks, range, stored, run);
  std::atomic<std::size_t> steps{0};
  parallelFor(stored.size(), 1, [&](std::size_t k) {
    const std::size_t block = range.begin + k;
    if (run.progress.cancelled() || stored[k] != 0) return;
    blocks.make(block);
    if (run.progress.cancelled()) return;  // it may be half made
    keep(blocks, block, run.journal);
    blocks.finish(block);
    steps.fetch_add(blocks.steps(block), std::memory_order_relaxed);
    run.progress.advance(blocks.steps(block));
  });
  run.progress.check();
  return steps;
}

void shareBlocks(RowBlocks& blocks, const RowRun& run) {
  Processes& processes = *run.processes;
  const std::vector<std::size_t> starts =
      blocks.starts(kRangesAProcess * std::size_t(processes.size()));
  const auto rangeOf = [&](std::size_t k) { return BlockRange{starts[k], starts[k + 1]}; };
  BlockWork work;
  work.blocks = starts.size() - 1;
  if (blocks.rowsStay()) work.most_a_process = kMostRangesAProcess;
  work.run = [&](std::size_t k) {
    const std::size_t steps = makeRange(blocks, rangeOf(k), run);
    ByteWriter bytes;
    if (processes.rank() == 0) return bytes.take();
    bytes.put(steps);
    blocks.tell(rangeOf(k), bytes);
    return bytes.take();
  };
  work.take = [&](std::size_t k, std::span<const std::byte> from, int process) {
    if (process == 0) return;
    ByteReader bytes(from);
    run.progress.advance(bytes.get<std::size_t>());
    const BlockRange range = rangeOf(k);
    if (!blocks.hear(range, bytes)) return;
    for (std::size_t b = range.begin; b < range.end; ++b) keep(blocks, b, run.journal);
  };
  handOut(processes, work, run.progress);
}

}  // namespace

std::vector<std::size_t> RowBlocks::starts(std::size_t most) const {
  std::size_t total = 0;
  for (std::size_t b = 0; b < count(); ++b) total += steps(b);
  std::vector<std::size_t> starts{0};
  std::size_t before = 0;
  for (std::size_t b = 0; b + 1 < count(); ++b) {
    before += steps(b);
    if (before * most >= starts.size() * total) starts.push_back(b + 1);
  }
  if (count() > 0) starts.push_back(count());
  return starts;
}

void makeBlocks(RowBlocks& blocks, const RowRun& run) {
  if (run.processes != nullptr) return shareBlocks(blocks, run);
  makeRange(blocks, {0, blocks.count()}, run);
}

void makeAllRows(RowBlocks& blocks, const RowRun& run) {
  std::size_t all = 0;
  std::size_t found = 0;
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    all += blocks.steps(b);
    found += isKept(blocks, b, run.journal) ? blocks.steps(b) : 0;
  }
  if (run.journal != nullptr) run.journal->found(found, all);
  run.progress.begin("form factors", all, "rows", found);
  makeBlocks(blocks, run);
  run.progress.check();
  run.progress.end();
}

}  // namespace radiosity
