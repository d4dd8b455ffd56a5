#include "gather/interpolated_view.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

/// Adds weight * (corner weights at each pixel of [begin, end)) to `sum`. A pixel whose centre
/// lies outside by rounding is moved onto the outline.
template <int kCorners, class Edges>
void sumWeights(const Edges& edges, const std::array<double, 4>& area, const double* weights,
                double first_centre, int begin, int end, std::array<double, 4>& sum) {
  for (int x = begin; x < end; ++x) {
    const double centre = x + first_centre;
    std::array<double, kCorners> a;
    for (std::size_t k = 0; k < kCorners; ++k) {
      a[k] = std::max(edges.slope[k] * centre + edges.base[k], 0.0);
    }
    std::array<double, kCorners> w;
    double total = 0;
    for (std::size_t k = 0; k < kCorners; ++k) {
      w[k] = a[(k + 1) % kCorners];
      if constexpr (kCorners == 4) w[k] *= area[k] * a[(k + 2) % kCorners];
      total += w[k];
    }
    if (!(total > 0)) continue;  // seen as a point: corner 0's value stands
    const double share = (weights[x + 1] - weights[x]) / total;
    for (std::size_t k = 1; k < kCorners; ++k) sum[k] += share * w[k];
  }
}

}  // namespace

InterpolatedView::InterpolatedView(const PatchMesh& mesh, const PatchBasis& basis, double scale,
                                   int resolution, const std::vector<Index>& eye_of_corner,
                                   const std::vector<float>& radiosity)
    : mesh_(mesh),
      basis_(basis),
      scale_(scale),
      pixel_(2.0 / resolution),
      eye_of_corner_(eye_of_corner),
      radiosity_(radiosity),
      prepared_(mesh.size(), 0),
      constant_(mesh.size(), 0),
      facets_(basis.facetCount()) {}

void InterpolatedView::begin(const EyeFrame& frame) {
  frame_ = frame;
  irradiance_ = {};
  ++view_;
}

std::array<double, 3> InterpolatedView::cornerMean(std::size_t patch) const {
  const std::size_t first = mesh_.corner_offset[patch];
  const std::size_t end = mesh_.corner_offset[patch + 1];
  const std::array<double, 3> base = valueAt(patch, first);
  std::array<double, 3> mean = base;
  for (std::size_t c = first; c < end; ++c) {
    const std::array<double, 3> value = valueAt(patch, c);
    for (std::size_t b = 0; b < 3; ++b) mean[b] += (value[b] - base[b]) / double(end - first);
  }
  return mean;
}

std::array<double, 3> InterpolatedView::valueAt(std::size_t patch, std::size_t corner) const {
  if (corner == Facet::kInside) return cornerMean(patch);
  const float* value = &radiosity_[3 * std::size_t(eye_of_corner_[corner])];
  return {value[0], value[1], value[2]};
}

void InterpolatedView::prepare(std::size_t patch) {
  prepared_[patch] = view_;
  bool constant = true;
  std::size_t number = basis_.facetBegin(patch);
  for (const Facet& facet : basis_.facets(patch)) {
    SeenFacet& seen = facets_[number++];
    seen.count = facet.count;
    seen.area = facet.area;
    const auto count = std::size_t(facet.count);
    std::array<Vec3, 4> corner{};
    for (std::size_t k = 0; k < count; ++k) {
      corner[k] = frame_.toEye(mesh_.vertices[facet.vertex[k]] * scale_);
      seen.value[k] = valueAt(patch, facet.corner[k]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      // det(b, a, r), from the edge itself: b x a = (b - a) x a. Of a front it is positive inside.
      const Vec3& next = corner[(k + 1) % count];
      seen.edge[k] = glm::cross(next - corner[k], corner[k]);
    }
    for (std::size_t k = 1; k < count; ++k) {
      for (std::size_t b = 0; b < 3; ++b) {
        seen.value[k][b] -= seen.value[0][b];
        constant = constant && seen.value[k][b] == 0;
      }
    }
  }
  const std::span<const Facet> all = basis_.facets(patch);
  const std::size_t first = basis_.facetBegin(patch);
  for (std::size_t f = 1; f < all.size(); ++f) {
    constant = constant && facets_[first + f].value[0] == facets_[first].value[0];
  }
  constant_[patch] = constant;
}

InterpolatedView::RowEdges InterpolatedView::alongRow(const SeenFacet& facet,
                                                      const ItemRun& run) const {
  RowEdges edges;
  for (std::size_t k = 0; k < std::size_t(facet.count); ++k) {
    const FacePoint p = run.face.project(facet.edge[k]);
    edges.slope[k] = p.x * pixel_;
    edges.base[k] = p.y * pixel_ * run.height + p.w;
  }
  return edges;
}

void InterpolatedView::visit(const ItemRun& run) {
  if (run.begin >= run.end || run.item >= mesh_.size()) return;  // bare backs are black
  const std::size_t patch = run.item;
  if (prepared_[patch] != view_) prepare(patch);
  const SeenFacet& first = facets_[basis_.facetBegin(patch)];
  if (constant_[patch] != 0) {
    const double weight = run.weights[run.end] - run.weights[run.begin];
    for (std::size_t b = 0; b < 3; ++b) irradiance_[b] += weight * first.value[0][b];
  } else if (basis_.facets(patch).size() == 1) {
    addRun(first, run, run.begin, run.end);
  } else {
    addManyFacets(patch, run);
  }
}

void InterpolatedView::addRun(const SeenFacet& facet, const ItemRun& run, int begin, int end) {
  const RowEdges edges = alongRow(facet, run);
  std::array<double, 4> share{};
  if (facet.count == 4) {
    sumWeights<4>(edges, facet.area, run.weights, run.first_centre, begin, end, share);
  } else {
    sumWeights<3>(edges, facet.area, run.weights, run.first_centre, begin, end, share);
  }
  // Differences to corner 0: a constant field stays that constant.
  const double weight = run.weights[end] - run.weights[begin];
  for (std::size_t b = 0; b < 3; ++b) {
    double sum = weight * facet.value[0][b];
    for (std::size_t k = 1; k < 4; ++k) sum += share[k] * facet.value[k][b];
    irradiance_[b] += sum;
  }
}

/// Each pixel belongs to the facet it lies deepest in: edges' values measured against their sum.
void InterpolatedView::addManyFacets(std::size_t patch, const ItemRun& run) {
  const std::size_t begin = basis_.facetBegin(patch);
  const std::size_t count = basis_.facets(patch).size();
  for (int x = run.begin; x < run.end; ++x) {
    const double centre = x + run.first_centre;
    std::size_t best = begin;
    double deepest = -HUGE_VAL;
    for (std::size_t f = begin; f < begin + count; ++f) {
      const RowEdges edges = alongRow(facets_[f], run);
      double least = HUGE_VAL;
      double total = 0;
      for (std::size_t k = 0; k < std::size_t(facets_[f].count); ++k) {
        const double a = edges.slope[k] * centre + edges.base[k];
        least = std::min(least, a);
        total += a;
      }
      const double depth = total > 0 ? least / total : -HUGE_VAL;
      if (depth > deepest) {
        deepest = depth;
        best = f;
      }
    }
    addRun(facets_[best], run, x, x + 1);
  }
}

}  // namespace radiosity
