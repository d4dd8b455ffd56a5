// The interpolation of a value at a point of a patch from values at its corners.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A part of a patch with one interpolation rule. A convex quadrilateral has Wachspress'
/// coordinates (Wachspress, "A Rational Finite Element Basis", 1975): the weight of corner k is C_k
/// A_(k+1) A_(k+2). C_k is the area of the triangle of corner k and its neighbours, A_k that of the
/// triangle of edge k (from corner k to k + 1) and the point. A triangle has barycentric
/// coordinates: the weight of corner k is A_(k+1). Linear fields are reproduced exactly, and
/// neighbours agree along their common edge. Pictures interpolate in the same way.
struct BasisFacet {
  int count = 3;                  ///< 3 or 4
  std::array<Index, 4> vertex{};  ///< of the mesh
  /// Into PatchMesh::corners; kInside: a vertex within the patch, which has the mean of the patch's
  /// corners.
  std::array<std::size_t, 4> corner{};
  std::array<double, 4> area{};  ///< C_k; of a triangle, unused
  static constexpr std::size_t kInside = ~std::size_t(0);
};

class PatchBasis {
 public:
  /// Keeps `mesh` by reference.
  explicit PatchBasis(const PatchMesh& mesh);

  /// The facets of a patch; none if it is degenerate.
  std::span<const BasisFacet> facets(std::size_t patch) const {
    return {facets_.data() + begin_[patch], begin_[patch + 1] - begin_[patch]};
  }
  std::size_t facetBegin(std::size_t patch) const { return begin_[patch]; }
  std::size_t facetCount() const { return facets_.size(); }

  /// For every entry of mesh.corners, the integral of its weight over the patch, m^2. Those of a
  /// patch sum to its area.
  std::vector<double> areaWeights() const;

  std::size_t bytes() const {
    return facets_.size() * sizeof(BasisFacet) + begin_.size() * sizeof(std::size_t);
  }

 private:
  bool addQuad(std::size_t patch);
  void addTriangles(std::size_t patch);
  std::array<double, 4> integrals(const BasisFacet& facet) const;

  const PatchMesh& mesh_;
  std::vector<std::size_t> begin_;
  std::vector<BasisFacet> facets_;
};

}  // namespace radiosity
