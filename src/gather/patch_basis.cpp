#include "gather/patch_basis.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

/// Gauss-Legendre on [0, 1], four points: abscissae and weights (Abramowitz & Stegun, table 25.4).
/// Parallelograms are exact; with a corner of 60 degrees, 1e-4 of the area goes to the wrong
/// corner.
constexpr std::array<double, 4> kAbscissa = {0.06943184420297371, 0.33000947820757187,
                                             0.66999052179242813, 0.93056815579702629};
constexpr std::array<double, 4> kWeight = {0.17392742256872692, 0.32607257743127308,
                                           0.32607257743127308, 0.17392742256872692};

double triangleArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

}  // namespace

PatchBasis::PatchBasis(const PatchMesh& mesh) : mesh_(mesh) {
  begin_.push_back(0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.area[i] > 0 && !addQuad(i)) addTriangles(i);
    begin_.push_back(facets_.size());
  }
}

/// Adds a convex quadrilateral as one facet. False, and nothing is added, for any other patch.
bool PatchBasis::addQuad(std::size_t patch) {
  const std::span<const Index> outline = mesh_.outline(patch);
  if (outline.size() != 4) return false;
  BasisFacet facet;
  facet.count = 4;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& corner = mesh_.vertices[outline[k]];
    const Vec3 in = corner - mesh_.vertices[outline[(k + 3) % 4]];
    const Vec3 out = mesh_.vertices[outline[(k + 1) % 4]] - corner;
    facet.vertex[k] = outline[k];
    facet.corner[k] = mesh_.corner_offset[patch] + k;
    facet.area[k] = 0.5 * glm::dot(glm::cross(in, out), mesh_.normal[patch]);
    if (!(facet.area[k] > 0)) return false;
  }
  facets_.push_back(facet);
  return true;
}

void PatchBasis::addTriangles(std::size_t patch) {
  const std::span<const Index> outline = mesh_.outline(patch);
  for (std::size_t t = mesh_.piece_offset[patch]; t < mesh_.piece_offset[patch + 1]; ++t) {
    BasisFacet facet;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = mesh_.pieces[t][k];
      const auto found = std::find(outline.begin(), outline.end(), v);
      facet.vertex[k] = v;
      facet.corner[k] = found == outline.end()
                            ? BasisFacet::kInside
                            : mesh_.corner_offset[patch] + std::size_t(found - outline.begin());
    }
    facets_.push_back(facet);
  }
}

/// Integrals of the facet's weights: a third of the area for each corner of a triangle. A
/// quadrilateral is mapped bilinearly from the unit square; the Jacobian is bilinear, too.
std::array<double, 4> PatchBasis::integrals(const BasisFacet& facet) const {
  std::array<Vec3, 4> p{};
  for (std::size_t k = 0; k < 4; ++k) p[k] = mesh_.vertices[facet.vertex[k]];
  std::array<double, 4> sum{};
  if (facet.count == 3) {
    sum.fill(triangleArea(p[0], p[1], p[2]) / 3);
    return sum;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const double u = kAbscissa[i];
      const double v = kAbscissa[j];
      const Vec3 along_u = (p[1] - p[0]) * (1 - v) + (p[2] - p[3]) * v;
      const Vec3 along_v = (p[3] - p[0]) * (1 - u) + (p[2] - p[1]) * u;
      const Vec3 point = (p[0] * (1 - u) + p[1] * u) * (1 - v) + (p[3] * (1 - u) + p[2] * u) * v;
      std::array<double, 4> edge{};
      for (std::size_t k = 0; k < 4; ++k) edge[k] = triangleArea(p[k], p[(k + 1) % 4], point);
      std::array<double, 4> weight{};
      double total = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        weight[k] = facet.area[k] * edge[(k + 1) % 4] * edge[(k + 2) % 4];
        total += weight[k];
      }
      const double area = glm::length(glm::cross(along_u, along_v)) * kWeight[i] * kWeight[j];
      for (std::size_t k = 0; k < 4; ++k) sum[k] += area * weight[k] / total;
    }
  }
  return sum;
}

std::vector<double> PatchBasis::areaWeights() const {
  std::vector<double> weights(mesh_.corners.size(), 0.0);
  for (std::size_t i = 0; i < mesh_.size(); ++i) {
    double inside = 0;  // shared equally by all corners
    for (const BasisFacet& facet : facets(i)) {
      const std::array<double, 4> part = integrals(facet);
      for (std::size_t k = 0; k < std::size_t(facet.count); ++k) {
        (facet.corner[k] == BasisFacet::kInside ? inside : weights[facet.corner[k]]) += part[k];
      }
    }
    const std::size_t first = mesh_.corner_offset[i];
    const std::size_t end = mesh_.corner_offset[i + 1];
    for (std::size_t c = first; c < end; ++c) weights[c] += inside / double(end - first);
  }
  return weights;
}

}  // namespace radiosity
