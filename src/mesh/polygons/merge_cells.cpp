#include "mesh/polygons/merge_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "mesh/polygons/cell_drafts.h"
#include "mesh/polygons/draft_polygons.h"
#include "mesh/polygons/straighten_drafts.h"

namespace radiosity {

namespace {

/// The effects of merging on the scene, for the report.
class MergeAccount {
 public:
  MergeAccount(const CellsToMerge& cells, const Drafts& drafts, const StraightEdges& straight)
      : cells_(cells), drafts_(drafts), straight_(straight) {}

  bool isAreaKept(const Draft& draft) const {
    return std::abs(movedArea(draft)) <= areaInReach(draft);
  }
  void countCuts(MeshReport& report) const;
  void countHiddenSides(const Scene& scene, MeshReport& report) const;
  void accountForStraightening(MeshReport& report) const;

 private:
  bool isCutThere(const EdgeSides& sides) const;
  double movedArea(const Draft& draft) const;
  double areaInReach(const Draft& draft) const;

  const CellsToMerge& cells_;
  const Drafts& drafts_;
  const StraightEdges& straight_;
};

/// Whether the edge cuts a sheet: the sheet continues on both sides, and the edge is needed there.
bool MergeAccount::isCutThere(const EdgeSides& s) const {
  if (s.left == kNone || s.right == kNone) return false;
  if (drafts_.recordsOf(s.left).empty() && drafts_.recordsOf(s.right).empty()) return false;
  const auto& left = cells_.arrangement.cells[s.left].cover;
  const auto& right = cells_.arrangement.cells[s.right].cover;
  return std::any_of(left.begin(), left.end(), [&](const auto& l) {
    return std::any_of(right.begin(), right.end(),
                       [&](const auto& r) { return l.first == r.first; });
  });
}

void MergeAccount::countCuts(MeshReport& report) const {
  std::vector<bool> cut(straight_.edges.size(), false);
  for (std::size_t k = 0; k < drafts_.needed.size(); ++k) {
    const auto& at_edge = cells_.arrangement.sides[drafts_.needed[k]];
    if (std::any_of(at_edge.begin(), at_edge.end(),
                    [&](const EdgeSides& s) { return isCutThere(s); })) {
      cut[straight_.edge_of[k]] = true;
    }
  }
  report.cuts = std::size_t(std::count(cut.begin(), cut.end(), true));
}

/// The area by which the loops of a draft fall short of its cells.
double MergeAccount::movedArea(const Draft& draft) const {
  double area = 0;
  for (const Index r : draft.records) area += cells_.arrangement.cells[cells_.visible[r].cell].area;
  Vec3 kept(0.0);
  for (const auto& loop : draft.loops) {
    kept += vectorArea(loop.size(), [&](std::size_t k) { return cells_.input.points[loop[k]]; });
  }
  return area - std::abs(glm::dot(kept, cells_.planes[draft.plane].normal));
}

/// The most area that straightening can move: a strip of two coincidences along the border, times
/// two for rounding.
double MergeAccount::areaInReach(const Draft& draft) const {
  const WeldedPoints& points = cells_.input.points;
  double area = 0;
  for (const Index e : draft.border) {
    const Edge& edge = cells_.edges[e];
    area += coincidenceOf(points, std::array{edge.a, edge.b}) *
            glm::distance(points[edge.a], points[edge.b]);
  }
  return 4.0 * area;
}

void MergeAccount::accountForStraightening(MeshReport& report) const {
  std::vector<double> moved(report.surfaces.size(), 0.0);
  for (const Draft& draft : drafts_.list) moved[draft.kind.surface] += movedArea(draft);
  for (std::size_t s = 0; s < moved.size(); ++s) addMovedArea(report.surfaces[s], moved[s]);
}

void MergeAccount::countHiddenSides(const Scene& scene, MeshReport& report) const {
  for (const Draft& draft : drafts_.list) {
    const Surface& surface = scene.surfaces[draft.kind.surface];
    const bool two_sided = scene.materials[surface.material].two_sided;
    if (two_sided && !draft.kind.both && !draft.loops.empty()) ++report.hidden_sides;
  }
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
  const CellsToMerge cells{input, planes, sheets, edges, arrangement, visible};
  Drafts drafts = draftsOf(cells);
  const StraightEdges straight = straightenDrafts(cells, drafts);
  const MergeAccount account(cells, drafts, straight);
  std::vector<char> good(drafts.list.size(), 0);
  parallelFor(good.size(), 256, [&](std::size_t d) {
    const Draft& draft = drafts.list[d];
    good[d] = isSound(cells, drafts, straight, draft) && account.isAreaKept(draft) ? 1 : 0;
  });
  for (std::size_t d = 0; d < good.size(); ++d) {
    if (good[d] == 0) broken.push_back(drafts.list[d].plane);
  }
  if (!broken.empty()) return {};
  account.countCuts(report);
  account.countHiddenSides(scene, report);
  account.accountForStraightening(report);
  return complexOf(cells, drafts, straight);
}

}  // namespace radiosity
