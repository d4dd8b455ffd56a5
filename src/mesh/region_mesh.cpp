#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <unordered_set>

#include "base/geometry/plane_frame.h"
#include "mesh/edge_key.h"
#include "mesh/region.h"
#include "mesh/triangle_shape.h"

namespace radiosity {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CornerBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using InsideFaceBase =
    CGAL::Triangulation_face_base_with_info_2<bool, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using DataStructure = CGAL::Triangulation_data_structure_2<CornerBase, InsideFaceBase>;
using RegionTriangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, DataStructure,
                                               CGAL::No_constraint_intersection_tag>;
using Face = RegionTriangulation::Face_handle;
using Vertex = RegionTriangulation::Vertex_handle;

const AngleLimit kWantedAngle(25.0);           // triangles below are improved
const AngleLimit kAcceptedAngle(18.0);         // a new point must reach this around itself
const double kWorthwhile = glm::radians(2.0);  // and gain this much
constexpr int kRounds = 4;                     // refine, smooth, triangulate anew
constexpr int kSweeps = 4;                     // of smoothing, a round

Vec2 positionOf(Vertex v) { return {v->point().x(), v->point().y()}; }
RegionTriangulation::Point pointOf(const Vec2& p) { return {p.x, p.y}; }
/// Whether a triangle has no area or is turned over, after rounding or a move.
bool isTurnedOver(Face f) {
  const Vec2 a = positionOf(f->vertex(0));
  return cross2(positionOf(f->vertex(1)) - a, positionOf(f->vertex(2)) - a) <= 0;
}

/// The smallest angle that inner points and moves can change: angles between two constraints are
/// given.
Angle smallestFreeAngle(Face f) {
  const Vec2 p[3] = {positionOf(f->vertex(0)), positionOf(f->vertex(1)), positionOf(f->vertex(2))};
  Angle smallest;
  for (int i = 0; i < 3; ++i) {
    const int next = RegionTriangulation::ccw(i);
    const int last = RegionTriangulation::cw(i);
    if (f->is_constrained(next) && f->is_constrained(last)) continue;
    lower(smallest, {p[next], p[i], p[last]});
  }
  return smallest;
}

/// The smallest free angle of some triangles; less than any angle if a triangle is turned over.
class Worst {
 public:
  void add(Face f) {
    if (turned_over_ || isTurnedOver(f)) {
      turned_over_ = true;
    } else {
      lower(smallest_, smallestFreeAngle(f));
    }
  }
  bool isBelow(const AngleLimit& limit) const { return turned_over_ || limit.isAbove(smallest_); }
  bool isBelow(const Worst& other) const {
    return !other.turned_over_ && (turned_over_ || smallest_.isBelow(other.smallest_));
  }
  /// The angle; -1 if a triangle is turned over.
  double radians() const { return turned_over_ ? -1.0 : smallest_.radians(); }

 private:
  Angle smallest_;
  bool turned_over_ = false;
};

class RegionMesher {
 public:
  explicit RegionMesher(const Region& region) : region_(region) {
    for (const auto& loop : region.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        outline_.insert(edgeKey(loop[k], loop[(k + 1) % loop.size()]));
      }
    }
    interior_ = backgroundGrid(region);
    budget_ = region.points.size() + interior_.size() + 32;
  }

  std::optional<RegionMesh> run() {
    if (isPlainTriangle()) return RegionMesh{{}, {{2, 0, 1, kNone}}};
    if (!triangulate() || !tiles()) return std::nullopt;
    for (int round = 0; round < kRounds && worst().isBelow(kWantedAngle); ++round) {
      refine();
      smooth();
      takePositions();
      triangulate();
    }
    flipFlat();
    std::vector<Cell> cells = pairTriangles(region_, interior_, triangles());
    while (shorten(cells)) cells = pairTriangles(region_, interior_, triangles());
    return RegionMesh{std::move(interior_), std::move(cells)};
  }

