// Makes form factors between groups of surfaces from those between patches.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "mesh/clusters/cluster_patches.h"
#include "radiosity/matrix_functions.h"
#include "radiosity/tables.h"

namespace radiosity {

namespace {

/// The means by area, for each row, of a value of its patches.
std::vector<double> meansOfRows(std::span<const double> values, std::span<const double> area,
                                const NamedFactors& rows) {
  std::vector<double> means(rows.size(), 0.0);
  if (values.empty()) return {};
  for (std::size_t i = 0; i < values.size(); ++i) means[rows.row_of[i]] += area[i] * values[i];
  for (std::size_t a = 0; a < means.size(); ++a) {
    const double total = rows.matrix->area()[a];
    means[a] = total > 0 ? means[a] / total : 0.0;
  }
  return means;
}

/// Sums of rows and columns over those that `row_of` gives each patch.
NamedFactors summedTo(std::vector<std::string> names, std::vector<Index> row_of,
                      const FormFactors& factors, Progress& progress) {
  NamedFactors result;
  result.names = std::move(names);
  result.row_of = std::move(row_of);
  result.members.assign(result.size(), 0);
  for (const Index row : result.row_of) ++result.members[row];
  result.matrix = aggregated(*factors.matrix, result.row_of, result.size(), progress,
                             Precision::double_precision);
  const std::span<const double> area = factors.matrix->area();
  result.sky = meansOfRows(factors.sky, area, result);
  result.backs = meansOfRows(factors.backs, area, result);
  result.error = meansOfRows(factors.error, area, result);
  result.closed = factors.report.closed;
  return result;
}

std::vector<std::string> nodeNames(const PatchMesh& mesh, const PatchClusters& nodes) {
  const auto sideOf = [&](std::size_t node) {
    const Index first = nodes.patchesOf(node)[0];
    return 2 * std::size_t(mesh.surface[first]) + mesh.side[first];
  };
  std::vector<std::size_t> of_side(2 * mesh.surface_names.size(), 0);
  for (std::size_t node = 0; node < nodes.size(); ++node) ++of_side[sideOf(node)];
  std::vector<std::size_t> named(of_side.size(), 0);
  std::vector<std::string> names;
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const std::size_t side = sideOf(node);
    std::string name = mesh.surface_names[side / 2];
    if (of_side[side] > 1) name += fmt::format(" {}", ++named[side]);
    names.push_back(side % 2 == 0 ? name : name + " back");
  }
  return names;
}

}  // namespace

double NamedFactors::entryError(std::size_t a, std::size_t b) const {
  if (error.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double forward = std::sqrt(double(members[b])) * error[a];
  const double area = matrix->area()[a];
  if (!matrix->isSymmetric() || !(area > 0)) return forward;
  const double backward = std::sqrt(double(members[a])) * error[b] * matrix->area()[b] / area;
  return std::min(forward, backward);
}

double NamedFactors::reciprocityResidual(std::size_t a, std::size_t b) const {
  if (matrix->isSymmetric() || a == b) return 0;
  const std::span<const double> area = matrix->area();
  return std::abs(area[a] * matrix->at(a, b) - area[b] * matrix->at(b, a));
}

NamedFactors factorsBetween(const PatchMesh& mesh, const FormFactors& factors,
                            const SurfaceGroups& groups, Progress& progress) {
  if (groups.of_surface.size() != mesh.surface_names.size()) {
    throw InputError(fmt::format("groups of {} surfaces are given for a mesh of {}",
                                 groups.of_surface.size(), mesh.surface_names.size()));
  }
  std::vector<Index> row_of = mesh.surface;
  for (Index& row : row_of) row = groups.of_surface[row];
  return summedTo(groups.names, std::move(row_of), factors, progress);
}

NamedFactors factorsBetweenNodes(const PatchMesh& mesh, const FormFactors& factors,
                                 std::size_t count, Progress& progress) {
  const PatchClusters nodes = clusterPatches(mesh, count, progress);
  return summedTo(nodeNames(mesh, nodes), nodes.of_patch, factors, progress);
}

NamedFactors factorsOfPatches(const PatchMesh& mesh, const FormFactors& factors) {
  NamedFactors result;
  result.numbered = true;
  result.names.reserve(mesh.size());
  for (const Index surface : mesh.surface) result.names.push_back(mesh.surface_names[surface]);
  result.matrix = {factors.matrix, &pairsOf(*factors.matrix)};
  result.sky = factors.sky;
  result.backs = factors.backs;
  result.error = factors.error;
  result.members.assign(result.size(), 1);
  result.row_of.resize(result.size());
  std::iota(result.row_of.begin(), result.row_of.end(), Index(0));
  result.closed = factors.report.closed;
  return result;
}

std::vector<double> emissivities(const NamedFactors& factors, const PatchMesh& mesh,
                                 const PatchMaterials& materials) {
  materials.requireSizes(mesh.size());
  const auto bands = std::size_t(materials.bands);
  std::vector<double> absorbed(factors.size(), 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double reflected = 0;
    for (std::size_t b = 0; b < bands; ++b) reflected += materials.reflectance[i * bands + b];
    const double share = 1 - reflected / double(bands);
    absorbed[factors.row_of[i]] += mesh.area[i] * share;
  }
  for (std::size_t a = 0; a < absorbed.size(); ++a) {
    const double area = factors.matrix->area()[a];
    absorbed[a] = area > 0 ? absorbed[a] / area : 0.0;
  }
  return absorbed;
}

}  // namespace radiosity
