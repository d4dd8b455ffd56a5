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
  /// Does a block and returns what process 0 is to know of it. Called by one thread of each
  /// process.
  std::function<std::vector<std::byte>(std::size_t block)> run;
  /// In process 0, on the calling thread: what became of a block, and of which process.
  std::function<void(std::size_t block, std::span<const std::byte> bytes, int process)> take;
};

/// By all processes. Blocks are handed out in order, one at a time, so that those who are quick get
/// more; process 0 works as well. Throws what run() or take() throw in process 0, and Cancelled.
void handOut(Processes& processes, const BlockWork& work, Progress& progress);

}  // namespace radiosity