 private:
  bool isPlainTriangle() const;
  bool triangulate();
  bool insertPieces(const std::vector<Vertex>& vertices);
  void markInside();
  bool tiles() const;
  bool isOutline(Face f, int i) const {
    return f->is_constrained(i) &&
           outline_.count(edgeKey(f->vertex(RegionTriangulation::cw(i))->info(),
                                  f->vertex(RegionTriangulation::ccw(i))->info())) > 0;
  }
  bool isFree(Vertex v) const { return v->info() >= region_.points.size(); }
  Worst worst() const;
  void refine();
  bool improve(Face bad, std::vector<Face>& changed);
  struct Trial {
    Face where;          ///< the face that contains the point
    double gain = 0;     ///< the smallest angle around the point if it is worthwhile; else 0
    bool clear = false;  ///< removes the bad face and is outside the circles over constraints
  };
  Trial tryPoint(const RegionTriangulation::Point& p, Face bad);
  Vertex insert(const RegionTriangulation::Point& p, Face where);
  void smooth();
  bool relax(Vertex v);
  Worst worstAround(Vertex v);
  void flipFlat();
  bool isFlippable(Face f, int i) const;
  bool shorten(const std::vector<Cell>& cells);
  double longestPiece() const;
  bool isClear(const Vec2& p, Face near);
  void takePositions();
  std::vector<std::array<Index, 3>> triangles() const;

  const Region& region_;
  std::unordered_set<std::uint64_t> outline_;
  std::vector<Vec2> interior_;
  RegionTriangulation cdt_;
  std::size_t inserted_ = 0;
  std::size_t budget_ = 0;
};

