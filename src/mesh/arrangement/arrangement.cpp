#include "mesh/arrangement/arrangement.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "mesh/plane_image.h"

namespace radiosity {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
/// The region of a triangle: triangles without one of our edges between them.
using RegionFaceBase =
    CGAL::Triangulation_face_base_with_info_2<Index, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using ArrangementTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, RegionFaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Cover = std::vector<std::pair<Index, int>>;

Kernel::Point_2 toKernel(const Vec2& p) { return {p.x, p.y}; }

/// Cuts one plane.
class PlaneCutter {
 public:
  PlaneCutter(const WeldedPoints& points, const Plane& plane, Index number,
              const std::vector<Sheet>& sheets, const EdgeTable& edges,
              const std::vector<Index>& own, PlaneCut& out)
      : points_(points),
        plane_(plane),
        frame_(plane.normal),
        number_(number),
        sheets_(sheets),
        edges_(edges),
        own_(own),
        out_(out) {}

  void run();

 private:
  bool cutTriangle();
  bool insertVertices();
  bool insertEdges();
  bool reportTouches();
  void reportCrossings();
  void findRegions();
  void coverRegions();
  void makeCells();
  void makeCell(const Cover& cover);
  void addToCell(PlaneCell& cell, const Vec3& a, const Vec3& b, const Vec3& c) const;
  void recordSides();
  Cover stepOver(const Cover& from, Index edge, bool to_left) const;
  Index edgeBetween(ArrangementTriangulation::Face_handle face, int k) const {
    return edges_.find(face->vertex(ArrangementTriangulation::ccw(k))->info(),
                       face->vertex(ArrangementTriangulation::cw(k))->info());
  }

  const WeldedPoints& points_;
  const Plane& plane_;
  PlaneImage frame_;
  Index number_;
  const std::vector<Sheet>& sheets_;
  const EdgeTable& edges_;
  const std::vector<Index>& own_;
  PlaneCut& out_;

