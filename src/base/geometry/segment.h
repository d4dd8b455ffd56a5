// Points and straight segments, in two or three dimensions.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {

/// The point of segment ab that is nearest to p; a if the segment has no length.
template <class Point>
Point nearestOnSegment(const Point& p, const Point& a, const Point& b) {
  const Point along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return a + t * along;
}

template <class Point>
double distanceToSegment(const Point& p, const Point& a, const Point& b) {
  return glm::distance(p, nearestOnSegment(p, a, b));
}

template <class Point>
double squaredDistanceToSegment(const Point& p, const Point& a, const Point& b) {
  const Point away = p - nearestOnSegment(p, a, b);
  return glm::dot(away, away);
}

}  // namespace radiosity
