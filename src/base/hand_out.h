// Blocks of work handed out to processes as they ask.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "base/processes.h"
#include "radiosity/base.h"

namespace radiosity {

struct BlockWork {
  std::size_t blocks = 0;
  /// Computes a block and returns its result for process 0. Called by one thread of each process.
  std::function<std::vector<std::byte>(std::size_t block)> run;
  /// Takes the result of a block and the process that computed it. Called in process 0, on the
  /// calling thread.
  std::function<void(std::size_t block, std::span<const std::byte> bytes, int process)> take;
};

/// Hands out all blocks in order, one at a time, so that quick processes get more; process 0 works
/// as well. All processes must call it. Rethrows exceptions of run() and take() in process 0;
/// throws Cancelled.
void handOut(Processes& processes, const BlockWork& work, Progress& progress);

}  // namespace radiosity
