// Meshes a region: refines and smooths triangles by turns, then joins them in pairs.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "mesh/cells/region/refine_region.h"
#include "mesh/cells/region/region.h"
#include "mesh/cells/region/region_angles.h"
#include "mesh/cells/region/smooth_region.h"
#include "mesh/cells/region/triangulated_region.h"

namespace radiosity {

namespace {

constexpr int kRounds = 4;  // refine, smooth, triangulate anew

class RegionMesher {
 public:
  explicit RegionMesher(const Region& region) : region_(region), mesh_(region) {}

  std::optional<RegionMesh> run() {
    if (mesh_.isPlainTriangle()) return RegionMesh{{}, {{2, 0, 1, kNone}}};
    if (!mesh_.triangulate() || !mesh_.tiles()) return std::nullopt;
    if (region_.improve) improve();
    flipFlat();
    std::vector<Cell> cells = pairs();
    while (shorten(cells)) cells = pairs();
    return RegionMesh{mesh_.interior(), std::move(cells)};
  }

 private:
  void improve() {
    RegionRefiner refiner(mesh_);
    for (int round = 0; round < kRounds && worst().isBelow(kWantedAngle); ++round) {
      refiner.refine();
      smoothInside(mesh_);
      mesh_.takePositions();
      mesh_.triangulate();
    }
  }
  std::vector<Cell> pairs() const {
    return pairTriangles(region_, mesh_.interior(), mesh_.triangles());
  }
  WorstAngle worst() const;
  void flipFlat();
  bool isFlippable(RegionFace f, int i) const;
  bool shorten(const std::vector<Cell>& cells);
  double longestPiece() const;
  bool isClear(const Vec2& p, RegionFace near);

  const Region& region_;
  TriangulatedRegion mesh_;
};

/// The worst angle of the triangles inside.
WorstAngle RegionMesher::worst() const {
  WorstAngle out;
  for (RegionFace f : mesh_.cdt().finite_face_handles()) {
    if (f->info()) out.add(f);
  }
  return out;
}

/// Whether the two triangles at the edge opposite of corner i make a convex quadrilateral.
bool RegionMesher::isFlippable(RegionFace f, int i) const {
  const auto& apex = f->vertex(i)->point();
  const auto& from = f->vertex(RegionTriangulation::ccw(i))->point();
  const auto& to = f->vertex(RegionTriangulation::cw(i))->point();
  const auto& other = mesh_.cdt().mirror_vertex(f, i)->point();
  return CGAL::orientation(apex, from, other) == CGAL::LEFT_TURN &&
         CGAL::orientation(apex, other, to) == CGAL::LEFT_TURN;
}

/// Flips the longest edges of triangles flatter than a coincidence, so that the edge starts at the
/// opposite corner. The Delaunay triangulation makes such triangles where the boundary is nearly
/// straight.
void RegionMesher::flipFlat() {
  std::vector<RegionFace> stack;
  for (RegionFace f : mesh_.cdt().finite_face_handles()) {
    if (f->info()) stack.push_back(f);
  }
  // Every flip removes a flat triangle; if four points are nearly in line, it may come back.
  for (std::size_t left = 2 * stack.size(); !stack.empty() && left > 0;) {
    RegionFace f = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const Vec2 a = positionOf(f->vertex(RegionTriangulation::ccw(i)));
      const Vec2 b = positionOf(f->vertex(RegionTriangulation::cw(i)));
      if (f->is_constrained(i) ||
          heightOver(positionOf(f->vertex(i)), a, b) > 0.5 * region_.clearance ||
          !isFlippable(f, i)) {
        continue;
      }
      const RegionFace other = f->neighbor(i);
      mesh_.cdt().flip(f, i);
      --left;
      stack.push_back(f);
      stack.push_back(other);
      break;
    }
  }
}

double RegionMesher::longestPiece() const {
  double longest = 0;
  const auto measure = [&](Index a, Index b) {
    longest = std::max(longest, glm::length(region_.points[b] - region_.points[a]));
  };
  for (const auto& loop : region_.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) measure(loop[k], loop[(k + 1) % loop.size()]);
  }
  for (const auto& [from, to] : region_.inner) measure(from, to);
  return longest;
}

/// Whether a point would be farther than the clearance from the pieces around it.
bool RegionMesher::isClear(const Vec2& p, RegionFace near) {
  std::vector<RegionTriangulation::Edge> rim;
  const RegionFace where = mesh_.cdt().locate(pointOf(p), near);
  if (mesh_.cdt().is_infinite(where) || !where->info()) return false;
  mesh_.cdt().get_boundary_of_conflicts(pointOf(p), std::back_inserter(rim), where);
  return std::ranges::all_of(rim, [&](const RegionTriangulation::Edge& edge) {
    const auto& [f, i] = edge;
    return !f->is_constrained(i) ||
           heightOver(p, positionOf(f->vertex(RegionTriangulation::ccw(i))),
                      positionOf(f->vertex(RegionTriangulation::cw(i)))) > region_.clearance;
  });
}

/// Cuts inner edges of cells that are too long at their middle. False if there are none.
bool RegionMesher::shorten(const std::vector<Cell>& cells) {
  if (!std::isfinite(region_.longest)) return false;
  std::vector<RegionVertex> vertices(region_.points.size() + mesh_.interior().size());
  for (RegionVertex v : mesh_.cdt().finite_vertex_handles()) vertices[v->info()] = v;
  // Edges of this length but for rounding stay, and so do edges beside longer pieces (at corners
  // too sharp to be cut).
  const double limit = std::max(region_.longest * (1 + 1e-9), longestPiece());
  bool found = false;
  for (const Cell& cell : cells) {
    const std::size_t corners = cell[3] == kNone ? 3 : 4;
    for (std::size_t k = 0; k < corners; ++k) {
      const RegionVertex a = vertices[cell[k]];
      const RegionVertex b = vertices[cell[(k + 1) % corners]];
      RegionFace f;
      int i = 0;
      if (glm::length(positionOf(a) - positionOf(b)) <= limit) continue;
      if (!mesh_.cdt().is_edge(a, b, f, i) || f->is_constrained(i)) continue;
      const Vec2 middle = 0.5 * (positionOf(a) + positionOf(b));
      if (!isClear(middle, f)) continue;
      mesh_.insert(pointOf(middle), f);
      found = true;
    }
  }
  return found;
}

}  // namespace

std::optional<RegionMesh> meshRegion(const Region& region) { return RegionMesher(region).run(); }

}  // namespace radiosity
