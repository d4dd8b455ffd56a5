// Blocks of work handed out to processes as they ask.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "base/processes.h"
#include "radiosity/base.h"

namespace radiosity {

struct BlockWork {
  std::size_t blocks = 0;
  /// A process gets at most so many, which bounds the memory of their results.
  std::size_t most_a_process = std::numeric_limits<std::size_t>::max();
  /// Computes a block and returns its result for process 0. Called by one thread of each process.
  std::function<std::vector<std::byte>(std::size_t block)> run;
  /// Takes the result of a block and the process that computed it. Called in process 0, on the
  /// calling thread.
  std::function<void(std::size_t block, std::span<const std::byte> bytes, int process)> take;
};

/// Hands out all blocks in order, one at a time, so that quick processes get more; process 0 works
/// as well. All processes must call it; the most that they may get must be all blocks or more.
/// Rethrows exceptions of run() and take() in process 0; throws Cancelled.
void handOut(Processes& processes, const BlockWork& work, Progress& progress);

}  // namespace radiosity
