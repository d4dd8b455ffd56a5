// From classified pairs of elements to stored rows.
#pragma once

#include <span>
#include <vector>

#include "formfactor/exact/elements.h"
#include "formfactor/exact/error_figure.h"
#include "formfactor/exact/partial.h"
#include "formfactor/exact/recorded_pairs.h"
#include "formfactor/exact/unoccluded.h"
#include "formfactor/exact/visibility.h"
#include "formfactor/row_accounts.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Where each patch stands: by its first element. Patches without elements come last.
struct PatchOrder {
  PatchOrder(const PatchMesh& mesh, const ElementSet& elements);
  std::vector<Index> patch;          ///< N: the patches in order
  std::vector<Index> rank;           ///< patch_elements: position of an element's patch
  std::vector<Index> first_element;  ///< ranked + 1: elements of the patch at a position
  std::size_t ranked = 0;            ///< patches that have elements
  std::vector<double> area;          ///< ranked: in ElementSet's units
};

/// Sums over the pairs of some rows.
struct RowSums {
  explicit RowSums(std::size_t rows) : error(rows) {}
  RowSums& operator+=(const RowSums& other);

  ErrorSums error;
  VisibilityCounts visibility;
  UnoccludedCounts unoccluded;
  PartialCounts partial;
  double seconds_visibility = 0;
  double seconds_unoccluded = 0;
  double seconds_partial = 0;
  double seconds_assembly = 0;
};

/// What all rows share and where they go.
struct RowContext {
  const ElementSet& elements;
  const PatchOrder& order;
  const Visibility& visibility;
  const UnoccludedKernel& unoccluded;
  const PartialKernel& partial;
  std::size_t recheck_every;  ///< about one clipped pair in so many is evaluated from both ends
  ExchangeMatrix& matrix;
  std::vector<double>& backs;
  std::vector<std::vector<SeenBack>>& seen_backs;
};

/// Makes rows, one task after the other. Holds scratch memory: one a thread.
///
/// All pairs of a task are classified first, then those past occluders are evaluated as one batch,
/// then rows are filled a few at a time: as many as stay in the second-level cache, dense, one
/// place for every later element, whatever wrote into it.
class RowAssembly {
 public:
  explicit RowAssembly(const RowContext& context) : context_(context) {}
  /// `ranges`: one task of RowTasks. Stores its patches' rows and backs, adds to `sums`.
  void run(std::span<const ElementRange> ranges, RowSums& sums);

  /// Bytes one thread holds beside the clipped pairs of a task.
  static std::size_t scratchBytes(const ElementSet& elements);

 private:
  void sortPartialByRow(ElementRange rows);
  void evaluateUnoccluded(RowSums& sums);
  void evaluatePartial(RowSums& sums);
  void recheck(RowSums& sums) const;
  /// Rows of whole patches, from `first_rank`; returns the rank after them.
  std::size_t fillTile(std::size_t first_rank, std::size_t end_rank, RowSums& sums);
  void fillBlocks(ElementRange rows, RowSums& sums);
  void scatterPartial(ElementRange rows, RowSums& sums);
  void storePatch(std::size_t rank, ElementRange rows, Index first_row, RowSums& sums);
  void storeBacks(std::size_t rank, std::span<const double> bare);
  double* tileRow(Index row, Index first_row) {
    return tile_.data() + std::size_t(row - first_row) * width_;
  }

  const RowContext& context_;
  RecordedPairs pairs_;
  std::vector<PartialExchange> partial_;
  std::vector<PartialPair> sorted_;
  std::vector<double> unoccluded_;
  std::vector<std::size_t> row_end_;  ///< of the task's rows, into pairs_.partial_pairs
  Index task_first_ = 0;
  std::vector<double> tile_;    ///< rows x width_: exchange with elements from tile_first_ on
  std::vector<double> folded_;  ///< exchange with patches, where patches have several elements
  std::size_t width_ = 0;
  Index tile_first_ = 0;
};

}  // namespace radiosity
