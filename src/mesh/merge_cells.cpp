#include "mesh/merge_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "base/union_find.h"
#include "mesh/edge_crossings.h"
#include "mesh/straighten.h"
#include "mesh/trace_loops.h"

namespace radiosity {

namespace {

/// Two visible cells may become one polygon only if all members are equal.
struct Kind {
  Index surface = kNone;
  bool up = true;        ///< the polygon's front is above the plane
  bool both = false;     ///< its back is kept, too
  Index behind = kNone;  ///< surface of another polygon on the other side

  bool operator==(const Kind&) const = default;
};

/// A polygon that is being built.
struct Draft {
  Index plane = kNone;
  Kind kind;
  std::vector<Index> records;
  std::vector<Index> border;  ///< edges with the polygon on one side
  std::vector<bool> on_left;  ///< by border edge
  std::vector<Index> inner;   ///< edges with the polygon on both sides, which other planes meet
  std::vector<std::vector<Index>> loops;
};

class Merger {
 public:
  Merger(const Scene& scene, const InputFaces& input, const std::vector<Plane>& planes,
         const std::vector<Sheet>& sheets, const EdgeTable& edges, const Arrangement& arrangement,
         const std::vector<VisibleCell>& visible, MeshReport& report)
      : scene_(scene),
        input_(input),
        planes_(planes),
        sheets_(sheets),
        edges_(edges),
        arrangement_(arrangement),
        visible_(visible),
        report_(report) {}

  CoarseComplex run(std::vector<Index>& broken);

 private:
  void indexRecords();
  void joinRecords();
  void sortEdges();
  EdgeUses usesOfNeeded() const;
  void straightenEdges();
  void traceDraft(Draft& draft) const;
  std::vector<std::array<Index, 2>> edgesOf(const Draft& draft) const;
  bool isSound(const Draft& draft) const;
  void keepCorners(const Draft& draft, std::vector<bool>& keep, std::vector<Index>& kept) const;
  std::vector<bool> draftsAt(const std::vector<Index>& vertices) const;
  void countCuts();
  double movedArea(const Draft& draft) const;
  double areaInReach(const Draft& draft) const;
  void accountForStraightening();
  void countHiddenSides();
  std::vector<Index> sheetsOf(const Draft& draft) const;
  std::vector<std::vector<Index>> facesByDraft() const;
  std::vector<std::pair<Index, Index>> facesBeside(const std::vector<Index>& faces,
                                                   const std::vector<Index>& drafts) const;
  std::vector<Vec3> numberVertices();
  CoarsePolygon polygonOf(const Draft& draft, std::vector<Index> faces) const;
  std::vector<CoarsePolygon> polygons();
  bool isCutThere(const EdgeSides& sides) const;
  const std::vector<Index>& recordsOf(Index cell) const {
    static const std::vector<Index> kNothing;
    return cell == kNone ? kNothing : records_[cell];
  }

  const Scene& scene_;
  const InputFaces& input_;
  const std::vector<Plane>& planes_;
  const std::vector<Sheet>& sheets_;
  const EdgeTable& edges_;
  const Arrangement& arrangement_;
  const std::vector<VisibleCell>& visible_;
  MeshReport& report_;

