// From classified pairs of elements to stored rows.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/exact/assembly/error_figure.h"
#include "formfactor/exact/assembly/recorded_pairs.h"
#include "formfactor/exact/assembly/row_tasks.h"
#include "formfactor/exact/occluded/occluded_pairs.h"
#include "formfactor/exact/unoccluded/unoccluded.h"
#include "formfactor/exact/visibility/visibility.h"
#include "formfactor/row_accounts.h"
#include "radiosity/closure.h"
#include "radiosity/symmetric_matrix.h"
#include "visibility/elements/elements.h"

namespace radiosity {

/// The order of patches: by their first elements. Patches without elements come last.
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
  OccludedCounts occluded;
  double seconds_visibility = 0;
  double seconds_unoccluded = 0;
  double seconds_occluded = 0;
  double seconds_assembly = 0;
};

/// Patches that emit. What others get from them is to be good to some percent itself, and not just
/// beside the whole row of the emitter.
struct Emitters {
  Emitters(const PatchMesh& mesh, const PatchOrder& order, std::span<const Index> patches);
  std::vector<std::uint8_t> emits;  ///< N
  double scene_area;                ///< of all patches, in ElementSet's units
};

/// One in how many of these occluded pairs is evaluated again.
std::size_t recheckEvery(double occluded_pairs, double tolerance);

/// Inputs that all rows share, and the places that rows are stored in.
struct RowContext {
  const ElementSet& elements;
  const PatchOrder& order;
  const ColumnChunks& chunks;
  const Visibility& visibility;
  const UnoccludedKernel& unoccluded;
  const OccludedKernel& occluded;
  const Progress& progress;
  std::size_t recheck_every;  ///< recheckEvery()
  const Emitters* emitters;   ///< may be null
  SymmetricMatrix& matrix;
  UncertainEntries* uncertain;  ///< takes occluded pairs and their errors; may be null
  std::vector<double>& backs;
  std::vector<std::vector<SeenBack>>& seen_backs;
};

/// Makes rows, one task after the other. Holds scratch memory: one a thread.
///
/// A task's rows are dense while they are made: a place for every later element, and a mark where
/// there is an exchange. Closed forms are asked for in whole runs of columns, marked or not: around
/// a shadow the pairs that need them lie so scattered that picking them out costs more. Pairs past
/// occluders get their unoccluded value from there, are evaluated as one batch, and put back.
class RowAssembly {
 public:
  explicit RowAssembly(const RowContext& context)
      : context_(context), pairs_(&context.progress), asked_(context.chunks.ranges.size(), 0) {}
  /// `ranges`: one task of RowTasks. Stores its patches' rows and backs, adds to `sums`. Throws
  /// Cancelled.
  void run(std::span<const ElementRange> ranges, RowSums& sums);

 private:
  static constexpr std::size_t kMarks = 8;  ///< looked at together
  /// An occluded pair of a row.
  struct Uncertain {
    Index column;  ///< rank
    double error;  ///< of F
    auto operator<=>(const Uncertain&) const = default;
  };
  void classify(std::span<const ElementRange> ranges, RowSums& sums);
  /// Evaluates closed forms of rows `range`: of the blocks and pairs from the given ones on.
  void evaluateUnoccluded(ElementRange range, std::size_t first_block, std::size_t first_pair,
                          RowSums& sums);
  void dropPairsWithoutExchange(std::size_t first_pair, RowSums& sums);
  void evaluateOccluded(RowSums& sums);
  /// Evaluates pairs of emitters and receivers strictly if what the receivers get is too uncertain.
  void replaceUncertain();
  std::vector<std::size_t> uncertainPairs() const;
  /// The patch that gets light by a pair; kNone if neither end emits.
  Index receiverOf(const OccludedPair& pair) const;
  void recheck(RowSums& sums);
  std::vector<OccludedExchange> strictly(std::span<const std::size_t> which) const;
  void storeUncertain(ElementRange rows);
  void storeUncertainRow(std::size_t rank, std::span<Uncertain> entries);
  void storePatches(ElementRange rows, RowSums& sums);
  void clearUnmarked();
  /// A patch's exchange with itself and all later ones, and with black backs.
  std::span<double> patchRow(std::size_t rank, ElementRange rows);
  void storeBacks(std::size_t rank, std::span<const double> black);
  std::size_t place(Index row, Index column) const {
    return std::size_t(row - first_) * width_ + (column - first_);
  }

  const RowContext& context_;
  RecordedPairs pairs_;
  std::vector<OccludedExchange> occluded_;
  std::vector<Uncertain> uncertain_;    ///< by row
  std::vector<std::size_t> row_begin_;  ///< into uncertain_, by rank from the task's first on
  std::vector<Index> later_;            ///< of one row
  std::vector<double> errors_;
  Index first_ = 0;                   ///< element of the task
  std::size_t width_ = 0;             ///< elements from first_ on
  std::vector<double> panel_;         ///< rows x width_, and up to a multiple of kMarks
  std::vector<std::uint8_t> marked_;  ///< the same places: 0 where panel_ means nothing
  std::vector<std::uint8_t> asked_;   ///< by chunk of columns
  std::vector<double> folded_;        ///< a row by patch, where patches have several elements
};

}  // namespace radiosity
