#include "matrix/row_owners.h"

#include <algorithm>

#include "matrix/run_row.h"
#include "radiosity/symmetric_matrix.h"

namespace radiosity {

namespace {

/// Nothing is moved if no process has more than this above its share.
constexpr double kEven = 0.01;

}  // namespace

RowOwners findOwners(Processes& processes, const ExchangeMatrix& own, const WhileWaiting& waiting) {
  RowOwners owners;
  const auto* const triangle = dynamic_cast<const SymmetricMatrix*>(&own);
  if (triangle == nullptr) return owners;
  const std::size_t n = own.size();
  std::vector<double> work(2 * n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    work[k] = double(workOf(triangle->upperRuns(k)));
    if (work[k] > 0) work[n + k] = processes.rank() + 1;
  }
  processes.sum(work, waiting);
  processes.broadcastArray(work, waiting);
  owners.work.assign(work.begin(), work.begin() + std::ptrdiff_t(n));
  for (std::size_t k = 0; k < n; ++k) owners.owner.push_back(int(work[n + k]) - 1);
  return owners;
}

std::vector<RowMove> evenMoves(const RowOwners& owners, int processes) {
  std::vector<double> load(std::size_t(processes), 0.0);
  double share = 0;
  for (std::size_t k = 0; k < owners.work.size(); ++k) {
    if (owners.owner[k] == RowOwners::kNobody) continue;
    load[std::size_t(owners.owner[k])] += double(owners.work[k]);
    share += double(owners.work[k]) / processes;
  }
  std::vector<RowMove> moves;
  if (*std::max_element(load.begin(), load.end()) <= (1 + kEven) * share) return moves;
  for (int from = 0; from < processes; ++from) {
    int to = RowOwners::kNobody;  // of the last move, if this row may join it
    double& left = load[std::size_t(from)];
    for (std::size_t k = 0; k < owners.work.size() && left > share; ++k) {
      if (owners.owner[k] != from) continue;
      const auto work = double(owners.work[k]);
      if (to == RowOwners::kNobody || load[std::size_t(to)] + work > share) {
        const auto least = std::min_element(load.begin(), load.end());
        to = int(least - load.begin());
        moves.push_back({k, k, from, to});
      }
      if (left - work < share || load[std::size_t(to)] + work > share) {
        to = RowOwners::kNobody;
        continue;
      }
      moves.back().last = k + 1;
      load[std::size_t(to)] += work;
      left -= work;
    }
  }
  std::erase_if(moves, [](const RowMove& move) { return move.first == move.last; });
  return moves;
}

}  // namespace radiosity
