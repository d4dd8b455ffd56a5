// Exchange areas in long double, by a code path of its own: contour integrals with one closed form
// along one edge and tanh-sinh quadrature along the other, split wherever it can be singular.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity::test {

struct Long3 {
  long double x = 0, y = 0, z = 0;
};
inline Long3 operator+(const Long3& a, const Long3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Long3 operator-(const Long3& a, const Long3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Long3 operator*(long double s, const Long3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline long double dot(const Long3& a, const Long3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Long3 cross(const Long3& a, const Long3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline long double length(const Long3& a) { return std::sqrt(dot(a, a)); }
inline Long3 toLong(const Vec3& p) { return {p.x, p.y, p.z}; }

/// Integral of ln |x - p| over p from b0 to b1.
inline long double logIntegral(const Long3& x, const Long3& b0, const Long3& b1) {
  const long double size = length(b1 - b0);
  const Long3 along = (1 / size) * (b1 - b0);
  const long double u0 = dot(b0 - x, along);
  const long double u1 = u0 + size;
  const long double h = length(cross(b0 - x, along));
  const auto term = [&](long double u) {
    const long double r2 = u * u + h * h;
    return r2 > 0 ? u * (std::log(r2) / 2 - 1) : 0.0L;
  };
  return term(u1) - term(u0) + h * std::atan2(h * size, h * h + u0 * u1);
}

/// The same integrated over x from a0 to a1.
inline long double logIntegral(const Long3& a0, const Long3& a1, const Long3& b0, const Long3& b1) {
  const long double size = length(a1 - a0);
  const Long3 along = (1 / size) * (a1 - a0);
  const Long3 other = b1 - b0;
  std::vector<long double> splits = {0, size};
  const auto split = [&](long double s) {
    if (s > 0 && s < size) splits.push_back(s);
  };
  split(dot(b0 - a0, along));
  split(dot(b1 - a0, along));
  const Long3 normal = cross(along, other);
  if (dot(normal, normal) > 0) split(dot(cross(b0 - a0, other), normal) / dot(normal, normal));
  std::sort(splits.begin(), splits.end());
  constexpr long double kStep = 1.0L / 16;
  constexpr long double kHalfPi = 1.57079632679489661923132169163975144L;
  long double sum = 0;
  for (std::size_t k = 0; k + 1 < splits.size(); ++k) {
    const long double low = splits[k], high = splits[k + 1], span = high - low;
    if (!(span > 0)) continue;
    for (int j = -60; j <= 60; ++j) {
      const long double t = j * kStep;
      const long double e = kHalfPi * std::sinh(t);
      const long double gap = span / (1 + std::exp(2 * std::abs(e)));
      const long double weight = kStep * kHalfPi * std::cosh(t) / (std::cosh(e) * std::cosh(e));
      const Long3 x = e < 0 ? (a0 + low * along) + gap * along : (a0 + high * along) - gap * along;
      sum += weight * span / 2 * logIntegral(x, b0, b1);
    }
  }
  return sum;
}

/// G of two loops, counter-clockwise each, neither crossing the other's plane. Error about 1e-18
/// times the larger's size squared.
inline double referenceExchange(std::span<const Vec3> a, std::span<const Vec3> b) {
  long double sum = 0;
  for (std::size_t i = 0, before = a.size() - 1; i < a.size(); before = i++) {
    for (std::size_t j = 0, last = b.size() - 1; j < b.size(); last = j++) {
      const Long3 a0 = toLong(a[before]), a1 = toLong(a[i]);
      const Long3 b0 = toLong(b[last]), b1 = toLong(b[j]);
      const long double lengths = length(a1 - a0) * length(b1 - b0);
      const long double cosine = dot(a1 - a0, b1 - b0);
      if (!(lengths > 0) || std::abs(cosine) < 1e-19L * lengths) continue;
      sum += cosine / lengths * logIntegral(a0, a1, b0, b1);
    }
  }
  return double(sum / (2 * 3.14159265358979323846264338327950288L));
}

}  // namespace radiosity::test
