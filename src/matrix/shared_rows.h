// A matrix whose rows lie in several processes. Each holds an ExchangeMatrix of all unknowns with
// rows of its own; all others are empty there. Process 0 has, besides, a matrix that stands for the
// whole one (ExchangeMatrix::shared()): what it is asked for, all processes do together.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/processes.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Of the symmetric form: how much there is to do in row k, and the process that has it.
struct RowOwners {
  static constexpr int kNobody = -1;
  std::vector<std::size_t> work;
  std::vector<int> owner;  ///< kNobody where nothing is stored after the diagonal
};

/// Process 0's side. All functions wait for the others; `waiting` is called meanwhile.
class SharedRows {
 public:
  /// While all others call serveRows(). `own`: this process's rows.
  SharedRows(Processes& processes, ExchangeMatrix own, WhileWaiting waiting);
  /// The others forget their rows.
  ~SharedRows();
  SharedRows(const SharedRows&) = delete;
  SharedRows& operator=(const SharedRows&) = delete;

  const ExchangeMatrix& own() const { return own_; }
  int processes() const { return processes_.size(); }

  /// As ExchangeMatrix::product(). Sums are made process by process: their last bits depend on how
  /// many there are.
  void product(std::span<const double> x, int bands, std::span<double> y,
               std::span<const std::uint8_t> wanted) const;
  /// To the bit those of one process: the partial sums pass from process to process in the order
  /// of the rows.
  std::vector<double> rowSums() const;
  /// Of all rows together.
  struct Sizes {
    std::vector<Index> row_entries;
    std::size_t bytes = 0;
    std::size_t dense_rows = 0;
  };
  Sizes sizes() const;
  /// Rows first to last - 1, compressed and sorted.
  void panel(std::size_t first, std::size_t last, std::vector<std::size_t>& starts,
             std::vector<Index>& columns, std::vector<double>& values) const;
  /// Row form: dense[(j - first) * N + i] = F_ij for columns j from first to last - 1. `dense`:
  /// (last
  /// - first) * N zeros.
  void columns(std::size_t first, std::size_t last, std::span<double> dense) const;
  /// Symmetric form, by position: the first of those that it is joined to by exchange.
  std::vector<Index> joined() const;
  /// `problem`: without what the processes hold.
  KrylovOutcome solve(const KrylovProblem& problem, std::span<double> solution) const;

 private:
  Processes& processes_;
  ExchangeMatrix own_;
  WhileWaiting waiting_;
  RowOwners owners_;
};

/// The side of the others: does what process 0 asks for, until its matrix is gone.
void serveRows(Processes& processes, const ExchangeMatrix& own);

}  // namespace radiosity
