// Rays of one round cast by several processes.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/processes.h"
#include "formfactor/rays/ray_scene.h"

namespace radiosity {

/// A row that is to have `to` rays in each replicate and has `from`, fewer.
struct RowToCast {
  Index position;
  std::uint32_t from;
  std::uint32_t to;
};

/// Takes the counts of a row's new rays, on process 0's calling thread.
using TakeCounts = std::function<void(const RowToCast& row, const RayRow& counted)>;

/// Called by process 0 while the others are in castForOthers(): casts all of `rows`, at least one,
/// handed out in this order. Rays are numbered and counts are whole numbers: the sums do not depend
/// on who casts them.
void castTogether(Processes& processes, const RayScene& scene, std::vector<RowToCast> rows,
                  const TakeCounts& take, Progress& progress);

/// Called by process 0 after the last round.
void endCasting(Processes& processes, Progress& progress);

/// Called by the others: casts what falls to this process, until process 0 is done with all rounds.
void castForOthers(Processes& processes, const RayScene& scene, Progress& progress);

}  // namespace radiosity