  std::vector<std::vector<Index>> records_;  ///< by cell, into visible_
  std::vector<Kind> kind_;                   ///< by record
  std::vector<Index> draft_of_;              ///< by record
  std::vector<Draft> drafts_;
  std::vector<Index> needed_;         ///< edges of any polygon
  std::vector<Index> needed_number_;  ///< by edge: place in needed_
  StraightEdges straight_;
  std::vector<Index> number_;  ///< by point: vertex of the complex
};

void Merger::indexRecords() {
  records_.resize(arrangement_.cells.size());
  for (std::size_t r = 0; r < visible_.size(); ++r) records_[visible_[r].cell].push_back(Index(r));
  for (const VisibleCell& v : visible_) {
    Kind kind;
    kind.surface = sheets_[v.sheet].surface;
    kind.both = v.above && v.below;
    kind.up = kind.both ? sheets_[v.sheet].facing > 0 : v.above;
    for (const Index other : records_[v.cell]) {
      if (&visible_[other] != &v) kind.behind = sheets_[visible_[other].sheet].surface;
    }
    kind_.push_back(kind);
  }
}

void Merger::joinRecords() {
  UnionFind joined(visible_.size());
  for (const auto& at_edge : arrangement_.sides) {
    for (const EdgeSides& s : at_edge) {
      for (const Index l : recordsOf(s.left)) {
        for (const Index r : recordsOf(s.right)) {
          if (kind_[l] == kind_[r]) joined.unite(l, r);
        }
      }
    }
  }
  draft_of_.assign(visible_.size(), kNone);
  for (std::size_t r = 0; r < visible_.size(); ++r) {
    const Index root = joined.find(Index(r));
    if (root == r) {
      draft_of_[r] = Index(drafts_.size());
      drafts_.emplace_back();
      drafts_.back().plane = arrangement_.cells[visible_[r].cell].plane;
      drafts_.back().kind = kind_[r];
    }
    draft_of_[r] = draft_of_[root];
    drafts_[draft_of_[r]].records.push_back(Index(r));
  }
}

void Merger::sortEdges() {
  needed_number_.assign(edges_.size(), kNone);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    std::size_t planes_here = 0;
    for (const EdgeSides& s : arrangement_.sides[e]) {
      if (!recordsOf(s.left).empty() || !recordsOf(s.right).empty()) ++planes_here;
    }
    bool needed = false;
    for (const EdgeSides& s : arrangement_.sides[e]) {
      std::vector<Index> left;
      std::vector<Index> right;
      for (const Index r : recordsOf(s.left)) left.push_back(draft_of_[r]);
      for (const Index r : recordsOf(s.right)) right.push_back(draft_of_[r]);
      const auto has = [](const std::vector<Index>& list, Index d) {
        return std::find(list.begin(), list.end(), d) != list.end();
      };
      const auto border = [&](Index d, bool on_left) {
        drafts_[d].border.push_back(Index(e));
        drafts_[d].on_left.push_back(on_left);
        needed = true;
      };
      for (const Index d : left) {
        if (!has(right, d)) {
          border(d, true);
        } else if (planes_here > 1) {
          drafts_[d].inner.push_back(Index(e));
          needed = true;
        }
      }
      for (const Index d : right) {
        if (!has(left, d)) border(d, false);
      }
    }
    if (!needed) continue;
    needed_number_[e] = Index(needed_.size());
    needed_.push_back(Index(e));
  }
}

/// By needed edge, the polygons that it borders and those that it runs through.
EdgeUses Merger::usesOfNeeded() const {
  EdgeUses out;
  out.begin.assign(needed_.size() + 1, 0);
  const auto forUses = [&](const auto& visit) {
    for (std::size_t d = 0; d < drafts_.size(); ++d) {
      for (const Index e : drafts_[d].border) visit(needed_number_[e], Index(2 * d));
      for (const Index e : drafts_[d].inner) visit(needed_number_[e], Index(2 * d + 1));
    }
  };
  forUses([&](Index edge, Index) { ++out.begin[edge + 1]; });
  std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
  out.numbers.resize(out.begin.back());
  std::vector<std::size_t> next(out.begin.begin(), out.begin.end() - 1);
  forUses([&](Index edge, Index use) { out.numbers[next[edge]++] = use; });
  return out;
}

/// Straightening moves edges by up to a coincidence, and other edges of a polygon may be hardly
/// farther away. If a polygon's edges then cross, its vertices are kept. With all vertices kept,
/// the edges are those of the arrangement, which do not cross.
void Merger::straightenEdges() {
  std::vector<std::array<Index, 2>> ends;
  ends.reserve(needed_.size());
  for (const Index e : needed_) ends.push_back({edges_[e].a, edges_[e].b});
  const EdgeUses uses = usesOfNeeded();
  std::vector<bool> keep(input_.points.size(), false);
  std::vector<bool> stale(drafts_.size(), true);
  while (std::find(stale.begin(), stale.end(), true) != stale.end()) {
    straight_ = straighten(input_.points, input_.coincidence, ends, uses, keep);
    std::vector<char> sound(drafts_.size(), 1);
    parallelFor(drafts_.size(), 256, [&](std::size_t d) {
      if (!stale[d]) return;
      traceDraft(drafts_[d]);
      sound[d] = isSound(drafts_[d]) ? 1 : 0;
    });
    std::vector<Index> kept;
    for (std::size_t d = 0; d < drafts_.size(); ++d) {
      if (sound[d] == 0) keepCorners(drafts_[d], keep, kept);
    }
    stale = draftsAt(kept);
  }
}

/// Marks the drafts with one of `vertices`.
std::vector<bool> Merger::draftsAt(const std::vector<Index>& vertices) const {
  std::vector<bool> out(drafts_.size(), false);
  if (vertices.empty()) return out;
  std::vector<bool> there(input_.points.size(), false);
  for (const Index v : vertices) there[v] = true;
  const auto touches = [&](Index e) { return there[edges_[e].a] || there[edges_[e].b]; };
  for (std::size_t d = 0; d < drafts_.size(); ++d) {
    out[d] = std::any_of(drafts_[d].border.begin(), drafts_[d].border.end(), touches) ||
             std::any_of(drafts_[d].inner.begin(), drafts_[d].inner.end(), touches);
  }
  return out;
}

/// The edges of a draft after straightening, inner ones included.
std::vector<std::array<Index, 2>> Merger::edgesOf(const Draft& draft) const {
  std::vector<std::array<Index, 2>> out;
  for (const auto& loop : draft.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      out.push_back({loop[k], loop[(k + 1) % loop.size()]});
    }
  }
  std::vector<Index> inner;
  inner.reserve(draft.inner.size());
  for (const Index e : draft.inner) inner.push_back(straight_.edge_of[needed_number_[e]]);
  std::sort(inner.begin(), inner.end());
  inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
  for (const Index e : inner) out.push_back(straight_.edges[e]);
  return out;
}