  ArrangementTriangulation triangulation_;
  std::unordered_map<Index, ArrangementTriangulation::Vertex_handle> handle_;
  std::vector<Cover> cover_;    ///< by region
  std::vector<Index> cell_of_;  ///< by region
};

void PlaneCutter::run() {
  if (own_.size() == 3 && cutTriangle()) return;
  if (!insertVertices()) return;
  if (!insertEdges()) return reportCrossings();
  if (reportTouches()) return;
  out_.done = true;
  if (triangulation_.dimension() < 2) return;  // after welding, all points are on one line
  findRegions();
  coverRegions();
  makeCells();
  recordSides();
}

/// Cuts a plane whose edges are those of one triangle, as most planes of curved surfaces are. False
/// if they are not, or if the sheets do not cover the triangle seen from every edge.
bool PlaneCutter::cutTriangle() {
  std::array<Index, 3> corners{edges_[own_[0]].a, edges_[own_[0]].b, kNone};
  const Edge& next = edges_[own_[1]];
  const bool from_a = next.a == corners[0] || next.a == corners[1];
  corners[2] = from_a ? next.b : next.a;
  for (const Index e : own_) {
    for (const Index v : {edges_[e].a, edges_[e].b}) {
      if (std::ranges::find(corners, v) == corners.end()) return false;
    }
  }
  const auto turn = CGAL::orientation(toKernel(frame_(points_[corners[0]])),
                                      toKernel(frame_(points_[corners[1]])),
                                      toKernel(frame_(points_[corners[2]])));
  if (turn == CGAL::COLLINEAR) return false;
  if (turn == CGAL::RIGHT_TURN) std::swap(corners[0], corners[1]);
  const auto isLeft = [&](Index e) {
    const auto at = std::ranges::find(corners, edges_[e].a) - corners.begin();
    return corners[std::size_t(at + 1) % 3] == edges_[e].b;
  };
  const Cover cover = stepOver({}, own_[0], isLeft(own_[0]));
  for (const Index e : own_) {
    if (stepOver({}, e, isLeft(e)) != cover) return false;
  }
  out_.done = true;
  if (cover.empty()) return true;
  makeCell(cover);
  addToCell(out_.cells[0], points_[corners[0]], points_[corners[1]], points_[corners[2]]);
  for (const Index e : own_) {
    const bool left = isLeft(e);
    out_.sides.emplace_back(e, EdgeSides{number_, left ? 0 : kNone, left ? kNone : 0});
  }
  return true;
}

/// False if two vertices have the same image: one above the other within the plane's slab.
bool PlaneCutter::insertVertices() {
  bool distinct = true;
  ArrangementTriangulation::Face_handle near;
  for (const Index e : own_) {
    for (const Index v : {edges_[e].a, edges_[e].b}) {
      if (handle_.count(v) > 0) continue;
      const std::size_t before = triangulation_.number_of_vertices();
      const auto handle = triangulation_.insert(toKernel(frame_(points_[v])), near);
      if (triangulation_.number_of_vertices() == before) {
        out_.unresolved.merges.push_back({handle->info(), v});
        distinct = false;
      } else {
        handle->info() = v;
      }
      near = handle->face();
      handle_.emplace(v, handle);
    }
  }
  return distinct;
}

bool PlaneCutter::insertEdges() {
  try {
    for (const Index e : own_) {
      triangulation_.insert_constraint(handle_[edges_[e].a], handle_[edges_[e].b]);
    }
  } catch (const ArrangementTriangulation::Intersection_of_constraints_exception&) {
    return false;
  }
  return true;
}

/// Reports vertices that lie exactly on an edge in the image: the edge has become a path over them.
bool PlaneCutter::reportTouches() {
  bool any = false;
  for (const Index e : own_) {
    const auto a = handle_[edges_[e].a];
    const auto b = handle_[edges_[e].b];
    if (triangulation_.is_edge(a, b)) continue;
    any = true;
    for (const auto& [v, handle] : handle_) {
      if (CGAL::collinear(a->point(), handle->point(), b->point()) &&
          CGAL::collinear_are_strictly_ordered_along_line(a->point(), handle->point(),
                                                          b->point())) {
        out_.unresolved.splits.push_back({e, v});
      }
    }
  }
  return any;
}

/// Reports edges that cross in the image although they pass each other in space at more than
/// coincidence, both within the plane's slab. This is rare. They are then made to meet.
void PlaneCutter::reportCrossings() {
  std::vector<Box3> boxes;
  for (const Index e : own_) {
    Box3 box;
    box.add(Vec3(frame_(points_[edges_[e].a]), 0.0));
    box.add(Vec3(frame_(points_[edges_[e].b]), 0.0));
    boxes.push_back(box);
  }
  for (const auto& [i, j] : overlappingPairs(boxes)) {
    const Edge& f = edges_[own_[i]];
    const Edge& g = edges_[own_[j]];
    if (f.a == g.a || f.a == g.b || f.b == g.a || f.b == g.b) continue;
    const Vec2 p = frame_(points_[f.a]);
    const Vec2 q = frame_(points_[f.b]);
    const Vec2 r = frame_(points_[g.a]);
    const Vec2 s = frame_(points_[g.b]);
    const auto turn = [](const Vec2& a, const Vec2& b, const Vec2& c) {
      return CGAL::orientation(toKernel(a), toKernel(b), toKernel(c));
    };
    if (turn(p, q, r) == turn(p, q, s) || turn(r, s, p) == turn(r, s, q)) continue;
    const Vec2 d1 = q - p;
    const Vec2 d2 = s - r;
    const double area = d1.x * d2.y - d1.y * d2.x;
    const double t = area == 0 ? 0.5 : ((r - p).x * d2.y - (r - p).y * d2.x) / area;
    out_.crossings.push_back({own_[i], own_[j], points_[f.a] + t * (points_[f.b] - points_[f.a])});
  }
}

void PlaneCutter::findRegions() {
  for (const auto face : triangulation_.all_face_handles()) face->info() = kNone;
  std::vector<ArrangementTriangulation::Face_handle> stack;
  Index regions = 0;
  const auto flood = [&](ArrangementTriangulation::Face_handle start) {
    start->info() = regions;
    stack.push_back(start);
    while (!stack.empty()) {
      const auto face = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const auto next = face->neighbor(k);
        if (face->is_constrained(k) || next->info() != kNone) continue;
        next->info() = regions;
        stack.push_back(next);
      }
    }
    ++regions;
  };
  flood(triangulation_.infinite_face());  // region 0 is the outside
  for (const auto face : triangulation_.finite_face_handles()) {
    if (face->info() == kNone) flood(face);
  }
  cover_.assign(regions, {});
}

/// The cover across an edge: a sheet lies on the left of its border, seen from its front.
Cover PlaneCutter::stepOver(const Cover& from, Index edge, bool to_left) const {
  Cover out = from;
  for (const EdgeUse& use : edges_[edge].uses) {
    if (sheets_[use.sheet].plane != number_) continue;
    const auto at = std::ranges::lower_bound(out, use.sheet, {}, &std::pair<Index, int>::first);
    // Layers of a sheet that faces down have a negative count.
    const int count = to_left ? use.count : -use.count;
    if (at == out.end() || at->first != use.sheet) {
      out.insert(at, {use.sheet, count});
    } else {
      at->second += count;
    }
  }
  std::erase_if(out, [](const auto& layers) { return layers.second == 0; });
  return out;
}

