// A matrix whose rows lie in several processes. Each has a matrix of all unknowns with only its own
// rows; the other rows are empty. Process 0 also has one that stands for the whole; all processes
// compute its results together.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/processes.h"
#include "matrix/dealt_blocks.h"
#include "matrix/row_owners.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Process 0's side. All functions wait for the others; `waiting` is called meanwhile. It has no
/// sweep, which walks over all rows one after the other.
class SharedRows final : public ExchangeMatrix {
 public:
  /// All other processes must call serveRows(). `own`: the rows of this process, a RowMatrix or a
  /// SymmetricMatrix.
  SharedRows(Processes& processes, std::shared_ptr<const ExchangeMatrix> own, WhileWaiting waiting);
  /// Tells the others to drop their rows.
  ~SharedRows() override;

  int processes() const { return processes_.size(); }

  /// The same bits as in one process: partial sums pass from process to process in the order of the
  /// rows.
  std::vector<double> rowSums() const override;
  std::vector<Index> rowEntries() const override;
  void columns(std::size_t first, std::size_t last, std::span<double> values) const override;
  Rooms rooms() const override;
  std::size_t bytes() const override;  ///< of all rows together
  /// Gives each process its blocks of rows, whole, round by round. `make_taker`: as in serveRows().
  /// Steps `progress` by rows; calls its check() between rounds. Errors: RunError with the message
  /// of a taker.
  void deal(DealtBlocks blocks, const MakeTaker& make_taker, Progress& progress) const;
  /// `problem`: without the processes' own parts.
  KrylovOutcome solve(const KrylovProblem& problem, std::span<double> solution) const;

 private:
  /// Sums process by process, so the last bits depend on the number of processes.
  void multiply(std::span<const double> x, int bands, std::span<double> y,
                std::span<const std::uint8_t> wanted) const override;
  void readRows(std::size_t first, std::size_t last, std::span<const Index> entries,
                CompressedRows& rows) const override;
  /// A panel is no larger than the share of a process.
  std::size_t panelEntries() const override;

  Processes& processes_;
  std::shared_ptr<const ExchangeMatrix> own_;
  WhileWaiting waiting_;
  RowOwners owners_;
};

/// The matrix of all rows: `own` itself in one process, which null stands for.
std::shared_ptr<const ExchangeMatrix> wholeMatrix(Processes* processes,
                                                  std::shared_ptr<const ExchangeMatrix> own,
                                                  WhileWaiting waiting);

/// The loop of the other processes: serves process 0 until its matrix is destroyed. `make_taker`:
/// what takes the blocks of SharedRows::deal().
void serveRows(Processes& processes, const ExchangeMatrix& own, const MakeTaker& make_taker);

}  // namespace radiosity