bool Merger::isSound(const Draft& draft) const {
  const bool triangle = draft.loops.size() == 1 && draft.loops[0].size() == 3;
  if (draft.inner.empty() && (triangle || draft.loops.empty())) return true;
  return !anyCross(input_.points, PlaneImage(planes_[draft.plane].normal), edgesOf(draft));
}

/// Keeps all vertices of a draft; appends those that had been removed.
void Merger::keepCorners(const Draft& draft, std::vector<bool>& keep,
                         std::vector<Index>& kept) const {
  for (const auto* list : {&draft.border, &draft.inner}) {
    for (const Index e : *list) {
      for (const Index v : {edges_[e].a, edges_[e].b}) {
        if (straight_.removed[v] && !keep[v]) kept.push_back(v);
        keep[v] = true;
      }
    }
  }
}

void Merger::traceDraft(Draft& draft) const {
  draft.loops.clear();
  const PlaneImage frame(planes_[draft.plane].normal);
  std::vector<std::array<Index, 2>> directed;
  directed.reserve(draft.border.size());
  for (std::size_t k = 0; k < draft.border.size(); ++k) {
    const Edge& e = edges_[draft.border[k]];
    if (draft.on_left[k]) {
      directed.push_back({e.a, e.b});
    } else {
      directed.push_back({e.b, e.a});
    }
  }
  std::vector<std::pair<double, std::vector<Index>>> loops;
  for (auto& loop : traceLoops(input_.points, frame, directed)) {
    std::erase_if(loop, [&](Index v) { return straight_.removed[v]; });
    if (loop.size() < 3) continue;
    const Vec3 area =
        vectorArea(loop.size(), [&](std::size_t k) { return input_.points[loop[k]]; });
    if (!draft.kind.up) std::reverse(loop.begin(), loop.end());
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    loops.emplace_back(-glm::dot(area, planes_[draft.plane].normal), std::move(loop));
  }
  // The outer loop has the largest positive area. If no area is positive, welding has bent a sliver
  // out of its plane.
  std::sort(loops.begin(), loops.end());
  if (loops.empty() || loops[0].first >= 0) return;
  for (auto& [key, loop] : loops) draft.loops.push_back(std::move(loop));
}

/// Whether the edge cuts a sheet: the sheet continues on both sides, and the edge is needed there.
bool Merger::isCutThere(const EdgeSides& s) const {
  if (s.left == kNone || s.right == kNone) return false;
  if (recordsOf(s.left).empty() && recordsOf(s.right).empty()) return false;
  const auto& left = arrangement_.cells[s.left].cover;
  const auto& right = arrangement_.cells[s.right].cover;
  return std::any_of(left.begin(), left.end(), [&](const auto& l) {
    return std::any_of(right.begin(), right.end(),
                       [&](const auto& r) { return l.first == r.first; });
  });
}

