#include "formfactor/exact/unoccluded/near_exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/geometry/plane_frame.h"
#include "formfactor/exact/error_model.h"
#include "formfactor/exact/unoccluded/contour.h"
#include "formfactor/exact/unoccluded/quadrature.h"

namespace radiosity {
namespace {

double distanceToEdges(const Vec3& p, std::span<const Vec3> polygon) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0, last = polygon.size() - 1; k < polygon.size(); last = k++) {
    const Vec3 edge = polygon[k] - polygon[last];
    const Vec3 offset = p - polygon[last];
    const double length2 = glm::dot(edge, edge);
    const double t = length2 > 0 ? std::clamp(glm::dot(offset, edge) / length2, 0.0, 1.0) : 0;
    least = std::min(least, glm::distance(offset, t * edge));
  }
  return least;
}

constexpr int kLeastPoints = 2;
/// More points cost more than contours.
constexpr int kMostPoints = 8;
/// Loss of contours to cancellation, as a share of the square of the pair's extent.
constexpr double kContourRounding = 1e-16;
/// Where the loss is more than this share of the exchange, or all of it, points are better at any
/// distance.
constexpr double kContourUseless = 1e-2;

/// The least n for which n x n points are good for the tolerance: the error is below
/// kLambertError ratio^(2n - 1), ratio = radius / distance (a triangle's Jacobian takes one
/// degree).
int pointsFor(double ratio, double tolerance) {
  if (!(ratio < 1)) return kMostLambert + 1;
  const double needed = 0.5 * (std::log(tolerance / kLambertError) / std::log(ratio) + 1);
  return std::max(kLeastPoints, int(std::ceil(std::min(needed, kMostLambert + 1.0))));
}

/// The kernel takes one eye and many polygons; here it is one polygon, moved, and many points.
struct PointLanes {
  static constexpr std::size_t kMost = std::size_t(kMostLambert) * kMostLambert;
  static_assert(kMost % kLaneAlignment == 0);
  using Lanes = std::array<double, kMost>;

  /// Adds the places of the polygon's `centre` as seen from n x n Gauss points of an element.
  void addPoints(const PlanarElement& from, const Vec3& centre, int n) {
    // A triangle is a quadrilateral whose last two corners meet: its map's Jacobian vanishes there.
    const Vec3& c0 = from.outline[0];
    const Vec3& c1 = from.outline[1];
    const Vec3& c2 = from.outline[2];
    const Vec3& c3 = from.outline[from.outline.size() - 1];
    const Vec3 mean = 0.25 * (c0 + c1 + c2 + c3);
    const Vec3 u = 0.25 * (c1 - c0 + c2 - c3);
    const Vec3 v = 0.25 * (c3 - c0 + c2 - c1);
    const Vec3 w = 0.25 * (c0 - c1 + c2 - c3);
    for (const Node& s : gaussLegendre(n)) {
      for (const Node& t : gaussLegendre(n)) {
        const Vec3 to_centre = centre - (mean + s.x * u + t.x * (v + s.x * w));
        const double jacobian = glm::dot(from.normal, glm::cross(u + t.x * w, v + s.x * w));
        weight[count] = s.weight * t.weight * jacobian;
        middle[0][count] = to_centre.x;
        middle[1][count] = to_centre.y;
        middle[2][count] = to_centre.z;
        ++count;
      }
    }
  }

  TargetLanes<double> targets(const PlanarElement& to) {
    const std::size_t lanes = (count + kLaneAlignment - 1) / kLaneAlignment * kLaneAlignment;
    TargetLanes<double> targets{};
    targets.corners = to.outline.size();
    targets.count = lanes;
    for (std::size_t k = 0; k < 3; ++k) {
      std::fill(middle[k].begin() + std::ptrdiff_t(count),
                middle[k].begin() + std::ptrdiff_t(lanes), middle[k][0]);
      targets.middle[k] = middle[k].data();
    }
    const PlaneFrame frame = makeFrame(to.centroid, to.normal, axisAcross(to.normal));
    const std::array<Vec3, 2> axes = {frame.u, frame.v};
    for (std::size_t a = 0; a < 2; ++a) {
      for (std::size_t k = 0; k < 3; ++k) {
        std::fill_n(axis[a][k].begin(), lanes, axes[a][glm::length_t(k)]);
        targets.axis[a][k] = axis[a][k].data();
      }
      for (std::size_t k = 0; k < targets.corners; ++k) {
        const Vec2 flat = frame.flat(to.outline[k]);
        std::fill_n(corner[k][a].begin(), lanes, flat[glm::length_t(a)]);
        targets.corner[k][a] = corner[k][a].data();
      }
    }
    return targets;
  }

  std::size_t count = 0;
  Lanes weight;
  alignas(64) std::array<Lanes, 3> middle;
  alignas(64) std::array<std::array<Lanes, 3>, 2> axis;
  alignas(64) std::array<std::array<Lanes, 2>, kMostCorners> corner;
  alignas(64) Lanes seen;
};

}  // namespace

double lambertExchange(const PlanarElement& from, const PlanarElement& to, int n,
                       const ClipKernels<double>& kernels) {
  PointLanes lanes;
  lanes.addPoints(from, to.centroid, n);
  const Vec3& normal = from.normal;
  kernels.near.whole(lanes.targets(to), {{0, 0, 0}, {normal.x, normal.y, normal.z}},
                     lanes.seen.data());
  double sum = 0;
  for (std::size_t k = 0; k < lanes.count; ++k) sum += lanes.weight[k] * lanes.seen[k];
  return sum;
}

NearValue nearExchange(const PlanarElement& a, const PlanarElement& b, double tolerance,
                       const ClipKernels<double>& kernels) {
  const PlanarElement& small = a.radius <= b.radius ? a : b;
  const PlanarElement& large = a.radius <= b.radius ? b : a;
  const double distance = distanceToEdges(small.centroid, large.outline);
  const int points = pointsFor(small.radius / distance, tolerance);
  if (points <= kMostPoints) return {lambertExchange(small, large, points, kernels), false};
  const double exchange = contourExchange(a.outline, b.outline, tolerance);
  // Thin elements exchange little for their length: there contours may have too few digits left.
  const double extent = glm::distance(a.centroid, b.centroid) + a.radius + b.radius;
  const double lost = kContourRounding * extent * extent;
  const bool too_near = points > kMostLambert;
  if (lost <= (too_near ? kContourUseless : tolerance) * exchange) return {exchange, true};
  return {lambertExchange(small, large, std::min(points, kMostLambert), kernels), false};
}

}  // namespace radiosity
