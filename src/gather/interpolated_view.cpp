#include "gather/interpolated_view.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

/// In a fixed order.
double total(const std::array<double, kLanes>& lanes) {
  double sum = 0;
  for (const double lane : lanes) sum += lane;
  return sum;
}

}  // namespace

InterpolatedView::InterpolatedView(const PatchMesh& mesh, const PatchBasis& basis, double scale,
                                   int resolution, bool simd,
                                   const std::vector<Index>& eye_of_corner,
                                   const std::vector<float>& radiosity)
    : mesh_(mesh),
      basis_(basis),
      kernels_(interpolationKernels(simd)),
      scale_(scale),
      resolution_(resolution),
      eye_of_corner_(eye_of_corner),
      radiosity_(radiosity),
      backs_(mesh.surface_names.size(), 0.0),
      prepared_(mesh.size(), 0),
      constant_(mesh.size(), 0),
      facets_(basis.facetCount()) {}

void InterpolatedView::begin(const EyeFrame& frame) {
  frame_ = frame;
  level_ = {};
  std::fill(backs_.begin(), backs_.end(), 0.0);
  above_ = {};
  ++view_;
}

std::array<double, 3> InterpolatedView::irradiance() const {
  std::array<double, 3> sum{};
  for (std::size_t b = 0; b < 3; ++b) sum[b] = level_[b] + total(above_.sum[b]);
  return sum;
}

std::size_t InterpolatedView::bytes() const {
  return prepared_.size() * sizeof(std::uint32_t) + constant_.size() +
         facets_.size() * sizeof(SeenFacet);
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
  if (corner == BasisFacet::kInside) return cornerMean(patch);
  const float* value = &radiosity_[3 * std::size_t(eye_of_corner_[corner])];
  return {value[0], value[1], value[2]};
}

void InterpolatedView::prepare(std::size_t patch) {
  prepared_[patch] = view_;
  const std::span<const BasisFacet> all = basis_.facets(patch);
  const std::size_t first = basis_.facetBegin(patch);
  bool constant = true;
  for (std::size_t f = 0; f < all.size(); ++f) {
    SeenFacet& seen = facets_[first + f];
    place(all[f], seen);
    constant = setValues(patch, all[f], seen) && constant;
    constant = constant && seen.level == facets_[first].level;
  }
  constant_[patch] = constant;
}

void InterpolatedView::place(const BasisFacet& facet, SeenFacet& seen) const {
  seen.count = std::size_t(facet.count);
  seen.row.area = facet.area;
  std::array<Vec3, 4> corner{};
  for (std::size_t k = 0; k < seen.count; ++k) {
    corner[k] = frame_.toEye(mesh_.vertices[facet.vertex[k]] * scale_);
  }
  for (std::size_t k = 0; k < seen.count; ++k) {
    // det(b, a, r), from the edge itself: b x a = (b - a) x a. Of a front it is positive inside.
    const Vec3& next = corner[(k + 1) % seen.count];
    seen.edge[k] = glm::cross(next - corner[k], corner[k]);
  }
}

/// Differences to corner 0: a constant field stays that constant. True if it is one.
bool InterpolatedView::setValues(std::size_t patch, const BasisFacet& facet,
                                 SeenFacet& seen) const {
  seen.level = valueAt(patch, facet.corner[0]);
  bool constant = true;
  for (std::size_t k = 1; k < seen.count; ++k) {
    const std::array<double, 3> value = valueAt(patch, facet.corner[k]);
    const double factor = seen.count == 4 ? facet.area[k] : 1;
    for (std::size_t b = 0; b < 3; ++b) {
      constant = constant && value[b] == seen.level[b];
      seen.row.rise[b][k] = factor * (value[b] - seen.level[b]);
    }
  }
  return constant;
}

/// Edges as linear functions along the row of the run.
void InterpolatedView::alongRow(SeenFacet& facet, const ItemRun& run) const {
  const double pixel = 2.0 / resolution_;  // in units of half a face
  for (std::size_t k = 0; k < facet.count; ++k) {
    const FacePoint p = run.face.project(facet.edge[k]);
    facet.row.slope[k] = p.x * pixel;
    facet.row.base[k] = p.y * pixel * run.height + p.w;
  }
}

void InterpolatedView::visit(const ItemRun& run) {
  if (run.begin >= run.end) return;
  const std::size_t patch = run.item;
  if (patch >= mesh_.size()) {  // backs are black; what comes after them is the sky
    const std::size_t surface = patch - mesh_.size();
    if (surface < backs_.size()) backs_[surface] += run.weights[run.end] - run.weights[run.begin];
    return;
  }
  if (prepared_[patch] != view_) prepare(patch);
  if (constant_[patch] == 0 && basis_.facets(patch).size() > 1) return addManyFacets(patch, run);
  SeenFacet& facet = facets_[basis_.facetBegin(patch)];
  if (constant_[patch] == 0) alongRow(facet, run);
  addRun(facet, run, run.begin, run.end, constant_[patch] != 0);
}

void InterpolatedView::addRun(const SeenFacet& facet, const ItemRun& run, int begin, int end,
                              bool constant) {
  const double weight = run.weights[end] - run.weights[begin];
  for (std::size_t b = 0; b < 3; ++b) level_[b] += weight * facet.level[b];
  if (constant) return;
  const PixelRow pixels{run.weights + begin, begin + run.first_centre, end - begin,
                        resolution_ - begin};
  (facet.count == 4 ? kernels_.addQuad : kernels_.addTriangle)(facet.row, pixels, above_);
}

/// Each pixel belongs to the facet it lies deepest in: edges' values measured against their sum.
void InterpolatedView::addManyFacets(std::size_t patch, const ItemRun& run) {
  const std::span facets(facets_.data() + basis_.facetBegin(patch), basis_.facets(patch).size());
  for (SeenFacet& facet : facets) alongRow(facet, run);
  for (int x = run.begin; x < run.end; ++x) {
    const double centre = x + run.first_centre;
    const SeenFacet* best = facets.data();
    double deepest = -HUGE_VAL;
    for (const SeenFacet& facet : facets) {
      double least = HUGE_VAL;
      double sum = 0;
      for (std::size_t k = 0; k < facet.count; ++k) {
        const double a = facet.row.slope[k] * centre + facet.row.base[k];
        least = std::min(least, a);
        sum += a;
      }
      const double depth = sum > 0 ? least / sum : -HUGE_VAL;
      if (depth > deepest) {
        deepest = depth;
        best = &facet;
      }
    }
    addRun(*best, run, x, x + 1, false);
  }
}

}  // namespace radiosity
