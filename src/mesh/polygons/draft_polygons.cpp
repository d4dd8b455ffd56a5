#include "mesh/polygons/draft_polygons.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/parallel.h"

namespace radiosity {

namespace {

class DraftPolygons {
 public:
  DraftPolygons(const CellsToMerge& cells, const Drafts& drafts, const StraightEdges& straight)
      : cells_(cells), drafts_(drafts), straight_(straight) {}

  CoarseComplex run() {
    CoarseComplex out;
    out.origin = cells_.input.origin;
    out.coincidence = cells_.input.coincidence;
    out.vertices = numberVertices();
    out.polygons = polygons();
    return out;
  }

 private:
  std::vector<Index> sheetsOf(const Draft& draft) const;
  std::vector<std::vector<Index>> facesByDraft() const;
  std::vector<std::pair<Index, Index>> facesBeside(const std::vector<Index>& faces,
                                                   const std::vector<Index>& drafts) const;
  std::vector<Vec3> numberVertices();
  CoarsePolygon polygonOf(const Draft& draft, std::vector<Index> faces) const;
  std::vector<CoarsePolygon> polygons() const;

  const CellsToMerge& cells_;
  const Drafts& drafts_;
  const StraightEdges& straight_;
  std::vector<Index> number_;  ///< by point: vertex of the complex
};

std::vector<Index> DraftPolygons::sheetsOf(const Draft& draft) const {
  std::vector<Index> out;
  out.reserve(draft.records.size());
  for (const Index r : draft.records) out.push_back(cells_.visible[r].sheet);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// By draft, the scene's faces under it; for a sheet that several drafts share, the faces near it.
std::vector<std::vector<Index>> DraftPolygons::facesByDraft() const {
  std::vector<std::vector<Index>> drafts_of(cells_.sheets.size());
  for (std::size_t d = 0; d < drafts_.list.size(); ++d) {
    if (drafts_.list[d].loops.empty()) continue;
    for (const Index s : sheetsOf(drafts_.list[d])) drafts_of[s].push_back(Index(d));
  }
  std::vector<std::vector<Index>> out(drafts_.list.size());
  for (std::size_t s = 0; s < cells_.sheets.size(); ++s) {
    const std::vector<Index>& drafts = drafts_of[s];
    const std::vector<Index>& faces = cells_.sheets[s].faces;
    if (drafts.size() == 1) {
      for (const Index f : faces) out[drafts[0]].push_back(cells_.input.faces[f].source);
    } else if (drafts.size() > 1) {
      for (const auto& [face, draft] : facesBeside(faces, drafts)) {
        out[draft].push_back(cells_.input.faces[face].source);
      }
    }
  }
  parallelFor(out.size(), 256, [&](std::size_t d) {
    std::vector<Index>& faces = out[d];
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  });
  return out;
}

/// Pairs of a face and a draft whose boxes meet.
std::vector<std::pair<Index, Index>> DraftPolygons::facesBeside(
    const std::vector<Index>& faces, const std::vector<Index>& drafts) const {
  std::vector<Box3> boxes;
  const auto add = [&](const std::vector<Index>& loop, double margin) {
    Box3 box;
    for (const Index v : loop) box.add(cells_.input.points[v]);
    boxes.push_back(box.grown(margin));
  };
  for (const Index f : faces) add(cells_.input.faces[f].loop, 0.0);
  std::vector<Index> some;
  for (const Index d : drafts) {
    some.push_back(Index(boxes.size()));
    add(drafts_.list[d].loops[0], cells_.input.coincidence);
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
std::vector<Vec3> DraftPolygons::numberVertices() {
  std::vector<Index> used;
  for (const auto& edge : straight_.edges) used.insert(used.end(), edge.begin(), edge.end());
  parallelSort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  parallelSort(used, [&](Index a, Index b) {
    const Vec3& p = cells_.input.points[a];
    const Vec3& q = cells_.input.points[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  });
  number_.assign(cells_.input.points.size(), kNone);
  std::vector<Vec3> out;
  out.reserve(used.size());
  for (const Index v : used) {
    number_[v] = Index(out.size());
    out.push_back(cells_.input.points[v]);
  }
  return out;
}

CoarsePolygon DraftPolygons::polygonOf(const Draft& draft, std::vector<Index> faces) const {
  CoarsePolygon p;
  p.coincidence = cells_.input.coincidence;
  for (std::vector<Index> loop : draft.loops) {
    p.coincidence = std::min(p.coincidence, coincidenceOf(cells_.input.points, loop));
    for (Index& v : loop) v = number_[v];
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    p.loops.push_back(std::move(loop));
  }
  std::sort(p.loops.begin() + 1, p.loops.end());
  for (const Index e : draft.inner) {
    const auto& ends = straight_.edges[straight_.edge_of[drafts_.needed_number[e]]];
    const auto [low, high] = std::minmax(number_[ends[0]], number_[ends[1]]);
    p.inner_edges.push_back({low, high});
  }
  std::sort(p.inner_edges.begin(), p.inner_edges.end());
  p.inner_edges.erase(std::unique(p.inner_edges.begin(), p.inner_edges.end()), p.inner_edges.end());
  p.normal = cells_.planes[draft.plane].normal * (draft.kind.up ? 1.0 : -1.0);
  p.surface = draft.kind.surface;
  p.back = draft.kind.both;
  p.faces = std::move(faces);
  return p;
}

/// The polygons, in an order that does not depend on the order of the file's faces.
std::vector<CoarsePolygon> DraftPolygons::polygons() const {
  auto faces = facesByDraft();
  std::vector<CoarsePolygon> made(drafts_.list.size());
  parallelFor(made.size(), 256, [&](std::size_t d) {
    if (!drafts_.list[d].loops.empty()) made[d] = polygonOf(drafts_.list[d], std::move(faces[d]));
  });
  std::vector<Index> order;
  order.reserve(made.size());
  for (Index d = 0; d < made.size(); ++d) {
    if (!made[d].loops.empty()) order.push_back(d);
  }
  parallelSort(order, [&](Index a, Index b) {
    return std::tie(made[a].surface, made[a].loops, a) <
           std::tie(made[b].surface, made[b].loops, b);
  });
  std::vector<Index> place(drafts_.list.size(), kNone);
  std::vector<CoarsePolygon> out;
  out.reserve(order.size());
  for (const Index draft : order) {
    place[draft] = Index(out.size());
    out.push_back(std::move(made[draft]));
  }
  for (const auto& records : drafts_.records) {
    if (records.size() != 2) continue;
    const Index a = place[drafts_.draft_of[records[0]]];
    const Index b = place[drafts_.draft_of[records[1]]];
    if (a == kNone || b == kNone) continue;
    out[a].opposite = b;
    out[b].opposite = a;
  }
  return out;
}

}  // namespace

CoarseComplex complexOf(const CellsToMerge& cells, const Drafts& drafts,
                        const StraightEdges& straight) {
  return DraftPolygons(cells, drafts, straight).run();
}

}  // namespace radiosity
