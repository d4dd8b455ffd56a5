#include "formfactor/hemicube/near_pairs.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "visibility/clipping/convex_polygon.h"

namespace radiosity {
namespace {

constexpr double kNearSizes = 2;
/// Far below the error of a visible fraction made of pixels.
constexpr double kTolerance = 1e-5;

}  // namespace

NearPairs::NearPairs(const PatchMesh& mesh, const FormFactorOptions& options)
    : mesh_(mesh),
      elements_(mesh),
      kernel_(elements_, kTolerance, options.simd),
      pixels_(3.0 * options.resolution * options.resolution),
      first_(mesh.size() + 1, 0),
      patch_elements_(elements_.patch_elements) {
  for (std::size_t e = 0; e < patch_elements_.size(); ++e) ++first_[elements_.patch[e] + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (Index e = 0; e < patch_elements_.size(); ++e)
    patch_elements_[next[elements_.patch[e]]++] = e;
}

bool NearPairs::near(std::size_t i, std::size_t j) const {
  const double size = std::sqrt(std::max(mesh_.area[i], mesh_.area[j]));
  const Vec3 between = mesh_.centroid[j] - mesh_.centroid[i];
  return glm::dot(between, between) < kNearSizes * kNearSizes * size * size;
}

double NearPairs::corrected(std::size_t i, std::size_t j, double seen) const {
  const Vec3 eye = (mesh_.centroid[i] - elements_.middle) * elements_.scale;
  const Vec3& normal = mesh_.normal[i];
  ConvexPolygon polygon;
  ConvexPolygon above;
  double point = 0;
  double exchange = 0;
  for (std::size_t b = first_[j]; b < first_[j + 1]; ++b) {
    const Index column = patch_elements_[b];
    polygon.assign(elements_.outline(column), eye);
    const PlaneSide side = split(polygon, {normal, 0}, 0, &above, nullptr);
    if (side != PlaneSide::outside) {
      point += std::max(0.0, lambert(side == PlaneSide::both ? above : polygon, normal));
    }
    for (std::size_t a = first_[i]; a < first_[i + 1]; ++a) {
      exchange += kernel_.pair(patch_elements_[a], column);
    }
  }
  if (!(point > 0)) return seen;
  // A patch that covers n pixels is seen with a relative error of about n^(-3/4) (two standard
  // deviations), from the pixels its outline cuts.
  const double noise = std::pow(point * pixels_, -0.75);
  const double fraction = seen / point > 1 - noise ? 1.0 : seen / point;
  const double area = mesh_.area[i] * elements_.scale * elements_.scale;
  return fraction * exchange / area;
}

NearPairs::Outcome NearPairs::correct(std::size_t patch, PackedRow& row, double beside,
                                      bool closed) const {
  Outcome outcome;
  std::vector<std::uint8_t> replaced(row.columns.size(), 0);
  for (std::size_t k = 0; k < row.columns.size(); ++k) {
    if (!near(patch, row.columns[k])) continue;
    row.values[k] = corrected(patch, row.columns[k], row.values[k]);
    replaced[k] = 1;
    ++outcome.replaced;
  }
  if (outcome.replaced > 0) outcome.scaled = row.scaleRest(replaced, beside, closed);
  return outcome;
}

}  // namespace radiosity
