// Tasks of the exact method done by several processes.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "base/processes.h"
#include "formfactor/exact/assembly/row_assembly.h"
#include "formfactor/exact/assembly/row_tasks.h"

namespace radiosity {

/// Tasks `begin` to `end` - 1, with their sums: made in a tree that halves ranges, so that they are
/// the same for any number of threads.
using SumTasks = std::function<RowSums(std::size_t begin, std::size_t end)>;

/// Makes rows by all processes. The tree of sums halves ranges; these are handed out, and process 0
/// adds their sums up by the same tree: the same bits for any number of processes. Each process
/// stores the rows that it made; process 0 gets their backs and the sums. The others get empty
/// sums.
RowSums shareTasks(Processes& processes, const RowContext& context, const RowTasks& tasks,
                   const SumTasks& sum, Progress& progress);

}  // namespace radiosity
