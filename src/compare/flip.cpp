#include "compare/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "base/luminance.h"
#include "base/parallel.h"

namespace radiosity {
namespace {

using std::numbers::pi;

// Equations and sections are those of the paper of 2020.
constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * (pi / 180);
constexpr double kColourExponent = 0.7;    // q_c
constexpr double kSmallDifferences = 0.4;  // p_c: of the largest
constexpr double kSmallTake = 0.95;        // p_t: of the range
constexpr double kFeatureWidth = 0.082;    // w, degrees
constexpr double kFeatureExponent = 0.5;   // q_f

/// Linear Rec. 709 -> XYZ, of IEC 61966-2-1's primaries and white, D65.
Vec3 xyzOf(const Vec3& c) {
  return {10135552.0 / 24577794 * c.x + 8788810.0 / 24577794 * c.y + 4435075.0 / 24577794 * c.z,
          2613072.0 / 12288897 * c.x + 8788810.0 / 12288897 * c.y + 887015.0 / 12288897 * c.z,
          1425312.0 / 73733382 * c.x + 8788810.0 / 73733382 * c.y + 70074185.0 / 73733382 * c.z};
}

Vec3 rgbOf(const Vec3& c) {
  static const glm::dmat3 kBack =
      glm::inverse(glm::dmat3(xyzOf({1, 0, 0}), xyzOf({0, 1, 0}), xyzOf({0, 0, 1})));
  return kBack * c;
}

Vec3 whiteOf(const Vec3& xyz) { return xyz / xyzOf(Vec3(1.0)); }

/// The opponent space in which contrast is filtered: Y, C_x, C_z (4.1.1).
Vec3 opponentOf(const Vec3& rgb) {
  const Vec3 c = whiteOf(xyzOf(rgb));
  return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

Vec3 rgbOfOpponent(const Vec3& c) {
  const double y = (c.x + 16) / 116;
  return rgbOf(Vec3(y + c.y / 500, y, y - c.z / 200) * xyzOf(Vec3(1.0)));
}

/// CIELAB, with a and b as at the lightness (Hunt; 4.1.2).
Vec3 huntOf(const Vec3& rgb) {
  const Vec3 c = whiteOf(xyzOf(rgb));
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const double lightness = 116 * f(c.y) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(c.x) - f(c.y)),
          0.01 * lightness * 200 * (f(c.y) - f(c.z))};
}

/// HyAB, M. Abasi et al. 2020 (4.1.3).
double hyab(const Vec3& a, const Vec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Differences of large colours pressed together: 0 to 1 (4.1.3).
double redistributed(double difference) {
  static const double kLargest =
      std::pow(hyab(huntOf({0, 1, 0}), huntOf({0, 0, 1})), kColourExponent);
  const double power = std::pow(difference, kColourExponent);
  const double knee = kSmallDifferences * kLargest;
  if (power < knee) return kSmallTake / knee * power;
  return kSmallTake + (power - knee) / (kLargest - knee) * (1 - kSmallTake);
}

/// A contrast sensitivity as a sum of two Gaussians (table 1): a_1, b_1, a_2, b_2.
struct Sensitivity {
  std::array<double, 2> a;
  std::array<double, 2> b;
};
constexpr std::array<Sensitivity, 3> kSensitivities = {
    {{{1, 0}, {0.0047, 1e-5}}, {{1, 0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}}};

Plane filtered(const Plane& plane, const Sensitivity& s) {
  // Three sigma of the widest.
  const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * kPixelsPerDegree));
  Plane sum{plane.width, plane.height, std::vector<double>(plane.values.size())};
  double total = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    if (s.a[k] == 0) continue;
    const Kernel g = kernelOf(radius, [&](int x) {
      const double degrees = x / kPixelsPerDegree;
      return std::exp(-pi * pi * degrees * degrees / s.b[k]);
    });
    const double weight = s.a[k] * std::sqrt(pi / s.b[k]);
    double along = 0;
    for (const double value : g) along += value;
    total += weight * along * along;
    const Plane part = convolved(plane, g, g);
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += weight * part.values[i];
  }
  for (double& value : sum.values) value /= total;
  return sum;
}

/// The channels of a picture in the opponent space.
std::array<Plane, 3> opponentPlanes(const ColourPlane& picture) {
  std::array<Plane, 3> planes;
  planes.fill({picture.width, picture.height, std::vector<double>(picture.pixels.size())});
  for (std::size_t k = 0; k < picture.pixels.size(); ++k) {
    const Vec3 c = opponentOf(glm::clamp(picture.pixels[k], 0.0, 1.0));
    for (int i = 0; i < 3; ++i) planes[std::size_t(i)].values[k] = c[i];
  }
  return planes;
}

/// What is left of a picture at this distance, ready for HyAB.
std::vector<Vec3> perceived(const std::array<Plane, 3>& opponent) {
  std::array<Plane, 3> planes;
  for (std::size_t i = 0; i < 3; ++i) planes[i] = filtered(opponent[i], kSensitivities[i]);
  std::vector<Vec3> colours(planes[0].values.size());
  parallelFor(colours.size(), 1024, [&](std::size_t k) {
    const Vec3 c(planes[0].values[k], planes[1].values[k], planes[2].values[k]);
    colours[k] = huntOf(glm::clamp(rgbOfOpponent(c), 0.0, 1.0));
  });
  return colours;
}

