#include <numeric>

#include "mesh/face_locator.h"

namespace radiosity {

namespace {

double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return cross2(b - a, c - a); }

/// Whether the corner `k` of the remaining outline can be cut off: convex, and no other corner
/// inside or on the triangle (repeats of its own corners do not count).
bool isEar(std::span<const Vec2> p, const std::vector<Index>& rest, std::size_t k, double sign) {
  const std::size_t n = rest.size();
  const Vec2& a = p[rest[(k + n - 1) % n]];
  const Vec2& b = p[rest[k]];
  const Vec2& c = p[rest[(k + 1) % n]];
  if (!(sign * turn(a, b, c) > 0)) return false;
  for (const Index i : rest) {
    const Vec2& q = p[i];
    if (q == a || q == b || q == c) continue;
    if (sign * turn(a, b, q) >= 0 && sign * turn(b, c, q) >= 0 && sign * turn(c, a, q) >= 0) {
      return false;
    }
  }
  return true;
}

/// Whether the corner `k` lies in line with its neighbours: cutting it off takes no area away.
bool isFlat(std::span<const Vec2> p, const std::vector<Index>& rest, std::size_t k) {
  const std::size_t n = rest.size();
  return turn(p[rest[(k + n - 1) % n]], p[rest[k]], p[rest[(k + 1) % n]]) == 0;
}

}  // namespace

std::vector<std::array<Index, 3>> triangulateOutline(std::span<const Vec2> outline) {
  std::vector<std::array<Index, 3>> triangles;
  if (outline.size() < 3) return triangles;
  double area = 0;
  for (std::size_t k = 2; k < outline.size(); ++k) {
    area += turn(outline[0], outline[k - 1], outline[k]);
  }
  const double sign = area < 0 ? -1.0 : 1.0;
  std::vector<Index> rest(outline.size());
  std::iota(rest.begin(), rest.end(), 0u);
  std::size_t k = 0;
  while (rest.size() > 3) {
    const std::size_t n = rest.size();
    std::size_t ear = n;
    for (std::size_t tried = 0; tried < n && ear == n; ++tried) {
      if (isEar(outline, rest, (k + tried) % n, sign)) ear = (k + tried) % n;
    }
    for (std::size_t flat = 0; flat < n && ear == n; ++flat) {
      if (isFlat(outline, rest, flat)) ear = flat;
    }
    if (ear == n) ear = 0;  // the outline crosses itself: any triangle is as good as another
    triangles.push_back({rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]});
    rest.erase(rest.begin() + std::ptrdiff_t(ear));
    k = ear < rest.size() ? ear : 0;
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

}  // namespace radiosity
