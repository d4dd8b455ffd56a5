#include "shape_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "converged_cell.h"
#include "formfactor/contour_reference.h"
#include "formfactor/element_pairs.h"
#include "formfactor/exact/unoccluded/far_kernels.h"
#include "formfactor/exact/unoccluded/near_exchange.h"
#include "formfactor/exact/unoccluded/quadrature.h"

namespace radiosity::bench {
namespace {

using test::ElementPair;
using test::ElementPairs;
using test::Shape;

constexpr std::array<Shape, 5> kShapes = {Shape::square, Shape::parallelogram, Shape::sliver,
                                          Shape::triangle, Shape::quadrilateral};
/// The reference is good to about 1e-18: to ten digits of values from here on.
constexpr double kLeastValue = 1e-8;
constexpr double kLeastError = 1e-9;

FacetFrame frameOf(const std::vector<Vec3>& outline, const Vec3& normal) {
  const Vec3 u = glm::normalize(outline[1] - outline[0]);
  return {u, glm::cross(normal, u), normal, glm::dot(normal, outline[0])};
}

/// One pair, by the formula that the limits given leave.
class FarPair {
 public:
  explicit FarPair(const ElementPair& pair)
      : row_frame_(frameOf(pair.a, pair.normal_a)),
        column_frame_(frameOf(pair.b, pair.normal_b)),
        row_(flatShape(pair.a, row_frame_)),
        column_(flatShape(pair.b, column_frame_)) {}

  double skew() const {
    return std::max(std::abs(row_.alpha) + std::abs(row_.beta),
                    std::abs(column_.alpha) + std::abs(column_.beta));
  }
  /// By the series if R is at most `limit`; else kNearPair.
  double series(double limit) const {
    RuleLimits<double> none{};
    none.plain.fill(-1);
    return value(limit, none);
  }
  double rule(std::size_t k) const {
    RuleLimits<double> one{};
    one.plain.fill(-1);
    one.plain[k] = std::numeric_limits<double>::max();
    return value(0, one);
  }
  /// The least limit with which the series serves.
  double magnitude() const {
    double low = 1e-8;
    double high = 1e8;
    while (high > 1.0001 * low) {
      const double middle = std::sqrt(low * high);
      (series(middle) == kNearPair ? low : high) = middle;
    }
    return high;
  }

 private:
  double value(double series_limit, const RuleLimits<double>& limits) const {
    const FarBounds bounds{series_limit, 0};
    FarColumns<double> columns(1);
    columns.set(0, column_, bounds);
    std::vector<double> heights(1 + kFarPadding, 0.0);
    heights[0] = glm::dot(row_frame_.normal, column_.centroid) - row_frame_.offset;
    std::vector<double> values(1 + kFarPadding);
    FarRow<double> row(row_, row_frame_, column_frame_, bounds);
    kernels_.double_precision(row, {&columns, 0, 1, heights.data(), values.data()}, limits);
    return values[0];
  }

  FarKernels kernels_ = farKernels(false);
  FacetFrame row_frame_, column_frame_;
  FlatShape row_, column_;
};

void printRules(const ElementPair& pair, double truth) {
  const FarPair far(pair);
  const double magnitude = far.magnitude();
  for (int k = -1; k < int(kFarRules); ++k) {
    const double value =
        k < 0 ? far.series(std::numeric_limits<double>::max()) : far.rule(std::size_t(k));
    const double error = std::abs(value / truth - 1);
    if (error > kLeastError) fmt::print("rule {} {} {} {}\n", k, magnitude, far.skew(), error);
  }
}

PlanarElement planarElement(const std::vector<Vec3>& outline, const Vec3& normal) {
  PlanarElement element{outline, normal, flatShape(outline, frameOf(outline, normal)).centroid, 0};
  for (const Vec3& corner : outline) {
    element.radius = std::max(element.radius, glm::distance(corner, element.centroid));
  }
  return element;
}

double distanceToEdges(const Vec3& p, const std::vector<Vec3>& polygon) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
    const double t = std::clamp(glm::dot(p - polygon[k], edge) / glm::dot(edge, edge), 0.0, 1.0);
    least = std::min(least, glm::distance(p, polygon[k] + t * edge));
  }
  return least;
}

/// The second element of a pair is the smaller one.
void printLambert(const ElementPair& pair, double truth, const ClipKernels<double>& kernels) {
  const PlanarElement large = planarElement(pair.a, pair.normal_a);
  const PlanarElement small = planarElement(pair.b, pair.normal_b);
  const double ratio = small.radius / distanceToEdges(small.centroid, pair.a);
  for (int n = 2; n <= 8; ++n) {
    const double error = std::abs(lambertExchange(small, large, n, kernels) / truth - 1);
    if (ratio < 1 && error > kLeastError) fmt::print("lambert {} {} {}\n", n, ratio, error);
  }
}

/// From the middle of the first element.
void printEye(const ElementPair& pair, TargetLook& look) {
  const PlanarElement target = planarElement(pair.b, pair.normal_b);
  const PlanarElement eye = planarElement(pair.a, pair.normal_a);
  GroupTarget group;
  group.setOutline(pair.b, makeFrame(target.centroid, pair.normal_b, axisAcross(pair.normal_b)));
  look.take(group, pair.normal_a);
  const SampleCell point = {{eye.centroid, eye.centroid, eye.centroid, eye.centroid}};
  SamplePoints points;
  points.point[points.count++] = {eye.centroid, 1};
  look.at(points, point);
  const double near = look.whole(0);
  look.at(points, point, true);
  if (!(near > 0)) return;
  const Vec3 way = target.centroid - eye.centroid;
  const double height =
      std::min(glm::dot(pair.normal_a, way), -glm::dot(pair.normal_b, way)) / target.radius;
  fmt::print("eye {} {} {}\n", target.radius / glm::length(way), height,
             std::abs(look.whole(0) / near - 1));
}

/// Of the integral of ln(1 + x) over [-1, 1], 2 ln 2 - 2.
void printDigits() {
  for (int level = 0; level <= kFinestTanhSinh; ++level) {
    double sum = 0;
    for (const Node& node : tanhSinh(level)) {
      sum += node.weight * std::log(node.x < 0 ? node.gap : 1 + node.x);
    }
    fmt::print("digits {} {}\n", level, std::abs(sum / (2 * std::log(2.0) - 2) - 1));
  }
}

}  // namespace

void sampleShapes(std::size_t pairs, std::uint64_t seed) {
  const ClipKernelSet kernels = clipKernels(false);
  TargetLook look;
  for (const Shape shape : kShapes) {
    ElementPairs random(seed + std::uint64_t(shape));
    for (std::size_t k = 0; k < pairs;) {
      const double ratio = random.logUniform(0.1, 1);
      const double distance = random.logUniform(1.5, 60);
      const ElementPair pair = random.next(shape, ratio, distance);
      const double truth = test::referenceExchange(pair.a, pair.b);
      if (!(truth > kLeastValue)) continue;
      ++k;
      printRules(pair, truth);
      printLambert(pair, truth, kernels.exact);
      printEye(pair, look);
    }
  }
  printDigits();
}

}  // namespace radiosity::bench