/// Weights above 0 and those below are made to sum to 1 and -1 (4.2.1).
Kernel balanced(Kernel kernel) {
  double above = 0;
  double below = 0;
  for (const double w : kernel) (w > 0 ? above : below) += std::abs(w);
  for (double& w : kernel) w /= w > 0 ? above : below;
  return kernel;
}

/// Strengths of edges and of points, a pixel each (4.2.1).
struct Features {
  std::vector<double> edges;
  std::vector<double> points;
};

Features featuresOf(const Plane& opponent_y) {
  Plane grey = opponent_y;
  for (double& value : grey.values) value = (value + 16) / 116;
  const double sigma = 0.5 * kFeatureWidth * kPixelsPerDegree;
  const int radius = int(std::ceil(3 * sigma));
  const Kernel plain = gaussianKernel(radius, sigma);
  Kernel smooth = plain;
  double total = 0;
  for (const double w : smooth) total += w;
  for (double& w : smooth) w /= total;
  const auto times = [&](const std::function<double(int)>& factor) {
    return balanced(kernelOf(
        radius, [&](int x) { return factor(x) * plain[std::size_t(x) + std::size_t(radius)]; }));
  };
  const Kernel edge = times([](int x) { return -double(x); });
  const Kernel point = times([&](int x) { return double(x * x) / (sigma * sigma) - 1; });
  const auto strength = [&](const Kernel& kernel) {
    const Plane x = convolved(grey, kernel, smooth);
    const Plane y = convolved(grey, smooth, kernel);
    std::vector<double> lengths(x.values.size());
    for (std::size_t k = 0; k < lengths.size(); ++k)
      lengths[k] = std::hypot(x.values[k], y.values[k]);
    return lengths;
  };
  return {strength(edge), strength(point)};
}

/// The exposures of the paper of 2021, EV: the first makes the brightest pixel as bright as the
/// curve's .85, the last the median. None of a picture without light.
std::vector<double> exposuresOf(const ColourPlane& reference) {
  std::vector<double> bright;
  for (const Vec3& c : reference.pixels) {
    const double y = luminanceOf(c);
    if (y > 0 && std::isfinite(y)) bright.push_back(y);
  }
  if (bright.empty()) return {0};
  // The paper's: where (2.51 x^2 + .03 x) / (2.43 x^2 + .59 x + .14) is .85, with .6 x for x.
  constexpr double kTarget = 0.85;
  constexpr double kSquare = 0.36 * (2.51 - kTarget * 2.43);
  constexpr double kLinear = 0.6 * (0.03 - kTarget * 0.59);
  constexpr double kConstant = -kTarget * 0.14;
  const double x =
      (-kLinear + std::sqrt(kLinear * kLinear - 4 * kSquare * kConstant)) / (2 * kSquare);
  const auto middle = bright.begin() + std::ptrdiff_t(bright.size() / 2);
  std::nth_element(bright.begin(), middle, bright.end());
  const double first = std::log2(x / *std::max_element(bright.begin(), bright.end()));
  const double last = std::log2(x / *middle);
  const int count = std::max(2, int(std::ceil(last - first)));
  std::vector<double> stops;
  stops.reserve(std::size_t(count));
  for (int k = 0; k < count; ++k) stops.push_back(first + (last - first) * k / (count - 1));
  return stops;
}

ColourPlane shown(const ColourPlane& light, double stops) {
  ColourPlane picture = light;
  for (Vec3& c : picture.pixels) {
    const Vec3 x = 0.6 * std::exp2(stops) * c;
    c = glm::clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  }
  return picture;
}

}  // namespace

Plane flipOfShown(const ColourPlane& a, const ColourPlane& b) {
  const std::array<Plane, 3> opponent_a = opponentPlanes(a);
  const std::array<Plane, 3> opponent_b = opponentPlanes(b);
  const std::vector<Vec3> colours_a = perceived(opponent_a);
  const std::vector<Vec3> colours_b = perceived(opponent_b);
  const Features of_a = featuresOf(opponent_a[0]);
  const Features of_b = featuresOf(opponent_b[0]);
  Plane flip{a.width, a.height, std::vector<double>(colours_a.size())};
  for (std::size_t k = 0; k < flip.values.size(); ++k) {
    const double colour = redistributed(hyab(colours_a[k], colours_b[k]));
    const double feature = std::max(std::abs(of_a.edges[k] - of_b.edges[k]),
                                    std::abs(of_a.points[k] - of_b.points[k]));
    const double features = std::pow(feature / std::numbers::sqrt2, kFeatureExponent);
    flip.values[k] = std::pow(colour, 1 - std::min(features, 1.0));
  }
  return flip;
}

Plane flipOfLight(const ColourPlane& a, const ColourPlane& b) {
  Plane worst{a.width, a.height, std::vector<double>(a.pixels.size())};
  for (const double stops : exposuresOf(a)) {
    const Plane flip = flipOfShown(shown(a, stops), shown(b, stops));
    for (std::size_t k = 0; k < worst.values.size(); ++k) {
      worst.values[k] = std::max(worst.values[k], flip.values[k]);
    }
  }
  return worst;
}

}  // namespace radiosity
