// What a page's form factors are between: patches, or, where these are many, nodes of patches.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::page {

struct PageNodes {
  std::vector<Index> of_patch;                   ///< N: the node of each patch
  std::shared_ptr<const ExchangeMatrix> matrix;  ///< K x K, symmetric
  std::vector<double> fronts;                    ///< K, as FormFactors::fronts
  std::vector<double> error;                     ///< K, as FormFactors::error, or empty

  std::size_t size() const { return matrix->size(); }
  bool arePatches() const { return size() == of_patch.size(); }
};

/// Patches themselves if there are form factors between all pairs of these and no more than
/// kMostPageNodes; else about kNodesOfMany clusters of patches, over which form factors are summed:
/// between these reciprocity holds, and rows keep their sums (closeRows()). Errors: InputError that
/// starts with `name` if pairs of patches have two estimates; Cancelled.
PageNodes pageNodes(const std::string& name, const PatchMesh& mesh, const FormFactors& factors,
                    Progress& progress);

}  // namespace radiosity::page
