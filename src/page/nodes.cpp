#include "page/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "matrix/estimated_entries.h"
#include "radiosity/matrix_functions.h"
#include "radiosity/page.h"
#include "radiosity/spelling.h"
#include "radiosity/tables.h"

namespace radiosity::page {

namespace {

void requireOneEstimate(const std::string& name, const ExchangeMatrix& matrix) {
  if (matrix.isSymmetric()) return;
  throw InputError(
      fmt::format("{}: a page keeps one form factor a pair, and these are two estimates of each; "
                  "compute them with {}, or with {} or rays",
                  name, spelled("symmetrize"), spelled("method", "exact")));
}

/// Means by area over the patches of each node.
std::vector<double> meansOf(std::span<const double> values, std::span<const double> area,
                            const PageNodes& nodes) {
  std::vector<double> means(nodes.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) means[nodes.of_patch[i]] += area[i] * values[i];
  for (std::size_t k = 0; k < means.size(); ++k) {
    const double whole = nodes.matrix->area()[k];
    means[k] = whole > 0 ? means[k] / whole : 0.0;
  }
  return means;
}

}  // namespace

PageNodes pageNodes(const std::string& name, const PatchMesh& mesh, const FormFactors& factors,
                    Progress& progress) {
  PageNodes nodes;
  const bool has_pairs = traitsOf(factors.method).stores_pairs;
  if (has_pairs) requireOneEstimate(name, pairsOf(*factors.matrix));
  if (has_pairs && mesh.size() <= kMostPageNodes) {
    nodes.of_patch.resize(mesh.size());
    std::iota(nodes.of_patch.begin(), nodes.of_patch.end(), Index(0));
    nodes.matrix = {factors.matrix, &pairsOf(*factors.matrix)};
    nodes.fronts = factors.fronts;
    nodes.error = factors.error;
    return nodes;
  }
  NamedFactors sums = factorsBetweenNodes(mesh, factors, kNodesOfMany, progress);
  nodes.of_patch = std::move(sums.row_of);
  nodes.matrix = sums.matrix;
  nodes.fronts = meansOf(factors.fronts, factors.matrix->area(), nodes);
  if (const auto* rows = dynamic_cast<const RowMatrix*>(sums.matrix.get())) {
    const auto merged = std::make_shared<SymmetricMatrix>(symmetrized(*rows));
    closeRows(*merged, estimatedEntries(*merged), nodes.fronts, progress);
    nodes.matrix = merged;
  }
  nodes.error = std::move(sums.error);
  return nodes;
}

}  // namespace radiosity::page
