// Rows of the form-factor matrix that are known to be right, and how far others are from them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radiosity/exchange_matrix.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::bench {

struct TruthRows {
  std::vector<Index> index;              ///< patches, ascending
  std::vector<std::vector<double>> row;  ///< N values each
  bool complete = false;                 ///< every patch with area is there
};

/// All rows of a mesh of up to 1,000 patches; of a larger one 100 of its patches with area, drawn
/// at random from a fixed seed. They cost up to seconds each and are kept in `folder`, by the
/// mesh's identity, the accuracy and the identity of the estimator's code, for the next run.
/// `accuracy`: error of each value aimed at, in mean form factors 1/N.
TruthRows truthRows(const PatchMesh& mesh, double accuracy, const std::string& folder);

/// How far a matrix is from the truth, over the rows that are known.
struct MatrixError {
  double relative_l2 = 0;   ///< sqrt(sum A_i (F - F')^2 / sum A_i F'^2)
  double largest = 0;       ///< max |F - F'|
  std::vector<double> row;  ///< sqrt(sum_j (F_ij - F'_ij)^2), as TruthRows::index
};
MatrixError matrixError(const ExchangeMatrix& matrix, const TruthRows& truth);

}  // namespace radiosity::bench
