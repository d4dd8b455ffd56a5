// Blocks of whole rows, dealt to processes that hold parts of all rows: each process puts its
// blocks together from the parts of all, and does something with them (writes them to a file).
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/processes.h"
#include "matrix/row_parts.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Takes the blocks of one process. All functions may throw; then the deal ends.
class BlockTaker {
 public:
  BlockTaker() = default;
  virtual ~BlockTaker() = default;
  BlockTaker(const BlockTaker&) = delete;
  BlockTaker& operator=(const BlockTaker&) = delete;
  virtual void take(std::size_t block, const CompressedRows& rows) = 0;
  virtual void end() = 0;
};

/// Makes the taker of a process from the job that process 0 sends to all.
using MakeTaker = std::function<std::unique_ptr<BlockTaker>(std::span<const std::byte> job)>;

/// The blocks and the job; the same in all processes.
struct DealtBlocks {
  std::vector<RowRange> blocks;  ///< in order; neighbours may share rows
  std::vector<std::byte> job;

  void send(Processes& processes, const WhileWaiting& waiting);
  static DealtBlocks receive(Processes& processes);
};

/// One process's side of a deal. All processes call each function, in the same order.
class Dealing {
 public:
  /// Keeps `processes` and `own`, the rows of this process, by reference.
  Dealing(Processes& processes, const ExchangeMatrix& own, DealtBlocks dealt,
          const MakeTaker& make_taker);
  /// The number of rounds. In each, every process gets at most one block.
  std::size_t rounds() const;
  /// The rows before the end of the first `rounds` rounds.
  std::size_t rowsDone(std::size_t rounds) const;
  /// Process 0 gets the message of a process whose taker threw, or an empty text.
  std::string round(std::size_t number, const WhileWaiting& waiting);
  /// After the last round; returns the same.
  std::string end(const WhileWaiting& waiting);

 private:
  /// Runs a part of the taker's work unless it has failed, and keeps the message of its exception.
  template <class Work>
  void guard(const Work& work);
  /// What each process holds of this process's block of a round, if it gets one.
  std::vector<RowsPart> exchangeParts(std::span<const RowRange> blocks,
                                      const WhileWaiting& waiting);
  std::string reportProblems(const WhileWaiting& waiting);

  Processes& processes_;
  const ExchangeMatrix& own_;
  DealtBlocks dealt_;
  std::unique_ptr<BlockTaker> taker_;
  std::string problem_;
  CompressedRows rows_;
};

}  // namespace radiosity
