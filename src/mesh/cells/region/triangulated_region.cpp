#include "mesh/cells/region/triangulated_region.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/geometry/plane_frame.h"

namespace radiosity {

TriangulatedRegion::TriangulatedRegion(const Region& region) : region_(region) {
  for (const auto& loop : region.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      outline_.insert(edgeKey(loop[k], loop[(k + 1) % loop.size()]));
    }
  }
  interior_ = backgroundGrid(region);
}

bool TriangulatedRegion::isPlainTriangle() const {
  if (region_.points.size() != 3 || region_.loops.size() != 1 || !region_.inner.empty() ||
      !std::ranges::equal(region_.loops[0], std::array<Index, 3>{0, 1, 2}) || !interior_.empty() ||
      std::isfinite(region_.longest)) {
    return false;
  }
  const auto& p = region_.points;
  // The order of corners matters to the bit: rounding may turn a sliver over in one order and not
  // in another.
  return CGAL::orientation(pointOf(p[0]), pointOf(p[1]), pointOf(p[2])) == CGAL::LEFT_TURN &&
         cross2(p[1] - p[0], p[2] - p[0]) > 0 && cross2(p[2] - p[1], p[0] - p[1]) > 0 &&
         cross2(p[0] - p[2], p[1] - p[2]) > 0;
}

/// False if two pieces cross.
bool TriangulatedRegion::insertPieces(const std::vector<RegionVertex>& vertices) {
  try {
    for (const auto& loop : region_.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        cdt_.insert_constraint(vertices[loop[k]], vertices[loop[(k + 1) % loop.size()]]);
      }
    }
    for (const auto& [from, to] : region_.inner) {
      cdt_.insert_constraint(vertices[from], vertices[to]);
    }
  } catch (const RegionTriangulation::Intersection_of_constraints_exception&) {
    return false;
  }
  return true;
}

bool TriangulatedRegion::triangulate() {
  cdt_.clear();
  const auto add = [&](const Vec2& p, std::size_t id, RegionFace hint) {
    const RegionVertex v = cdt_.insert(pointOf(p), hint);
    v->info() = Index(id);
    return v;
  };
  // We insert every second of the points between those already in, repeatedly. Points in a row,
  // inserted one after the other, would make each insertion flip all edges of the row so far.
  const std::size_t count = region_.points.size();
  std::vector<RegionVertex> vertices(count);
  vertices[0] = add(region_.points[0], 0, RegionFace());
  for (std::size_t stride = std::bit_ceil(count); stride > 0; stride /= 2) {
    for (std::size_t k = stride; k < count; k += 2 * stride) {
      vertices[k] = add(region_.points[k], k, vertices[k - stride]->face());
    }
  }
  if (!insertPieces(vertices)) return false;
  RegionFace hint;
  for (std::size_t k = 0; k < interior_.size(); ++k) {
    hint = add(interior_[k], count + k, hint)->face();
  }
  markInside();
  return true;
}

/// Marks the faces that are reached from the left of the loops' pieces without crossing any piece.
void TriangulatedRegion::markInside() {
  for (RegionFace f : cdt_.all_face_handles()) f->info() = false;
  std::vector<RegionFace> stack;
  const auto visit = [&](RegionFace f) {
    if (f->info() || cdt_.is_infinite(f)) return;
    f->info() = true;
    stack.push_back(f);
  };
  std::unordered_set<std::uint64_t> directed;
  for (const auto& loop : region_.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      directed.insert(directedKey(loop[k], loop[(k + 1) % loop.size()]));
    }
  }
  for (RegionFace f : cdt_.finite_face_handles()) {
    for (int i = 0; i < 3; ++i) {
      const Index from = f->vertex(RegionTriangulation::ccw(i))->info();
      const Index to = f->vertex(RegionTriangulation::cw(i))->info();
      if (directed.count(directedKey(from, to)) > 0) visit(f);
    }
  }
  while (!stack.empty()) {
    const RegionFace f = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      if (!isOutline(f, i)) visit(f->neighbor(i));
    }
  }
}

bool TriangulatedRegion::tiles() const {
  long double area = 0;
  double terms = 0;
  const Vec2 base = region_.points[0];
  const auto add = [&](const Vec2& a, const Vec2& b, double sign) {
    area += sign * 0.5 * cross2(a, b);
    terms += std::abs(a.x * b.y) + std::abs(a.y * b.x);
  };
  for (const auto& loop : region_.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec2& next = region_.points[loop[(k + 1) % loop.size()]];
      add(region_.points[loop[k]] - base, next - base, 1.0);
    }
  }
  for (RegionFace f : cdt_.finite_face_handles()) {
    if (!f->info()) continue;
    const Vec2 a = positionOf(f->vertex(0));
    add(positionOf(f->vertex(1)) - a, positionOf(f->vertex(2)) - a, -1.0);
  }
  // Products and their coordinates are rounded a few times each. A triangle that is turned over or
  // there twice makes a far larger difference.
  return std::abs(double(area)) <= 0x1p-46 * terms;
}

RegionVertex TriangulatedRegion::insert(const RegionTriangulation::Point& p, RegionFace where) {
  const RegionVertex v = cdt_.insert(p, where);
  v->info() = Index(region_.points.size() + interior_.size());
  interior_.emplace_back(p.x(), p.y());
  RegionTriangulation::Face_circulator f = cdt_.incident_faces(v);
  const RegionTriangulation::Face_circulator end = f;
  do {
    f->info() = true;  // the conflict zone never crosses a constraint
  } while (++f != end);
  return v;
}

void TriangulatedRegion::takePositions() {
  for (RegionVertex v : cdt_.finite_vertex_handles()) {
    if (isFree(v)) interior_[v->info() - region_.points.size()] = positionOf(v);
  }
}

std::vector<std::array<Index, 3>> TriangulatedRegion::triangles() const {
  std::vector<std::array<Index, 3>> result;
  for (RegionFace f : cdt_.finite_face_handles()) {
    if (f->info()) {
      result.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
    }
  }
  return result;
}

}  // namespace radiosity
