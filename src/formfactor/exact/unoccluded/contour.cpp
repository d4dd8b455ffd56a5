#include "formfactor/exact/unoccluded/contour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "formfactor/exact/error_model.h"
#include "formfactor/exact/unoccluded/quadrature.h"

namespace radiosity {
namespace {

double xLogY(double x, double y) { return x == 0 ? 0 : x * std::log(y); }

/// K''(u) = ln(u^2 + h^2) / 2.
double parallelTerm(double u, double h) {
  const double uu = u * u;
  const double hh = h * h;
  return 0.25 * xLogY(uu - hh, uu + hh) + h * u * std::atan2(u, h) - 0.75 * uu;
}

/// Both edges along one direction: from s0 to s1, and from t0 to t1 at a distance h.
double parallelEdges(double s0, double s1, double t0, double t1, double h) {
  // In this order differences of like terms come first.
  return (parallelTerm(t1 - s0, h) - parallelTerm(t1 - s1, h)) -
         (parallelTerm(t0 - s0, h) - parallelTerm(t0 - s1, h));
}

struct Segment {
  Vec3 origin{0.0};
  Vec3 direction{0.0};  // unit
  double length = 0;
};

/// Integral of ln(r / unit) from a point at `offset` from the segment's origin.
double logAlong(const Segment& segment, const Vec3& offset, double inverse_unit) {
  const double u0 = -glm::dot(offset, segment.direction);
  const double u1 = u0 + segment.length;
  const double h = glm::length(glm::cross(offset, segment.direction));
  const double hh = h * h;
  // atan(u1/h) - atan(u0/h), right also at h = 0, where the point lies on the line.
  const double angle = std::atan2(h * segment.length, hh + u0 * u1);
  const double scale = inverse_unit * inverse_unit;
  return 0.5 * (xLogY(u1, (u1 * u1 + hh) * scale) - xLogY(u0, (u0 * u0 + hh) * scale)) -
         segment.length + h * angle;
}

double distanceTo(const Segment& segment, const Vec3& p) {
  const Vec3 offset = p - segment.origin;
  const double along = std::clamp(glm::dot(offset, segment.direction), 0.0, segment.length);
  return glm::length(offset - along * segment.direction);
}

/// Places along `outer` at which its quadrature is split, ascending, both ends included: the inner
/// integral's singularities, or the nearest points to them in the complex plane.
struct Splits {
  static constexpr std::size_t kMost = 5;
  std::array<double, kMost> at{};
  std::size_t count = 0;
};

Splits findSplits(const Segment& outer, const Segment& inner) {
  Splits splits;
  const auto add = [&](double s) {
    if (!(s > 0 && s < outer.length)) return;
    std::size_t k = splits.count++;
    for (; splits.at[k - 1] > s; --k) splits.at[k] = splits.at[k - 1];
    splits.at[k] = s;
  };
  splits.at[splits.count++] = 0;
  const Vec3 offset = inner.origin - outer.origin;
  const double cosine = glm::dot(outer.direction, inner.direction);
  const double s0 = glm::dot(offset, outer.direction);
  add(s0);
  add(s0 + inner.length * cosine);
  // The points of both lines nearest to each other; none for lines that are all but parallel.
  const Vec3 normal = glm::cross(outer.direction, inner.direction);
  const double sine2 = glm::dot(normal, normal);
  if (sine2 > 0) add(glm::dot(glm::cross(offset, inner.direction), normal) / sine2);
  splits.at[splits.count++] = outer.length;
  return splits;
}

/// Gauss nodes for a piece of length `length` whose nearest singularity is at `distance`.
double gaussNodes(double length, double distance, double digits) {
  // Legendre's rule converges like r^(-2n), r the sum of half-axes of the largest ellipse about
  // the piece that is free of singularities.
  const double height = 2 * distance / length;
  const double r = height + std::sqrt(1 + height * height);
  return std::max(2.0, std::ceil(digits / (2 * std::log(r)) + 1));
}

/// Gauss where singularities are far enough for its geometric convergence, else a rule that bears
/// singular ends.
std::span<const Node> chooseRule(double nodes, double digits) {
  if (nodes <= kMostGaussNodes) return gaussLegendre(int(nodes));
  // About e^(-kTanhSinhDigits / step) for a logarithm at the end.
  int level = 1;
  while (level < kFinestTanhSinh && kTanhSinhDigits * std::ldexp(1.0, level) < digits) ++level;
  return tanhSinh(level);
}

/// The integral from `low` to `high` along the outer edge.
double skewPiece(const Segment& outer, const Segment& inner, double low, double high,
                 std::span<const Node> rule, double inverse_unit) {
  const Vec3 from_low = outer.origin + low * outer.direction - inner.origin;
  const Vec3 from_high = outer.origin + high * outer.direction - inner.origin;
  const double length = high - low;
  double sum = 0;
  for (const Node& node : rule) {
    // Measured from the nearer end, so that nothing is lost close to a common vertex.
    const double gap = 0.5 * length * node.gap;
    const Vec3 offset =
        node.x < 0 ? from_low + gap * outer.direction : from_high - gap * outer.direction;
    sum += node.weight * logAlong(inner, offset, inverse_unit);
  }
  return 0.5 * length * sum;
}

double skewEdges(const Segment& outer, const Segment& inner, double inverse_unit,
                 double tolerance) {
  const Splits splits = findSplits(outer, inner);
  const double digits = -std::log(tolerance);
  std::array<double, Splits::kMost> distance{};
  for (std::size_t k = 0; k < splits.count; ++k) {
    distance[k] = distanceTo(inner, outer.origin + splits.at[k] * outer.direction);
  }
  std::array<double, Splits::kMost> nodes{};
  double all = 0;
  for (std::size_t k = 0; k + 1 < splits.count; ++k) {
    const double length = splits.at[k + 1] - splits.at[k];
    if (!(length > 0)) continue;
    nodes[k] = gaussNodes(length, std::min(distance[k], distance[k + 1]), digits);
    all += nodes[k];
  }
  // If singularities are far, one piece takes fewer.
  const double least = *std::min_element(distance.begin(), distance.begin() + splits.count);
  const double at_once = gaussNodes(outer.length, least, digits);
  if (at_once <= std::min<double>(all, kMostGaussNodes)) {
    return skewPiece(outer, inner, 0, outer.length, chooseRule(at_once, digits), inverse_unit);
  }
  double sum = 0;
  for (std::size_t k = 0; k + 1 < splits.count; ++k) {
    if (nodes[k] == 0) continue;
    sum += skewPiece(outer, inner, splits.at[k], splits.at[k + 1], chooseRule(nodes[k], digits),
                     inverse_unit);
  }
  return sum;
}

/// Both edges in one plane, their lines meeting where `a` is at from_a and `b` at from_b. About
/// that point ln r is homogeneous but for a constant: with s and t measured from it and H(s, t) the
/// integral over [0, s] x [0, t], H(c s, c t) = c^2 (H + s t ln c), and so by Euler's theorem
/// 2 H = s H_s + t H_t - s t. H_s and H_t are single integrals.
double meetingEdges(const Segment& a, const Segment& b, double from_a, double from_b,
                    double inverse_unit) {
  const Vec3 offset = a.origin - b.origin;
  const double along_a =
      (a.length - from_a) * logAlong(b, offset + a.length * a.direction, inverse_unit) +
      from_a * logAlong(b, offset, inverse_unit);
  const double along_b =
      (b.length - from_b) * logAlong(a, b.length * b.direction - offset, inverse_unit) +
      from_b * logAlong(a, -offset, inverse_unit);
  return 0.5 * (along_a + along_b - a.length * b.length);
}

/// Sines and cosines below this come of rounding: neglected angles of this size change an
/// integral by as much, relative.
constexpr double kRoundingAngle = 1e-13;
/// Lines are taken to meet where their distance is below this share of the tolerance.
constexpr double kNeglected = 1e-4;
/// Loss to cancellation, over the sine of the lines' angle, if lines meet far away.
constexpr double kMeetingRounding = 1e-14;
/// The finest tolerance that a quadrature is asked for.
constexpr double kFinestTolerance = 1e-15;

/// One term of the sum.
struct Term {
  double value = 0;
  bool exact = true;  // to rounding: no quadrature, nothing neglected
};

double parallelPair(const Segment& a, const Segment& b, bool same_way, double inverse_unit) {
  const Vec3 offset = (b.origin - a.origin) * inverse_unit;
  const double t0 = glm::dot(offset, a.direction);
  const double h = glm::length(glm::cross(offset, a.direction));
  const double t1 = t0 + (same_way ? b.length : -b.length) * inverse_unit;
  return parallelEdges(0, a.length * inverse_unit, t0, t1, h) / (inverse_unit * inverse_unit);
}

/// The integral of edges whose lines meet, else nothing. Lines that all but meet count: that
/// changes the integral by about their distance. `normal`: across both directions.
std::optional<double> meetingPair(const Segment& a, const Segment& b, const Vec3& normal,
                                  double inverse_unit, double tolerance) {
  const double sine2 = glm::dot(normal, normal);
  const double sine = std::sqrt(sine2);
  const Vec3 gap = b.origin - a.origin;
  const double distance = std::abs(glm::dot(gap, normal)) / sine;
  const double neglected = std::max(kRoundingAngle, kNeglected * tolerance);
  if (distance * inverse_unit > neglected || sine * tolerance < kMeetingRounding) return {};
  const double from_a = glm::dot(glm::cross(gap, b.direction), normal) / sine2;
  const double from_b = glm::dot(glm::cross(gap, a.direction), normal) / sine2;
  return meetingEdges(a, b, from_a, from_b, inverse_unit);
}

Term edgePair(const Segment& a, const Segment& b, double inverse_unit, double tolerance) {
  const double cosine = glm::dot(a.direction, b.direction);
  if (std::abs(cosine) < kRoundingAngle) return {};
  const Vec3 normal = glm::cross(a.direction, b.direction);
  if (glm::dot(normal, normal) < kRoundingAngle * kRoundingAngle) {
    return {parallelPair(a, b, cosine > 0, inverse_unit), true};
  }
  if (const auto integral = meetingPair(a, b, normal, inverse_unit, tolerance)) {
    return {cosine * *integral, false};
  }
  const bool a_outer = a.length <= b.length;
  const double integral = skewEdges(a_outer ? a : b, a_outer ? b : a, inverse_unit, tolerance);
  return {cosine * integral, false};
}

/// The edges of a loop; those of no length are left out.
class Edges {
 public:
  explicit Edges(std::span<const Vec3> loop) {
    for (std::size_t k = 0, last = loop.size() - 1; k < loop.size(); last = k++) {
      const Vec3 edge = loop[k] - loop[last];
      const double length = glm::length(edge);
      if (length > 0) edges_[count_++] = {loop[last], edge / length, length};
    }
  }
  const Segment* begin() const { return edges_.data(); }
  const Segment* end() const { return edges_.data() + count_; }

