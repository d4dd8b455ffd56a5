#include "gather/interpolated_view.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "base/steady_mean.h"

namespace radiosity {
namespace {

/// The sum of all lanes, in a fixed order.
double total(const std::array<double, kLanes>& lanes) {
  double sum = 0;
  for (const double lane : lanes) sum += lane;
  return sum;
}

}  // namespace

InterpolatedView::InterpolatedView(const PatchMesh& mesh, const PatchBasis& basis, double scale,
                                   int resolution, bool simd,
                                   const std::vector<Index>& eye_of_corner,
                                   const std::vector<float>& radiosity, std::size_t bands)
    : mesh_(mesh),
      basis_(basis),
      kernels_(interpolationKernels(simd)),
      scale_(scale),
      resolution_(resolution),
      eye_of_corner_(eye_of_corner),
      radiosity_(radiosity),
      bands_(bands),
      level_(bands, 0.0),
      backs_(mesh.surface_names.size(), 0.0),
      above_(bands),
      prepared_(mesh.size(), 0),
      constant_(mesh.size(), 0),
      facets_(basis.facetCount()),
      facet_rise_(basis.facetCount() * bands) {}

void InterpolatedView::begin(const EyeFrame& frame) {
  frame_ = frame;
  std::fill(level_.begin(), level_.end(), 0.0);
  std::fill(backs_.begin(), backs_.end(), 0.0);
  std::fill(above_.begin(), above_.end(), LaneSums());
  ++view_;
}

void InterpolatedView::irradiance(std::span<double> sum) const {
  // Radiosities are not negative. Where those of corner 0 are by far the largest, the sums nearly
  // cancel, and rounding is left.
  for (std::size_t b = 0; b < bands_; ++b) sum[b] = std::max(level_[b] + total(above_[b].sum), 0.0);
}

std::size_t InterpolatedView::bytes() const {
  return prepared_.size() * sizeof(std::uint32_t) + constant_.size() +
         facets_.size() * sizeof(SeenFacet) + facet_rise_.size() * sizeof(facet_rise_[0]);
}

double InterpolatedView::cornerMean(std::size_t patch, std::size_t band) const {
  const std::size_t first = mesh_.corner_offset[patch];
  const std::size_t end = mesh_.corner_offset[patch + 1];
  SteadyMean mean;
  for (std::size_t c = first; c < end; ++c) mean.add(1, valueAt(patch, c, band));
  return mean.value();
}

double InterpolatedView::valueAt(std::size_t patch, std::size_t corner, std::size_t band) const {
  if (corner == BasisFacet::kInside) return cornerMean(patch, band);
  return radiosity_[bands_ * std::size_t(eye_of_corner_[corner]) + band];
}

void InterpolatedView::prepare(std::size_t patch) {
  prepared_[patch] = view_;
  const std::span<const BasisFacet> all = basis_.facets(patch);
  const std::size_t first = basis_.facetBegin(patch);
  bool constant = true;
  for (std::size_t f = 0; f < all.size(); ++f) {
    place(all[f], facets_[first + f]);
    constant = setValues(patch, all[f], first + f) && constant;
    for (std::size_t b = 0; b < bands_; ++b) {
      constant = constant && facets_[first + f].row.rise[b][0] == facets_[first].row.rise[b][0];
    }
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
    // det(b, a, r) from the edge itself: b x a = (b - a) x a. It is positive inside a front.
    const Vec3& next = corner[(k + 1) % seen.count];
    seen.edge[k] = glm::cross(next - corner[k], corner[k]);
  }
}

/// Stores differences to corner 0, so that a constant field stays constant. True if all bands are
/// constant.
bool InterpolatedView::setValues(std::size_t patch, const BasisFacet& facet, std::size_t seen) {
  std::array<double, 4>* rise = facet_rise_.data() + seen * bands_;
  facets_[seen].row.rise = {rise, bands_};
  const auto count = std::size_t(facet.count);
  for (std::size_t b = 0; b < bands_; ++b) rise[b][0] = valueAt(patch, facet.corner[0], b);
  bool constant = true;
  for (std::size_t k = 1; k < count; ++k) {
    const double factor = count == 4 ? facet.area[k] : 1;
    for (std::size_t b = 0; b < bands_; ++b) {
      const double value = valueAt(patch, facet.corner[k], b);
      constant = constant && value == rise[b][0];
      rise[b][k] = factor * (value - rise[b][0]);
    }
  }
  return constant;
}

/// Sets the edges as linear functions along the row of the run.
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
  if (patch >= mesh_.size()) {  // backs, which are black, and after them the sky
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
  for (std::size_t b = 0; b < bands_; ++b) level_[b] += weight * facet.row.rise[b][0];
  if (constant) return;
  const PixelRow pixels{run.weights + begin, begin + run.first_centre, end - begin,
                        resolution_ - begin};
  (facet.count == 4 ? kernels_.addQuad : kernels_.addTriangle)(facet.row, pixels, above_.data());
}

/// Each pixel belongs to the facet in which it lies deepest: edge values are compared after
/// division by their sum.
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
