#include "mesh/polygons/straighten_drafts.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "mesh/polygons/edge_crossings.h"
#include "mesh/polygons/trace_loops.h"

namespace radiosity {

namespace {

class DraftStraightener {
 public:
  DraftStraightener(const CellsToMerge& cells, Drafts& drafts) : cells_(cells), drafts_(drafts) {}
  StraightEdges run();

 private:
  EdgeUses usesOfNeeded() const;
  void traceDraft(Draft& draft) const;
  void keepCorners(const Draft& draft, std::vector<bool>& keep, std::vector<Index>& kept) const;
  std::vector<bool> draftsAt(const std::vector<Index>& vertices) const;

  const CellsToMerge& cells_;
  Drafts& drafts_;
  StraightEdges straight_;
};

/// By needed edge, the polygons that it borders and those that it runs through.
EdgeUses DraftStraightener::usesOfNeeded() const {
  EdgeUses out;
  out.begin.assign(drafts_.needed.size() + 1, 0);
  const auto forUses = [&](const auto& visit) {
    for (std::size_t d = 0; d < drafts_.list.size(); ++d) {
      for (const Index e : drafts_.list[d].border) visit(drafts_.needed_number[e], Index(2 * d));
      for (const Index e : drafts_.list[d].inner) visit(drafts_.needed_number[e], Index(2 * d + 1));
    }
  };
  forUses([&](Index edge, Index) { ++out.begin[edge + 1]; });
  std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
  out.numbers.resize(out.begin.back());
  std::vector<std::size_t> next(out.begin.begin(), out.begin.end() - 1);
  forUses([&](Index edge, Index use) { out.numbers[next[edge]++] = use; });
  return out;
}

StraightEdges DraftStraightener::run() {
  std::vector<std::array<Index, 2>> ends;
  ends.reserve(drafts_.needed.size());
  for (const Index e : drafts_.needed) ends.push_back({cells_.edges[e].a, cells_.edges[e].b});
  const EdgeUses uses = usesOfNeeded();
  std::vector<bool> keep(cells_.input.points.size(), false);
  std::vector<bool> stale(drafts_.list.size(), true);
  while (std::find(stale.begin(), stale.end(), true) != stale.end()) {
    straight_ = straighten(cells_.input.points, ends, uses, keep);
    std::vector<char> sound(drafts_.list.size(), 1);
    parallelFor(drafts_.list.size(), 256, [&](std::size_t d) {
      if (!stale[d]) return;
      traceDraft(drafts_.list[d]);
      sound[d] = isSound(cells_, drafts_, straight_, drafts_.list[d]) ? 1 : 0;
    });
    std::vector<Index> kept;
    for (std::size_t d = 0; d < drafts_.list.size(); ++d) {
      if (sound[d] == 0) keepCorners(drafts_.list[d], keep, kept);
    }
    stale = draftsAt(kept);
  }
  return std::move(straight_);
}

/// Marks the drafts with one of `vertices`.
std::vector<bool> DraftStraightener::draftsAt(const std::vector<Index>& vertices) const {
  std::vector<bool> out(drafts_.list.size(), false);
  if (vertices.empty()) return out;
  std::vector<bool> there(cells_.input.points.size(), false);
  for (const Index v : vertices) there[v] = true;
  const auto touches = [&](Index e) {
    return there[cells_.edges[e].a] || there[cells_.edges[e].b];
  };
  for (std::size_t d = 0; d < drafts_.list.size(); ++d) {
    out[d] = std::any_of(drafts_.list[d].border.begin(), drafts_.list[d].border.end(), touches) ||
             std::any_of(drafts_.list[d].inner.begin(), drafts_.list[d].inner.end(), touches);
  }
  return out;
}

/// Keeps all vertices of a draft; appends those that had been removed.
void DraftStraightener::keepCorners(const Draft& draft, std::vector<bool>& keep,
                                    std::vector<Index>& kept) const {
  for (const auto* list : {&draft.border, &draft.inner}) {
    for (const Index e : *list) {
      for (const Index v : {cells_.edges[e].a, cells_.edges[e].b}) {
        if (straight_.removed[v] && !keep[v]) kept.push_back(v);
        keep[v] = true;
      }
    }
  }
}

void DraftStraightener::traceDraft(Draft& draft) const {
  draft.loops.clear();
  const PlaneImage frame(cells_.planes[draft.plane].normal);
  std::vector<std::array<Index, 2>> directed;
  directed.reserve(draft.border.size());
  for (std::size_t k = 0; k < draft.border.size(); ++k) {
    const Edge& e = cells_.edges[draft.border[k]];
    if (draft.on_left[k]) {
      directed.push_back({e.a, e.b});
    } else {
      directed.push_back({e.b, e.a});
    }
  }
  std::vector<std::pair<double, std::vector<Index>>> loops;
  for (auto& loop : traceLoops(cells_.input.points, frame, directed)) {
    std::erase_if(loop, [&](Index v) { return straight_.removed[v]; });
    if (loop.size() < 3) continue;
    const Vec3 area =
        vectorArea(loop.size(), [&](std::size_t k) { return cells_.input.points[loop[k]]; });
    if (!draft.kind.up) std::reverse(loop.begin(), loop.end());
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    loops.emplace_back(-glm::dot(area, cells_.planes[draft.plane].normal), std::move(loop));
  }
  // The outer loop has the largest positive area. If no area is positive, welding has bent a sliver
  // out of its plane.
  std::sort(loops.begin(), loops.end());
  if (loops.empty() || loops[0].first >= 0) return;
  for (auto& [key, loop] : loops) draft.loops.push_back(std::move(loop));
}

/// The edges of a draft after straightening, inner ones included.
std::vector<std::array<Index, 2>> edgesOf(const Drafts& drafts, const StraightEdges& straight,
                                          const Draft& draft) {
  std::vector<std::array<Index, 2>> out;
  for (const auto& loop : draft.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      out.push_back({loop[k], loop[(k + 1) % loop.size()]});
    }
  }
  std::vector<Index> inner;
  inner.reserve(draft.inner.size());
  for (const Index e : draft.inner) inner.push_back(straight.edge_of[drafts.needed_number[e]]);
  std::sort(inner.begin(), inner.end());
  inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
  for (const Index e : inner) out.push_back(straight.edges[e]);
  return out;
}

}  // namespace

StraightEdges straightenDrafts(const CellsToMerge& cells, Drafts& drafts) {
  return DraftStraightener(cells, drafts).run();
}

bool isSound(const CellsToMerge& cells, const Drafts& drafts, const StraightEdges& straight,
             const Draft& draft) {
  const bool triangle = draft.loops.size() == 1 && draft.loops[0].size() == 3;
  if (draft.inner.empty() && (triangle || draft.loops.empty())) return true;
  return !anyCross(cells.input.points, PlaneImage(cells.planes[draft.plane].normal),
                   edgesOf(drafts, straight, draft));
}

}  // namespace radiosity
