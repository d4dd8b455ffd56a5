#include "contour.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "gauss.h"

namespace radiosity::truth {
namespace {

using Real = long double;
using Point = glm::vec<3, Real>;
using RealLoop = BasicLoop<Point>;

/// Rounding of coordinates made in double precision, relative: below it a corner is on a plane.
constexpr Real kRounding = 1e-15L;

struct Edge {
  Point from;
  Point direction;  ///< unit
  Real length;
  Edge(const Point& a, const Point& b) : from(a), direction(b - a), length(glm::length(direction)) {
    if (length > 0) direction /= length;
  }
  Point at(Real s) const { return from + direction * s; }
};

/// Integral of ln sqrt(u^2 + h^2).
Real logIntegral(Real u, Real h) {
  const Real square = u * u + h * h;
  return square > 0 ? u * std::log(square) / 2 - u + h * std::atan2(u, h) : 0;
}

/// Integral of ln |p - q| over q on the edge, in closed form.
Real innerIntegral(const Point& p, const Edge& edge) {
  const Point w = edge.from - p;
  const Real u = glm::dot(w, edge.direction);
  const Real h = glm::length(glm::cross(w, edge.direction));
  return logIntegral(u + edge.length, h) - logIntegral(u, h);
}

Real gaussIntegral(const Edge& outer, const Edge& inner, int points) {
  Real sum = 0;
  for (const GaussPoint& g : gaussRule(points)) {
    sum += g.weight * innerIntegral(outer.at(g.x * outer.length), inner);
  }
  return sum * outer.length;
}

/// Nodes of the double exponential rule on (0, 1) that level `level` adds to the levels before it;
/// the step is 2^-level. `x` is the distance from the nearer end.
struct DoubleExponentialNode {
  Real x;
  Real weight;  ///< without the step
};

const std::vector<DoubleExponentialNode>& doubleExponentialNodes(int level) {
  constexpr int kLevels = 9;
  constexpr Real kEnd = 3.5L;  // weights below 1e-21
  static const std::vector<std::vector<DoubleExponentialNode>> all = [] {
    std::vector<std::vector<DoubleExponentialNode>> levels(kLevels);
    for (int l = 0; l < kLevels; ++l) {
      const Real step = std::ldexp(Real(1), -l);
      // Level 0 holds all whole steps, later ones the odd multiples of their step.
      for (Real t = l == 0 ? 0 : step; t <= kEnd; t += l == 0 ? step : 2 * step) {
        const Real half_pi = std::numbers::pi_v<Real> / 2;
        const Real q = std::exp(-2 * half_pi * std::sinh(t));
        levels[std::size_t(l)].push_back(
            {q / (1 + q), 2 * half_pi * std::cosh(t) * q / ((1 + q) * (1 + q))});
      }
    }
    return levels;
  }();
  return all[std::size_t(std::min(level, kLevels - 1))];
}

/// Outer integral over [s0, s1] where the integrand may be singular at both ends.
Real doubleExponential(const Edge& outer, const Edge& inner, Real s0, Real s1) {
  constexpr Real kEnough = 1e-13L;  // the next level would be off by the square of it
  const Real width = s1 - s0;
  Real sum = 0;
  Real previous = 0;
  for (int level = 0; level < 9; ++level) {
    for (const DoubleExponentialNode& node : doubleExponentialNodes(level)) {
      sum += node.weight * innerIntegral(outer.at(s0 + width * node.x), inner);
      if (node.x < 0.5L) sum += node.weight * innerIntegral(outer.at(s1 - width * node.x), inner);
    }
    const Real now = std::ldexp(sum, -level);
    if (level > 2 && std::abs(now - previous) <= kEnough * inner.length) return now * width;
    previous = now;
  }
  return previous * width;
}

/// Where on `outer` the integrand is singular or nearly so: abreast of the inner edge's ends, and
/// where the two lines come closest.
std::vector<Real> cuts(const Edge& outer, const Edge& inner) {
  std::vector<Real> at = {0, outer.length};
  const auto add = [&](Real s) {
    if (s > kRounding * outer.length && s < outer.length * (1 - kRounding)) at.push_back(s);
  };
  const Point w = inner.from - outer.from;
  const Real b = glm::dot(outer.direction, inner.direction);
  add(glm::dot(w, outer.direction));
  add(glm::dot(w + inner.direction * inner.length, outer.direction));
  if (const Real det = 1 - b * b; det > kRounding) {
    add((glm::dot(w, outer.direction) - b * glm::dot(w, inner.direction)) / det);
  }
  std::sort(at.begin(), at.end());
  return at;
}

Real pointToEdge(const Point& p, const Edge& e) {
  const Real s = std::clamp(glm::dot(p - e.from, e.direction), Real(0), e.length);
  return glm::distance(p, e.at(s));
}

/// A lower bound of the distance of two edges: good enough to choose a rule by.
Real apart(const Edge& a, const Edge& b) {
  const Point middle = a.at(a.length / 2);
  return pointToEdge(middle, b) - a.length / 2;
}

Real edgePair(const Edge& a, const Edge& b) {
  const Edge& outer = a.length <= b.length ? a : b;
  const Edge& inner = a.length <= b.length ? b : a;
  // Gauss with n points errs by rho^(-2n), rho the sum of the half axes of the largest ellipse
  // about the outer edge (half length 1) without a singularity: at worst one abreast of it, 2 gap
  // away, rho = 2 gap + sqrt(4 gap^2 + 1). Below 1e-15 in each case here.
  const Real gap = apart(outer, inner) / outer.length;
  if (gap > 8) return gaussIntegral(outer, inner, 6);
  if (gap > 3) return gaussIntegral(outer, inner, 8);
  if (gap > 1) return gaussIntegral(outer, inner, 12);
  if (gap > 0.5L) return gaussIntegral(outer, inner, 20);
  Real sum = 0;
  const std::vector<Real> at = cuts(outer, inner);
  for (std::size_t k = 1; k < at.size(); ++k) {
    if (at[k] > at[k - 1]) sum += doubleExponential(outer, inner, at[k - 1], at[k]);
  }
  return sum;
}

/// The part of `loop` in front of the plane of `other`.
RealLoop inFrontOf(const RealLoop& loop, const RealLoop& other) {
  const Point normal = glm::normalize(vectorArea(other));
  Point middle(0);
  for (const Point& p : other) middle += p;
  middle /= Real(other.size());
  Real size = 0;
  for (const Point& p : loop) size = std::max(size, glm::distance(p, middle));
  RealLoop front;
  split(loop, normal, glm::dot(normal, middle), kRounding * size, &front,
        static_cast<RealLoop*>(nullptr));
  return front;
}

std::vector<Edge> edgesOf(const RealLoop& loop) {
  std::vector<Edge> edges;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Edge edge(loop[k], loop.next(k));
    if (edge.length > 0) edges.push_back(edge);
  }
  return edges;
}

double contourSum(const RealLoop& a, const RealLoop& b) {
  const std::vector<Edge> edges_b = edgesOf(b);
  Real sum = 0;
  for (const Edge& e : edgesOf(a)) {
    for (const Edge& f : edges_b) {
      const Real cosine = glm::dot(e.direction, f.direction);
      if (std::abs(cosine) > kRounding * kRounding) sum += cosine * edgePair(e, f);
    }
  }
  return double(std::max(sum, Real(0)) / (2 * std::numbers::pi_v<Real>));
}

RealLoop realLoop(const Loop& loop) {
  return RealLoop(std::span<const Vec3>(loop.begin(), loop.size()));
}

}  // namespace

double unoccludedExchange(const Loop& a, const Loop& b) {
  const RealLoop whole_a = realLoop(a);
  const RealLoop whole_b = realLoop(b);
  const RealLoop front_a = inFrontOf(whole_a, whole_b);
  const RealLoop front_b = inFrontOf(whole_b, whole_a);
  if (front_a.empty() || front_b.empty()) return 0;
  return contourSum(front_a, front_b);
}

double facingExchange(const Loop& a, const Loop& b) { return contourSum(realLoop(a), realLoop(b)); }

}  // namespace radiosity::truth