/// Whether the region is a triangle without inner points. It is its own triangulation: all its
/// angles are given, and none of its edges may be cut or flipped. Its first corner is that of the
/// triangulation of three points.
bool RegionMesher::isPlainTriangle() const {
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
bool RegionMesher::insertPieces(const std::vector<Vertex>& vertices) {
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

/// Triangulates. False if pieces cross, which inner points cannot change.
bool RegionMesher::triangulate() {
  cdt_.clear();
  const auto add = [&](const Vec2& p, std::size_t id, Face hint) {
    const Vertex v = cdt_.insert(pointOf(p), hint);
    v->info() = Index(id);
    return v;
  };
  // We insert every second of the points between those already in, repeatedly. Points in a row,
  // inserted one after the other, would make each insertion flip all edges of the row so far.
  const std::size_t count = region_.points.size();
  std::vector<Vertex> vertices(count);
  vertices[0] = add(region_.points[0], 0, Face());
  for (std::size_t stride = std::bit_ceil(count); stride > 0; stride /= 2) {
    for (std::size_t k = stride; k < count; k += 2 * stride) {
      vertices[k] = add(region_.points[k], k, vertices[k - stride]->face());
    }
  }
  if (!insertPieces(vertices)) return false;
  Face hint;
  for (std::size_t k = 0; k < interior_.size(); ++k) {
    hint = add(interior_[k], count + k, hint)->face();
  }
  markInside();
  return true;
}

/// Marks the faces that are reached from the left of the loops' pieces without crossing any piece.
void RegionMesher::markInside() {
  for (Face f : cdt_.all_face_handles()) f->info() = false;
  std::vector<Face> stack;
  const auto visit = [&](Face f) {
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
  for (Face f : cdt_.finite_face_handles()) {
    for (int i = 0; i < 3; ++i) {
      const Index from = f->vertex(RegionTriangulation::ccw(i))->info();
      const Index to = f->vertex(RegionTriangulation::cw(i))->info();
      if (directed.count(directedKey(from, to)) > 0) visit(f);
    }
  }
  while (!stack.empty()) {
    const Face f = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      if (!isOutline(f, i)) visit(f->neighbor(i));
    }
  }
}

/// Whether the triangles inside have the area of the loops. They have not if loops touch, or if
/// rounding has turned a triangle over.
bool RegionMesher::tiles() const {
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
  for (Face f : cdt_.finite_face_handles()) {
    if (!f->info()) continue;
    const Vec2 a = positionOf(f->vertex(0));
    add(positionOf(f->vertex(1)) - a, positionOf(f->vertex(2)) - a, -1.0);
  }
  // Products and their coordinates are rounded a few times each. A triangle that is turned over or
  // there twice makes a far larger difference.
  return std::abs(double(area)) <= 0x1p-46 * terms;
}

/// The worst angle of the triangles inside.
Worst RegionMesher::worst() const {
  Worst out;
  for (Face f : cdt_.finite_face_handles()) {
    if (f->info()) out.add(f);
  }
  return out;
}

/// Delaunay refinement without encroachment rules: candidate points are judged by the triangles
/// that they would make.
void RegionMesher::refine() {
  std::vector<std::array<Vertex, 3>> worst;
  const auto note = [&](Face f) {
    if (f->info() && (isTurnedOver(f) || kWantedAngle.isAbove(smallestFreeAngle(f)))) {
      worst.push_back({f->vertex(0), f->vertex(1), f->vertex(2)});
    }
  };
  for (Face f : cdt_.finite_face_handles()) note(f);
  std::vector<Face> changed;
  for (std::size_t k = 0; k < worst.size() && inserted_ < budget_; ++k) {
    Face f;
    if (!cdt_.is_face(worst[k][0], worst[k][1], worst[k][2], f) || !f->info()) continue;
    changed.clear();
    if (improve(f, changed)) {
      for (Face g : changed) note(g);
    }
  }
}

/// Judges a point at p, which would remove `bad`, by the triangles that it would make. They are
/// known beforehand: p joined to the boundary of its conflict zone (Bowyer-Watson).
RegionMesher::Trial RegionMesher::tryPoint(const RegionTriangulation::Point& p, Face bad) {
  Trial trial;
  Face& where = trial.where;
  RegionTriangulation::Locate_type type;
  int i = 0;
  where = cdt_.locate(p, type, i, bad);
  if (type == RegionTriangulation::VERTEX || cdt_.is_infinite(where) || !where->info())
    return trial;
  if (type == RegionTriangulation::EDGE && where->is_constrained(i)) return trial;
  std::vector<Face> zone;
  std::vector<RegionTriangulation::Edge> rim;
  cdt_.get_conflicts_and_boundary(p, std::back_inserter(zone), std::back_inserter(rim), where);
  if (std::find(zone.begin(), zone.end(), bad) == zone.end()) return trial;
  Angle after;
  trial.clear = true;
  for (const auto& [f, side] : rim) {
    const Vec2 a = positionOf(f->vertex(RegionTriangulation::ccw(side)));
    const Vec2 b = positionOf(f->vertex(RegionTriangulation::cw(side)));
    const Vec2 q(p.x(), p.y());
    lower(after, smallestOf(q, a, b));
    if (!f->is_constrained(side)) continue;
    if (glm::dot(a - q, b - q) < 0) trial.clear = false;
    if (heightOver(q, a, b) <= region_.clearance) return {};
  }
  if (kAcceptedAngle.isAbove(after)) return trial;
  Worst before;
  for (Face f : zone) before.add(f);
  if (after.radians() >= before.radians() + kWorthwhile) trial.gain = after.radians();
  return trial;
}

Vertex RegionMesher::insert(const RegionTriangulation::Point& p, Face where) {
  const Vertex v = cdt_.insert(p, where);
  v->info() = Index(region_.points.size() + interior_.size());
  interior_.emplace_back(p.x(), p.y());
  ++inserted_;
  RegionTriangulation::Face_circulator f = cdt_.incident_faces(v);
  const RegionTriangulation::Face_circulator end = f;
  do {
    f->info() = true;  // the conflict zone never crosses a constraint
  } while (++f != end);
  return v;
}

bool RegionMesher::improve(Face bad, std::vector<Face>& changed) {
  const Vec2 p[3] = {positionOf(bad->vertex(0)), positionOf(bad->vertex(1)),
                     positionOf(bad->vertex(2))};
  Trial best;
  RegionTriangulation::Point best_point;
  bool first = true;
  for (const Vec2& candidate : candidatesFor(p)) {
    const RegionTriangulation::Point q = pointOf(candidate);
    if (!std::isfinite(q.x()) || !std::isfinite(q.y())) continue;
    const Trial trial = tryPoint(q, bad);
    // The first candidate is the circumcentre. If it is clear of the boundary, we insert it even
    // without a gain: no new edge is shorter than the triangle's radius, so that points spread out
    // from small features, farther and farther apart (Ruppert 1995).
    const bool spread = first && trial.clear;
    first = false;
    if (!spread && trial.gain <= best.gain) continue;
    best = trial;
    best_point = q;
    if (spread) break;
  }
  if (best.where == Face()) return false;
  const Vertex v = insert(best_point, best.where);
  RegionTriangulation::Face_circulator f = cdt_.incident_faces(v);
  const RegionTriangulation::Face_circulator end = f;
  do {
    changed.push_back(f);
  } while (++f != end);
  return true;
}

Worst RegionMesher::worstAround(Vertex v) {
  Worst out;
  RegionTriangulation::Face_circulator f = cdt_.incident_faces(v);
  const RegionTriangulation::Face_circulator end = f;
  do {
    out.add(f);
  } while (++f != end);
  return out;
}

/// Moves a free vertex towards the mean of its neighbours, as far as its smallest angle grows.
bool RegionMesher::relax(Vertex v) {
  const Worst before = worstAround(v);
  if (!before.isBelow(kWantedAngle)) return false;
  Vec2 mean(0.0);
  double count = 0;
  RegionTriangulation::Vertex_circulator w = cdt_.incident_vertices(v);
  const RegionTriangulation::Vertex_circulator end = w;
  do {
    mean += positionOf(w);
    count += 1;
  } while (++w != end);
  mean /= count;
  const RegionTriangulation::Point old = v->point();
  const Vec2 from = positionOf(v);
  for (const double step : {1.0, 0.5, 0.25, -0.25}) {
    v->set_point(pointOf(from + step * (mean - from)));
    if (before.isBelow(worstAround(v))) return true;
  }
  v->set_point(old);
  return false;
}

void RegionMesher::smooth() {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool moved = false;
    for (Vertex v : cdt_.finite_vertex_handles()) {
      if (isFree(v)) moved = relax(v) || moved;
    }
    if (!moved) return;
  }
}

/// Whether the two triangles at the edge opposite of corner i make a convex quadrilateral.
bool RegionMesher::isFlippable(Face f, int i) const {
  const auto& apex = f->vertex(i)->point();
  const auto& from = f->vertex(RegionTriangulation::ccw(i))->point();
  const auto& to = f->vertex(RegionTriangulation::cw(i))->point();
  const auto& other = cdt_.mirror_vertex(f, i)->point();
  return CGAL::orientation(apex, from, other) == CGAL::LEFT_TURN &&
         CGAL::orientation(apex, other, to) == CGAL::LEFT_TURN;
}

/// Flips the longest edges of triangles flatter than a coincidence, so that the edge starts at the
/// opposite corner. The Delaunay triangulation makes such triangles where the boundary is nearly
/// straight.
void RegionMesher::flipFlat() {
  std::vector<Face> stack;
  for (Face f : cdt_.finite_face_handles()) {
    if (f->info()) stack.push_back(f);
  }
  // Every flip removes a flat triangle; if four points are nearly in line, it may come back.
  for (std::size_t left = 2 * stack.size(); !stack.empty() && left > 0;) {
    Face f = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const Vec2 a = positionOf(f->vertex(RegionTriangulation::ccw(i)));
      const Vec2 b = positionOf(f->vertex(RegionTriangulation::cw(i)));
      if (f->is_constrained(i) ||
          heightOver(positionOf(f->vertex(i)), a, b) > 0.5 * region_.clearance ||
          !isFlippable(f, i)) {
        continue;
      }
      const Face other = f->neighbor(i);
      cdt_.flip(f, i);
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
bool RegionMesher::isClear(const Vec2& p, Face near) {
  std::vector<RegionTriangulation::Edge> rim;
  const Face where = cdt_.locate(pointOf(p), near);
  if (cdt_.is_infinite(where) || !where->info()) return false;
  cdt_.get_boundary_of_conflicts(pointOf(p), std::back_inserter(rim), where);
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
  std::vector<Vertex> vertices(region_.points.size() + interior_.size());
  for (Vertex v : cdt_.finite_vertex_handles()) vertices[v->info()] = v;
  // Edges of this length but for rounding stay, and so do edges beside longer pieces (at corners
  // too sharp to be cut).
  const double limit = std::max(region_.longest * (1 + 1e-9), longestPiece());
  bool found = false;
  for (const Cell& cell : cells) {
    const std::size_t corners = cell[3] == kNone ? 3 : 4;
    for (std::size_t k = 0; k < corners; ++k) {
      const Vertex a = vertices[cell[k]];
      const Vertex b = vertices[cell[(k + 1) % corners]];
      Face f;
      int i = 0;
      if (glm::length(positionOf(a) - positionOf(b)) <= limit) continue;
      if (!cdt_.is_edge(a, b, f, i) || f->is_constrained(i)) continue;
      const Vec2 middle = 0.5 * (positionOf(a) + positionOf(b));
      if (!isClear(middle, f)) continue;
      insert(pointOf(middle), f);
      found = true;
    }
  }
  return found;
}

void RegionMesher::takePositions() {
  for (Vertex v : cdt_.finite_vertex_handles()) {
    if (isFree(v)) interior_[v->info() - region_.points.size()] = positionOf(v);
  }
}

std::vector<std::array<Index, 3>> RegionMesher::triangles() const {
  std::vector<std::array<Index, 3>> result;
  for (Face f : cdt_.finite_face_handles()) {
    if (f->info()) {
      result.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
    }
  }
  return result;
}

}  // namespace

std::optional<RegionMesh> meshRegion(const Region& region) { return RegionMesher(region).run(); }

}  // namespace radiosity