/// Finds the covers by a walk from the empty outside over edges into every region. It uses no
/// coordinates, so rounding cannot make a hole or a second layer.
void PlaneCutter::coverRegions() {
  struct Step {
    Index region;
    Index edge;
    bool to_left;
  };
  std::vector<std::vector<Step>> steps(cover_.size());
  for (const auto face : triangulation_.all_face_handles()) {
    for (int k = 0; k < 3; ++k) {
      if (!face->is_constrained(k)) continue;
      const Index edge = edgeBetween(face, k);
      // From ccw(k) to cw(k) the triangle itself is on the left.
      const bool face_is_left =
          face->vertex(ArrangementTriangulation::ccw(k))->info() == edges_[edge].a;
      steps[face->info()].push_back({face->neighbor(k)->info(), edge, !face_is_left});
    }
  }
  std::vector<bool> known(cover_.size(), false);
  std::vector<Index> stack{0};
  known[0] = true;
  while (!stack.empty()) {
    const Index region = stack.back();
    stack.pop_back();
    for (const Step& step : steps[region]) {
      if (known[step.region]) continue;
      known[step.region] = true;
      cover_[step.region] = stepOver(cover_[region], step.edge, step.to_left);
      stack.push_back(step.region);
    }
  }
}

void PlaneCutter::makeCells() {
  cell_of_.assign(cover_.size(), kNone);
  for (std::size_t r = 1; r < cover_.size(); ++r) {
    if (cover_[r].empty()) continue;
    cell_of_[r] = Index(out_.cells.size());
    makeCell(cover_[r]);
  }
  for (const auto face : triangulation_.finite_face_handles()) {
    if (cell_of_[face->info()] == kNone) continue;
    addToCell(out_.cells[cell_of_[face->info()]], points_[face->vertex(0)->info()],
              points_[face->vertex(1)->info()], points_[face->vertex(2)->info()]);
  }
}

void PlaneCutter::makeCell(const Cover& cover) {
  PlaneCell& cell = out_.cells.emplace_back();
  cell.plane = number_;
  cell.cover.reserve(cover.size());
  for (const auto& [sheet, count] : cover) {
    const int layers = count * sheets_[sheet].facing;
    if (layers < 0) out_.inverted.push_back(sheet);
    cell.cover.emplace_back(sheet, std::abs(layers));
  }
}

/// Adds a triangle to its cell.
void PlaneCutter::addToCell(PlaneCell& cell, const Vec3& a, const Vec3& b, const Vec3& c) const {
  // Areas along the plane's normal, so that parts add up to the whole to the last bits.
  const double area = 0.5 * glm::dot(glm::cross(b - a, c - a), plane_.normal);
  cell.area += area;
  const double rim = glm::distance(a, b) + glm::distance(b, c) + glm::distance(c, a);
  const double inscribed = 2.0 * area / rim;
  if (inscribed <= cell.room) return;
  cell.room = inscribed;
  // The incentre: weights are the opposite sides.
  cell.sample = (glm::distance(b, c) * a + glm::distance(c, a) * b + glm::distance(a, b) * c) / rim;
}

void PlaneCutter::recordSides() {
  for (const Index e : own_) {
    ArrangementTriangulation::Face_handle face;
    int k = 0;
    if (!triangulation_.is_edge(handle_[edges_[e].a], handle_[edges_[e].b], face, k)) continue;
    EdgeSides sides;
    sides.plane = number_;
    sides.left = cell_of_[face->info()];
    sides.right = cell_of_[face->neighbor(k)->info()];
    if (face->vertex(ArrangementTriangulation::ccw(k))->info() != edges_[e].a) {
      std::swap(sides.left, sides.right);
    }
    if (sides.left != kNone || sides.right != kNone) out_.sides.emplace_back(e, sides);
  }
}

}  // namespace

PlaneCut cutPlane(const WeldedPoints& points, const std::vector<Plane>& planes, Index number,
                  const std::vector<Sheet>& sheets, const EdgeTable& edges,
                  const std::vector<Index>& own) {
  PlaneCut out;
  PlaneCutter(points, planes[number], number, sheets, edges, own, out).run();
  return out;
}

}  // namespace radiosity