void Merger::countCuts() {
  std::vector<bool> cut(straight_.edges.size(), false);
  for (std::size_t k = 0; k < needed_.size(); ++k) {
    const auto& at_edge = arrangement_.sides[needed_[k]];
    if (std::any_of(at_edge.begin(), at_edge.end(),
                    [&](const EdgeSides& s) { return isCutThere(s); })) {
      cut[straight_.edge_of[k]] = true;
    }
  }
  report_.cuts = std::size_t(std::count(cut.begin(), cut.end(), true));
}

/// The area by which the loops of a draft fall short of its cells.
double Merger::movedArea(const Draft& draft) const {
  double area = 0;
  for (const Index r : draft.records) area += arrangement_.cells[visible_[r].cell].area;
  Vec3 kept(0.0);
  for (const auto& loop : draft.loops) {
    kept += vectorArea(loop.size(), [&](std::size_t k) { return input_.points[loop[k]]; });
  }
  return area - std::abs(glm::dot(kept, planes_[draft.plane].normal));
}

/// The most area that straightening can move: a strip of two coincidences along the border, times
/// two for rounding.
double Merger::areaInReach(const Draft& draft) const {
  double length = 0;
  for (const Index e : draft.border) {
    length += glm::distance(input_.points[edges_[e].a], input_.points[edges_[e].b]);
  }
  return 4.0 * input_.coincidence * length;
}

void Merger::accountForStraightening() {
  std::vector<double> moved(report_.surfaces.size(), 0.0);
  for (const Draft& draft : drafts_) moved[draft.kind.surface] += movedArea(draft);
  for (std::size_t s = 0; s < moved.size(); ++s) addMovedArea(report_.surfaces[s], moved[s]);
}

std::vector<Index> Merger::sheetsOf(const Draft& draft) const {
  std::vector<Index> out;
  out.reserve(draft.records.size());
  for (const Index r : draft.records) out.push_back(visible_[r].sheet);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// By draft, the scene's faces under it; for a sheet that several drafts share, the faces near it.
std::vector<std::vector<Index>> Merger::facesByDraft() const {
  std::vector<std::vector<Index>> drafts_of(sheets_.size());
  for (std::size_t d = 0; d < drafts_.size(); ++d) {
    if (drafts_[d].loops.empty()) continue;
    for (const Index s : sheetsOf(drafts_[d])) drafts_of[s].push_back(Index(d));
  }
  std::vector<std::vector<Index>> out(drafts_.size());
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const std::vector<Index>& drafts = drafts_of[s];
    const std::vector<Index>& faces = sheets_[s].faces;
    if (drafts.size() == 1) {
      for (const Index f : faces) out[drafts[0]].push_back(input_.faces[f].source);
    } else if (drafts.size() > 1) {
      for (const auto& [face, draft] : facesBeside(faces, drafts)) {
        out[draft].push_back(input_.faces[face].source);
      }
    }
  }
  for (auto& faces : out) {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  }
  return out;
}

/// Pairs of a face and a draft whose boxes meet.
std::vector<std::pair<Index, Index>> Merger::facesBeside(const std::vector<Index>& faces,
                                                         const std::vector<Index>& drafts) const {
  std::vector<Box3> boxes;
  const auto add = [&](const std::vector<Index>& loop, double margin) {
    Box3 box;
    for (const Index v : loop) box.add(input_.points[v]);
    boxes.push_back(box.grown(margin));
  };
  for (const Index f : faces) add(input_.faces[f].loop, 0.0);
  std::vector<Index> some;
  for (const Index d : drafts) {
    some.push_back(Index(boxes.size()));
    add(drafts_[d].loops[0], input_.coincidence);
  }
  std::vector<std::pair<Index, Index>> out;
  for (const auto& [face, draft] : overlappingPairs(boxes, some)) {
    if (face < faces.size() && draft >= faces.size()) {
      out.emplace_back(faces[face], drafts[draft - faces.size()]);
    }
  }
  return out;
}

