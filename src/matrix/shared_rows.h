// A matrix whose rows lie in several processes. Each has an ExchangeMatrix of all unknowns with
// only its own rows; the other rows are empty. Process 0 also has a matrix that stands for the
// whole one (ExchangeMatrix::shared()); all processes compute its results together.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/processes.h"
#include "matrix/dealt_blocks.h"
#include "matrix/row_owners.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Process 0's side. All functions wait for the others; `waiting` is called meanwhile.
class SharedRows {
 public:
  /// All other processes must call serveRows(). `own`: the rows of this process.
  SharedRows(Processes& processes, ExchangeMatrix own, WhileWaiting waiting);
  /// Tells the others to drop their rows.
  ~SharedRows();
  SharedRows(const SharedRows&) = delete;
  SharedRows& operator=(const SharedRows&) = delete;

  const ExchangeMatrix& own() const { return own_; }
  int processes() const { return processes_.size(); }

  /// Like ExchangeMatrix::product(). It sums process by process, so the last bits depend on the
  /// number of processes.
  void product(std::span<const double> x, int bands, std::span<double> y,
               std::span<const std::uint8_t> wanted) const;
  /// The row sums, with the same bits as in one process: partial sums pass from process to process
  /// in the order of the rows.
  std::vector<double> rowSums() const;
  /// The numbers of entries other than 0.
  std::vector<Index> rowEntries() const;
  /// Sizes of all rows together.
  struct Sizes {
    std::size_t bytes = 0;
    std::size_t dense_rows = 0;
  };
  Sizes sizes() const;
  /// Rows first to last - 1, compressed and sorted.
  void panel(std::size_t first, std::size_t last, std::vector<std::size_t>& starts,
             std::vector<Index>& columns, std::vector<double>& values) const;
  /// Gives each process its blocks of rows, whole, round by round. `make_taker`: as in serveRows().
  /// Steps `progress` by rows; calls its check() between rounds. Errors: RunError with the message
  /// of a taker.
  void deal(DealtBlocks blocks, const MakeTaker& make_taker, Progress& progress) const;
  /// Row form: sets dense[(j - first) * N + i] = F_ij for columns j from first to last - 1. `dense`
  /// must hold (last - first) * N zeros.
  void columns(std::size_t first, std::size_t last, std::span<double> dense) const;
  /// Symmetric form, by position: the first position of its connected component.
  std::vector<Index> joined() const;
  /// `problem`: without the processes' own parts.
  KrylovOutcome solve(const KrylovProblem& problem, std::span<double> solution) const;

 private:
  Processes& processes_;
  ExchangeMatrix own_;
  WhileWaiting waiting_;
  RowOwners owners_;
};

/// The loop of the other processes: serves process 0 until its matrix is destroyed. `make_taker`:
/// what takes the blocks of SharedRows::deal().
void serveRows(Processes& processes, const ExchangeMatrix& own, const MakeTaker& make_taker);

}  // namespace radiosity
