// Which process holds which rows of a shared matrix, and how to make their shares even.
#pragma once

#include <cstddef>
#include <vector>

#include "base/processes.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Of a symmetric matrix, by position: the work of a walk along each row and the process that has
/// it. Else empty.
struct RowOwners {
  static constexpr int kNobody = -1;
  std::vector<std::size_t> work;
  std::vector<int> owner;  ///< kNobody if nothing is stored after the diagonal
};

/// Called by all processes. `own`: the rows of this one.
RowOwners findOwners(Processes& processes, const ExchangeMatrix& own, const WhileWaiting& waiting);

/// The rows of `from` among rows first to last - 1 are to go to process `to`.
struct RowMove {
  std::size_t first;
  std::size_t last;
  int from;
  int to;
};

/// Moves after which a process has more than its share of the work by no more than rows that would
/// give their receiver more than its own, or leave it less. They take long stretches, since rows
/// that lie together are walked along together. Empty if no process has more than 1% above its
/// share.
std::vector<RowMove> evenMoves(const RowOwners& owners, int processes);

}  // namespace radiosity
