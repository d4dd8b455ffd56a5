#include "scene/radiance/facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/geometry/plane_frame.h"

namespace radiosity {

namespace {

constexpr double kPi = std::numbers::pi;

/// Two directions across an axis, unit. Those of an axis and of its opposite differ in the sign of
/// one alone, and rounding does not change them much.
std::array<Vec3, 2> across(const Vec3& axis) {
  constexpr double kAlong = 0.618;  // no direction that people give lies on this border
  Vec3 other(0, 0, 1);
  if (std::abs(axis.x) < kAlong) {
    other = Vec3(1, 0, 0);
  } else if (std::abs(axis.y) < kAlong) {
    other = Vec3(0, 1, 0);
  }
  const PlaneFrame frame = makeFrame(Vec3(0.0), axis, other);
  return {frame.u, frame.v};
}

/// A circle as a polygon of its area. Sides are a multiple of four, so that both sides of its plane
/// see the same corners.
struct Circle {
  std::size_t sides = 8;
  double corner = 1;  ///< how far corners are from the middle, over the radius

  explicit Circle(double tolerance) {
    for (;; sides += 4) {
      const double angle = 2 * kPi / double(sides);
      corner = std::sqrt(angle / std::sin(angle));
      if (corner - 1 <= tolerance) return;
    }
  }
  double half() const { return kPi / double(sides); }  ///< the angle of half a side
};

/// A sphere of radius 1 in twice as many meridians as parallels, enlarged to its area.
struct Ball {
  std::size_t sides = 8;
  double corner = 1;
  double off = 0;

  explicit Ball(double tolerance) {
    for (;; sides += 4) {
      measure();
      if (off <= tolerance) return;
    }
  }

  /// Latitude of a parallel, from the south pole.
  double latitude(std::size_t k) const { return kPi * (double(k) / double(bands()) - 0.5); }
  std::size_t bands() const { return sides / 2; }

 private:
  /// A facet is a trapezoid between two parallels: seen along its level sides it is a line.
  void measure() {
    const double half = kPi / double(sides);
    double area = 0;
    double nearest = 1;
    for (std::size_t k = 0; k < bands(); ++k) {
      const double low = latitude(k);
      const double high = latitude(k + 1);
      const double x0 = std::cos(low) * std::cos(half);
      const double x1 = std::cos(high) * std::cos(half);
      const double slant = std::hypot(x1 - x0, std::sin(high) - std::sin(low));
      area += double(sides) * std::sin(half) * (std::cos(low) + std::cos(high)) * slant;
      nearest = std::min(nearest, std::abs(x0 * std::sin(high) - x1 * std::sin(low)) / slant);
    }
    corner = std::sqrt(4 * kPi / area);
    off = std::max(corner - 1, 1 - corner * nearest);
  }
};

/// Adds the corners of a circle; a radius of 0 is one corner for all.
std::vector<Index> addCircle(Facets& facets, const Circle& circle, const Vec3& centre,
                             const std::array<Vec3, 2>& plane, double radius) {
  std::vector<Index> corners;
  for (std::size_t k = 0; k < circle.sides; ++k) {
    if (radius > 0 || k == 0) {
      const double angle = 2 * kPi * double(k) / double(circle.sides);
      facets.vertices.push_back(centre +
                                circle.corner * radius *
                                    (std::cos(angle) * plane[0] + std::sin(angle) * plane[1]));
    }
    corners.push_back(Index(facets.vertices.size() - 1));
  }
  return corners;
}

/// Faces between two circles, `low` before `high` along the axis, facing away from it. Where a
/// circle is a point, they are triangles.
void joinCircles(Facets& facets, const std::vector<Index>& low, const std::vector<Index>& high) {
  for (std::size_t k = 0; k < low.size(); ++k) {
    const std::size_t next = (k + 1) % low.size();
    std::vector<Index> face = {low[k], low[next], high[next], high[k]};
    face.erase(std::unique(face.begin(), face.end()), face.end());
    facets.faces.push_back(std::move(face));
  }
}

}  // namespace

void Facets::turnOver() {
  for (std::vector<Index>& face : faces) std::reverse(face.begin(), face.end());
}

Facets sphereFacets(const Vec3& centre, double radius, double tolerance) {
  const Ball ball(tolerance);
  Facets facets;
  facets.off = ball.off;
  Circle circle(1);
  circle.sides = ball.sides;
  circle.corner = ball.corner;
  const std::array<Vec3, 2> plane = {Vec3(1, 0, 0), Vec3(0, 1, 0)};
  std::vector<Index> low;
  for (std::size_t k = 0; k <= ball.bands(); ++k) {
    const bool pole = k == 0 || k == ball.bands();
    const double latitude = ball.latitude(k);
    const Vec3 middle = centre + Vec3(0, 0, ball.corner * radius * std::sin(latitude));
    const std::vector<Index> high =
        addCircle(facets, circle, middle, plane, pole ? 0.0 : radius * std::cos(latitude));
    if (k > 0) joinCircles(facets, low, high);
    low = high;
  }
  return facets;
}

Facets coneFacets(const Vec3& a, double radius_a, const Vec3& b, double radius_b,
                  double tolerance) {
  const Circle circle(tolerance);
  const std::array<Vec3, 2> plane = across(glm::normalize(b - a));
  Facets facets;
  facets.off = circle.corner - 1;
  const std::vector<Index> low = addCircle(facets, circle, a, plane, radius_a);
  const std::vector<Index> high = addCircle(facets, circle, b, plane, radius_b);
  joinCircles(facets, low, high);
  // Both areas are half the sum of two circumferences times a slant height.
  const double length = glm::length(b - a);
  const double narrowed = radius_b - radius_a;
  const double inward = circle.corner * std::cos(circle.half());
  facets.area = circle.corner * std::sin(circle.half()) / circle.half() *
                std::hypot(length, inward * narrowed) / std::hypot(length, narrowed);
  return facets;
}

Facets ringFacets(const Vec3& centre, const Vec3& normal, double inner, double outer,
                  double tolerance) {
  const Circle circle(tolerance);
  const std::array<Vec3, 2> plane = across(normal);
  Facets facets;
  facets.off = circle.corner - 1;
  const std::vector<Index> border = addCircle(facets, circle, centre, plane, outer);
  if (inner > 0) {
    joinCircles(facets, border, addCircle(facets, circle, centre, plane, inner));
  } else {
    facets.faces.push_back(border);
  }
  return facets;
}

}  // namespace radiosity
