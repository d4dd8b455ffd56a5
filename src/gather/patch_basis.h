// How the value at a point of a patch is made from values at its corners.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A part of a patch with one rule. A convex quadrilateral has Wachspress' coordinates (Wachspress,
/// "A Rational Finite Element Basis", 1975): corner k weighs C_k A_(k+1) A_(k+2) with C_k the area
/// of the triangle of corner k and its neighbours, A_k that of edge k (from corner k to k + 1) and
/// the point. A triangle has barycentric ones: corner k weighs A_(k+1). Linear fields come out
/// exactly and neighbours agree along their common edge. Pictures interpolate likewise.
struct BasisFacet {
  int count = 3;                  ///< 3 or 4
  std::array<Index, 4> vertex{};  ///< of the mesh
  /// Into PatchMesh::corners; kInside: a vertex within the patch, where the mean of the patch's
  /// corners stands.
  std::array<std::size_t, 4> corner{};
  std::array<double, 4> area{};  ///< C_k; of a triangle, unused
  static constexpr std::size_t kInside = ~std::size_t(0);
};

class PatchBasis {
 public:
  /// `mesh` is kept by reference.
  explicit PatchBasis(const PatchMesh& mesh);

  /// None for a degenerate patch.
  std::span<const BasisFacet> facets(std::size_t patch) const {
    return {facets_.data() + begin_[patch], begin_[patch + 1] - begin_[patch]};
  }
  std::size_t facetBegin(std::size_t patch) const { return begin_[patch]; }
  std::size_t facetCount() const { return facets_.size(); }

  /// For every entry of mesh.corners the integral of its weight over the patch, m^2: a patch's sum
  /// to its area.
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