/// Numbers the remaining vertices by their place in space, not by their history.
std::vector<Vec3> Merger::numberVertices() {
  std::vector<Index> used;
  for (const auto& edge : straight_.edges) used.insert(used.end(), edge.begin(), edge.end());
  std::sort(used.begin(), used.end(), [&](Index a, Index b) {
    const Vec3& p = input_.points[a];
    const Vec3& q = input_.points[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  });
  used.erase(std::unique(used.begin(), used.end()), used.end());
  number_.assign(input_.points.size(), kNone);
  std::vector<Vec3> out;
  out.reserve(used.size());
  for (const Index v : used) {
    number_[v] = Index(out.size());
    out.push_back(input_.points[v]);
  }
  return out;
}

CoarsePolygon Merger::polygonOf(const Draft& draft, std::vector<Index> faces) const {
  CoarsePolygon p;
  for (std::vector<Index> loop : draft.loops) {
    for (Index& v : loop) v = number_[v];
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    p.loops.push_back(std::move(loop));
  }
  std::sort(p.loops.begin() + 1, p.loops.end());
  for (const Index e : draft.inner) {
    const auto& ends = straight_.edges[straight_.edge_of[needed_number_[e]]];
    const auto [low, high] = std::minmax(number_[ends[0]], number_[ends[1]]);
    p.inner_edges.push_back({low, high});
  }
  std::sort(p.inner_edges.begin(), p.inner_edges.end());
  p.inner_edges.erase(std::unique(p.inner_edges.begin(), p.inner_edges.end()), p.inner_edges.end());
  p.normal = planes_[draft.plane].normal * (draft.kind.up ? 1.0 : -1.0);
  p.surface = draft.kind.surface;
  p.back = draft.kind.both;
  p.faces = std::move(faces);
  return p;
}

/// The polygons, in an order that does not depend on the order of the file's faces.
std::vector<CoarsePolygon> Merger::polygons() {
  auto faces = facesByDraft();
  std::vector<std::pair<CoarsePolygon, Index>> made;
  for (std::size_t d = 0; d < drafts_.size(); ++d) {
    if (!drafts_[d].loops.empty())
      made.emplace_back(polygonOf(drafts_[d], std::move(faces[d])), Index(d));
  }
  std::sort(made.begin(), made.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.surface, a.first.loops) < std::tie(b.first.surface, b.first.loops);
  });
  std::vector<Index> place(drafts_.size(), kNone);
  std::vector<CoarsePolygon> out;
  out.reserve(made.size());
  for (auto& [polygon, draft] : made) {
    place[draft] = Index(out.size());
    out.push_back(std::move(polygon));
  }
  for (const auto& records : records_) {
    if (records.size() != 2) continue;
    const Index a = place[draft_of_[records[0]]];
    const Index b = place[draft_of_[records[1]]];
    if (a == kNone || b == kNone) continue;
    out[a].opposite = b;
    out[b].opposite = a;
  }
  return out;
}

void Merger::countHiddenSides() {
  for (const Draft& draft : drafts_) {
    const Surface& surface = scene_.surfaces[draft.kind.surface];
    const bool two_sided = scene_.materials[surface.material].two_sided;
    if (two_sided && !draft.kind.both && !draft.loops.empty()) ++report_.hidden_sides;
  }
}

CoarseComplex Merger::run(std::vector<Index>& broken) {
  indexRecords();
  joinRecords();
  sortEdges();
  straightenEdges();
  for (const Draft& draft : drafts_) {
    if (isSound(draft) && std::abs(movedArea(draft)) <= areaInReach(draft)) continue;
    broken.push_back(draft.plane);
  }
  if (!broken.empty()) return {};
  countCuts();
  countHiddenSides();
  accountForStraightening();
  CoarseComplex out;
  out.origin = input_.origin;
  out.coincidence = input_.coincidence;
  out.vertices = numberVertices();
  out.polygons = polygons();
  return out;
}

}  // namespace

void addMovedArea(SurfaceAreas& areas, double moved) {
  if (std::abs(moved) > kAreaRounding * areas.given) areas.degenerate += moved;
}

CoarseComplex mergeCells(const Scene& scene, const InputFaces& input,
                         const std::vector<Plane>& planes, const std::vector<Sheet>& sheets,
                         const EdgeTable& edges, const Arrangement& arrangement,
                         const std::vector<VisibleCell>& visible, MeshReport& report,
                         std::vector<Index>& broken) {
  return Merger(scene, input, planes, sheets, edges, arrangement, visible, report).run(broken);
}

}  // namespace radiosity
