#include "formfactor/exact/occluders/triangles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

#include "base/geometry/plane_frame.h"
#include "mesh/face_locator.h"

namespace radiosity {
namespace {

struct Corner {
  Vec2 at;
  Index vertex;
};
using Loop = std::vector<Corner>;

double signedArea(const Loop& loop) {
  double twice = 0;
  for (std::size_t k = 2; k < loop.size(); ++k) {
    twice += cross2(loop[k - 1].at - loop[0].at, loop[k].at - loop[0].at);
  }
  return 0.5 * twice;
}

int side(const Vec2& a, const Vec2& b, const Vec2& p) {
  const double turn = cross2(b - a, p - a);
  return turn > 0 ? 1 : (turn < 0 ? -1 : 0);
}

/// True if p lies on the segment a b, ends excluded; the three are in line.
bool between(const Vec2& a, const Vec2& b, const Vec2& p) {
  return glm::dot(p - a, b - a) > 0 && glm::dot(p - b, a - b) > 0;
}

/// True if the bridge a b crosses the edge c d, or one runs through an end of the other. Common
/// ends are no crossing.
bool crosses(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int sc = side(a, b, c);
  const int sd = side(a, b, d);
  const int sa = side(c, d, a);
  const int sb = side(c, d, b);
  if (sc * sd < 0 && sa * sb < 0) return true;
  return (sc == 0 && between(a, b, c)) || (sd == 0 && between(a, b, d)) ||
         (sa == 0 && between(c, d, a)) || (sb == 0 && between(c, d, b));
}

bool isClear(const Vec2& a, const Vec2& b, const std::vector<Loop>& loops) {
  for (const Loop& loop : loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if (crosses(a, b, loop[k].at, loop[(k + 1) % loop.size()].at)) return false;
    }
  }
  return true;
}

/// True if the direction to `to` lies inside the outline at corner k.
bool pointsInside(const Loop& loop, std::size_t k, const Vec2& to) {
  const Vec2& a = loop[(k + loop.size() - 1) % loop.size()].at;
  const Vec2& b = loop[k].at;
  const Vec2& c = loop[(k + 1) % loop.size()].at;
  const bool left_of_in = cross2(b - a, to - b) > 0;
  const bool left_of_out = cross2(c - b, to - b) > 0;
  return cross2(b - a, c - b) >= 0 ? left_of_in && left_of_out : left_of_in || left_of_out;
}

/// Joins the loop nearest to `outline` to it by the shortest free bridge. False if there is none.
bool bridge(Loop& outline, std::vector<Loop>& holes) {
  std::vector<std::tuple<double, std::size_t, std::size_t, std::size_t>> ways;
  for (std::size_t h = 0; h < holes.size(); ++h) {
    for (std::size_t j = 0; j < holes[h].size(); ++j) {
      for (std::size_t k = 0; k < outline.size(); ++k) {
        ways.emplace_back(glm::distance(outline[k].at, holes[h][j].at), h, j, k);
      }
    }
  }
  std::sort(ways.begin(), ways.end());
  std::vector<Loop> all = holes;
  all.push_back(outline);
  for (const auto& [length, h, j, k] : ways) {
    const Vec2& a = outline[k].at;
    const Vec2& b = holes[h][j].at;
    const bool touching = length == 0;
    if (!touching &&
        !(pointsInside(outline, k, b) && pointsInside(holes[h], j, a) && isClear(a, b, all))) {
      continue;
    }
    Loop joined(outline.begin(), outline.begin() + std::ptrdiff_t(k) + 1);
    for (std::size_t m = 0; m < holes[h].size(); ++m) {
      joined.push_back(holes[h][(j + m) % holes[h].size()]);
    }
    if (!touching) {
      joined.push_back(holes[h][j]);
      joined.push_back(outline[k]);
    } else {
      joined.push_back(outline[k]);
      joined.erase(joined.begin() + std::ptrdiff_t(k) + 1);
    }
    joined.insert(joined.end(), outline.begin() + std::ptrdiff_t(k) + 1, outline.end());
    outline = std::move(joined);
    holes.erase(holes.begin() + std::ptrdiff_t(h));
    return true;
  }
  return false;
}

bool contains(const Loop& loop, const Vec2& p) {
  bool inside = false;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& a = loop[k].at;
    const Vec2& b = loop[(k + 1) % loop.size()].at;
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y))) {
      inside = !inside;
    }
  }
  return inside;
}

/// True if most corners of the hole are inside the outer loop: corners may touch it.
bool isHoleOf(const Loop& hole, const Loop& outer) {
  Vec2 mean(0.0);
  for (const Corner& c : hole) mean += c.at / double(hole.size());
  std::size_t votes = contains(outer, mean) ? 1 : 0;
  for (const Corner& c : hole) votes += contains(outer, 0.5 * (c.at + mean)) ? 1 : 0;
  return 2 * votes > hole.size() + 1;
}

}  // namespace

std::vector<std::array<Index, 3>> trianglesOf(const OccluderPolygons& all,
                                              const OccluderPolygon& polygon) {
  std::size_t corners = 0;
  for (const std::vector<Index>& loop : polygon.loops) corners += loop.size();
  if (corners > kMostBridged) return {};
  const PlaneFrame frame =
      makeFrame(all.vertices[polygon.loops[0][0]], polygon.normal, axisAcross(polygon.normal));
  std::vector<Loop> outer;
  std::vector<Loop> holes;
  double whole = 0;
  for (const std::vector<Index>& loop : polygon.loops) {
    Loop flat;
    for (const Index v : loop) flat.push_back({frame.flat(all.vertices[v]), v});
    const double area = signedArea(flat);
    whole += area;
    (area > 0 ? outer : holes).push_back(std::move(flat));
  }
  std::vector<std::array<Index, 3>> triangles;
  double covered = 0;
  for (Loop& outline : outer) {
    std::vector<Loop> own;
    for (const Loop& hole : holes) {
      if (isHoleOf(hole, outline)) own.push_back(hole);
    }
    while (!own.empty()) {
      if (!bridge(outline, own)) return {};
    }
    std::vector<Vec2> flat;
    for (const Corner& c : outline) flat.push_back(c.at);
    for (const auto& t : triangulateOutline(flat)) {
      const double area = 0.5 * cross2(flat[t[1]] - flat[t[0]], flat[t[2]] - flat[t[0]]);
      if (area == 0) continue;
      covered += std::abs(area);
      triangles.push_back({outline[t[0]].vertex, outline[t[1]].vertex, outline[t[2]].vertex});
    }
  }
  // Triangles that overlap or leave the polygon add up to more than it has.
  const double error = std::abs(covered - whole);
  const double length = glm::distance(polygon.box.low, polygon.box.high);
  if (error > all.coincidence * length) triangles.clear();
  return triangles;
}

}  // namespace radiosity
