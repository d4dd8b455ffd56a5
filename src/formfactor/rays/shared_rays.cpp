#include "formfactor/rays/shared_rays.h"

#include <utility>

#include "base/hand_out.h"
#include "base/parallel.h"
#include "formfactor/rays/round_journal.h"

namespace radiosity {

namespace {

/// Blocks for each process: many, so that nobody waits long for the slowest.
constexpr std::size_t kRayBlocksAProcess = 32;

/// The beginnings of blocks of about equal numbers of rays, and the end.
std::vector<std::size_t> blocksOf(const std::vector<RowToCast>& rows, std::size_t most) {
  std::size_t total = 0;
  for (const RowToCast& row : rows) total += row.to - row.from;
  std::vector<std::size_t> starts{0};
  std::size_t rays = 0;
  for (std::size_t t = 0; t + 1 < rows.size(); ++t) {
    rays += rows[t].to - rows[t].from;
    if (rays * most >= starts.size() * total) starts.push_back(t + 1);
  }
  starts.push_back(rows.size());
  return starts;
}

/// Casts a round by all processes.
void castRound(Processes& processes, const RayScene& scene, const std::vector<RowToCast>& rows,
               const TakeCounts& take, Progress& progress) {
  const std::vector<std::size_t> starts =
      blocksOf(rows, kRayBlocksAProcess * std::size_t(processes.size()));
  BlockWork work;
  work.blocks = starts.size() - 1;
  work.run = [&](std::size_t block) {
    std::vector<RayRow> counted(starts[block + 1] - starts[block]);
    parallelFor(counted.size(), 1, [&](std::size_t m) {
      const RowToCast& row = rows[starts[block] + m];
      counted[m].rays = row.from;
      scene.cast(row.position, row.to, counted[m], progress);
    });
    ByteWriter bytes;
    for (const RayRow& row : counted) putRayRow(row, bytes);
    return std::vector<std::byte>(bytes.bytes().begin(), bytes.bytes().end());
  };
  work.take = [&](std::size_t block, std::span<const std::byte> from, int /*process*/) {
    ByteReader bytes(from);
    for (std::size_t t = starts[block]; t < starts[block + 1]; ++t) {
      take(rows[t], takeRayRow(bytes));
      progress.advance(kReplicates * std::size_t(rows[t].to - rows[t].from));
    }
  };
  handOut(processes, work, progress);
}

}  // namespace

void castTogether(Processes& processes, const RayScene& scene, std::vector<RowToCast> rows,
                  const TakeCounts& take, Progress& progress) {
  processes.broadcastArray(rows, [&] { progress.check(); });
  castRound(processes, scene, rows, take, progress);
}

void endCasting(Processes& processes, Progress& progress) {
  std::vector<RowToCast> none;
  processes.broadcastArray(none, [&] { progress.check(); });
}

void castForOthers(Processes& processes, const RayScene& scene, Progress& progress) {
  for (;;) {
    std::vector<RowToCast> rows;
    processes.broadcastArray(rows);
    if (rows.empty()) return;
    castRound(processes, scene, rows, {}, progress);
  }
}

}  // namespace radiosity
