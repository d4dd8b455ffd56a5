// The solid angle of triangles and polygons.
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/base.h"

namespace radiosity {

/// A complex number whose argument is half of a solid angle.
struct HalfAngle {
  double real = 1;
  double imaginary = 0;
};

/// Half of the signedSolidAngle() of a triangle (van Oosterom & Strackee, "The solid angle of a
/// plane triangle", IEEE Trans. Biomed. Eng. 30, 1983).
inline HalfAngle halfSolidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = glm::length(a);
  const double lb = glm::length(b);
  const double lc = glm::length(c);
  return {la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb,
          glm::dot(a, glm::cross(b, c))};
}

/// Seen from the origin, sr; > 0 where the corners run clockwise to the eye, that is, where it
/// looks at the triangle's back. Exact to rounding. Triangles of a closed surface that faces
/// outwards sum to 4 pi about a point inside, to 0 about one outside.
inline double signedSolidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const HalfAngle half = halfSolidAngle(a, b, c);
  return 2 * std::atan2(half.imaginary, half.real);
}

/// Sums solid angles with a single arctangent, which would take most of the time: arguments add
/// where complex numbers multiply, and full turns are counted.
class SolidAngleSum {
 public:
  void add(const HalfAngle& half) {
    const double real = sum_.real * half.real - sum_.imaginary * half.imaginary;
    double imaginary = sum_.real * half.imaginary + sum_.imaginary * half.real;
    const double size = std::abs(real) + std::abs(imaginary);
    if (size == 0) return;  // seen from a corner
    // As for atan2(), a zero has a sign: on a triangle its half angle is pi or -pi.
    const bool down = std::signbit(half.imaginary);
    if (std::signbit(sum_.imaginary) == down) {  // together up to a full turn, one way
      const bool both_left = sum_.real < 0 && half.real < 0;
      if (imaginary == 0) {
        if (both_left) turns_ += down ? -1 : 1;
        imaginary = down ? -0.0 : 0.0;
      } else if (std::signbit(imaginary) != down) {
        turns_ += down ? -1 : 1;
      }
    }
    sum_ = {real / size, imaginary / size};
  }

  /// sr.
  double value() const {
    return 2 * (2 * std::numbers::pi * turns_ + std::atan2(sum_.imaginary, sum_.real));
  }

 private:
  HalfAngle sum_;
  int turns_ = 0;
};

/// The same of a planar polygon with the corners point(0) .. point(count - 1), over a fan: parts of
/// the fan outside a concave polygon cancel.
template <class PointAt>
double loopSolidAngle(std::size_t count, const PointAt& point, const Vec3& eye) {
  double angle = 0;
  const Vec3 a = point(0) - eye;
  for (std::size_t k = 1; k + 1 < count; ++k) {
    angle += signedSolidAngle(a, point(k) - eye, point(k + 1) - eye);
  }
  return angle;
}

}  // namespace radiosity