 private:
  std::array<Segment, kMostContourCorners> edges_;
  std::size_t count_ = 0;
};

struct Sum {
  double value = 0;
  double skew = 0;  // magnitudes of the terms by quadrature
};

Sum sumOfTerms(const Edges& a, const Edges& b, double unit, double tolerance) {
  Sum sum;
  for (const Segment& e : a) {
    double along = 0;
    for (const Segment& f : b) {
      const Term term = edgePair(e, f, 1 / unit, tolerance);
      along += term.value;
      if (!term.exact) sum.skew += std::abs(term.value);
    }
    sum.value += along;
  }
  return sum;
}

}  // namespace

double contourExchange(std::span<const Vec3> a, std::span<const Vec3> b, double tolerance) {
  // The unit of length drops out of closed loops; one of the loops' size keeps the terms small.
  double unit = 0;
  for (const Vec3& p : a) {
    for (const Vec3& q : b) unit = std::max(unit, glm::distance(p, q));
  }
  if (!(unit > 0)) return 0;
  // Terms are larger than their sum. If they are larger than expected, they are computed once more.
  constexpr double kExpectedCancellation = 1e-2;
  const double first = kExpectedCancellation * tolerance;
  const Edges edges_a(a);
  const Edges edges_b(b);
  Sum sum = sumOfTerms(edges_a, edges_b, unit, first);
  if (first * sum.skew > tolerance * sum.value) {
    const double needed = tolerance * std::max(sum.value, 0.0) / sum.skew;
    sum = sumOfTerms(edges_a, edges_b, unit, std::max(needed, kFinestTolerance));
  }
  return sum.value / (2 * std::numbers::pi);
}

}  // namespace radiosity
