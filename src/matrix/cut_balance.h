// Makes rows that are cut conserve power.
#pragma once

#include <span>

#include "matrix/cut_operator.h"

namespace radiosity {

/// How far the power that rows bring from each patch is from what leaves it.
struct CutBalance {
  double before = 0;  ///< the sum of all differences over all power
  double after = 0;
};

/// Rows count their own hits, so that what they bring from a patch in all, sum_i A_i F_ij, is not
/// quite what leaves it for fronts, A_j sum_i F_ji, as reciprocity has it: light would come from
/// nothing, or be lost. Scales what light each patch counts for (PatchTree::Patch::counts) and what
/// a hit of each row counts, in turn, until both are right (Sinkhorn & Knopp 1967); rows sum to
/// what they did, to rounding. `sums`: by place in the tree, of the rows, without what is known
/// pair by pair. A patch that hardly any row has hit keeps what is off. Throws Cancelled.
CutBalance balanceCut(CutParts& parts, std::span<const double> sums, Progress& progress);

}  // namespace radiosity
