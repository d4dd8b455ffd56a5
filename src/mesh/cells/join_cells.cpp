#include "mesh/cells/join_cells.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <queue>
#include <utility>

#include "base/geometry/plane_frame.h"
#include "mesh/cells/join_loops.h"
#include "mesh/triangulate.h"

namespace radiosity {
namespace {

using CornerPair = std::pair<Index, Index>;

/// The largest squared perimeter over area of a compact patch: a square has 16, a rectangle 1 : 3
/// and an L of three squares 21.3. A worse patch may only come from worse parts.
constexpr double kCompact = 22;

/// Whether a patch is lower than `thinnest` over its longest edge.
bool isThinPatch(std::span<const Index> outline, std::span<const Vec3> points, double area,
                 double thinnest) {
  double longest = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    longest = std::max(
        longest, glm::distance(points[outline[i]], points[outline[(i + 1) % outline.size()]]));
  }
  return 2 * area <= thinnest * longest;
}

std::span<const Index> outlineOf(const Cell& cell) {
  return {cell.data(), cell.size() - (cell[3] == kNone ? 1 : 0)};
}

class CellJoiner {
 public:
  CellJoiner(std::span<const Cell> cells, std::span<const std::array<Index, 2>> inner,
             std::span<const Vec3> points, const JoinLimits& limits)
      : points_(points), size_(limits.size), thinnest_(limits.thinnest) {
    for (const auto& [from, to] : inner) {
      kept_.emplace_back(from, to);
      kept_.emplace_back(to, from);
    }
    std::ranges::sort(kept_);
    patches_.reserve(cells.size());
    for (Index c = 0; c < cells.size(); ++c) add(cells[c], c);
    std::ranges::sort(owner_, {}, &Owner::edge);
  }

  std::vector<CellGroup> run() {
    std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns;
    for (Index k = 0; k < patches_.size(); ++k) turns.push({patches_[k].area, k});
    while (!turns.empty()) {
      const auto [area, k] = turns.top();
      turns.pop();
      if (patches_[k].group.cells.empty() || patches_[k].area != area) continue;
      if (joinOne(k)) turns.push({patches_[k].area, k});
    }
    std::vector<CellGroup> out;
    for (Patch& patch : patches_) {
      if (!patch.group.cells.empty()) out.push_back(std::move(patch.group));
    }
    return out;
  }

 private:
  using Turn = std::pair<double, Index>;  ///< area and number of a patch
  struct Patch {
    CellGroup group;  ///< no cells: the patch has become part of another
    double area = 0;
    Vec3 moment{0.0};  ///< area times centroid
    double shape = 0;  ///< see shapeOf()
    bool thin = false;
  };

  void add(const Cell& cell, Index c) {
    Patch& patch = patches_.emplace_back();
    patch.group.outline.assign(outlineOf(cell).begin(), outlineOf(cell).end());
    patch.group.cells = {c};
    const std::vector<Index>& outline = patch.group.outline;
    for (std::size_t k = 2; k < outline.size(); ++k) {
      const Vec3& a = points_[outline[0]];
      const Vec3& b = points_[outline[k - 1]];
      const Vec3& d = points_[outline[k]];
      const double area = 0.5 * glm::length(glm::cross(b - a, d - a));
      patch.area += area;
      patch.moment += area * (a + b + d) / 3.0;
    }
    patch.shape = shapeOf(outline, patch.area);
    patch.thin = isThin(outline, patch.area);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      owner_.push_back({{outline[i], outline[(i + 1) % outline.size()]}, c});
    }
  }

  /// The patch on the left of a directed edge, or nullptr.
  Index* ownerOf(const CornerPair& edge) {
    const auto at = std::ranges::lower_bound(owner_, edge, {}, &Owner::edge);
    return at != owner_.end() && at->edge == edge ? &at->patch : nullptr;
  }

  void own(Index k) {
    const std::vector<Index>& outline = patches_[k].group.outline;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      *ownerOf({outline[i], outline[(i + 1) % outline.size()]}) = k;
    }
  }

  /// The union of a patch and a neighbour.
  struct Union {
    Index other = kNone;
    std::vector<Index> outline;
    double shape = 0;
  };

  /// Joins a patch with the neighbour that gives the most compact union; false if no neighbour is
  /// allowed.
  bool joinOne(Index k) {
    Union best;
    for (const Index other : neighbours(k)) {
      Union joined = unionWith(k, other);
      if (joined.outline.empty()) continue;
      if (best.other == kNone || joined.shape < best.shape) best = std::move(joined);
    }
    if (best.other == kNone) return false;
    Patch& a = patches_[k];
    Patch& b = patches_[best.other];
    a.group.outline = std::move(best.outline);
    a.group.cells.insert(a.group.cells.end(), b.group.cells.begin(), b.group.cells.end());
    a.area += b.area;
    a.moment += b.moment;
    a.shape = best.shape;
    a.thin = isThin(a.group.outline, a.area);
    b.group = {};
    own(k);
    return true;
  }

  /// The union of two patches; it has no outline if they may not be joined.
  Union unionWith(Index k, Index other) const {
    const Patch& a = patches_[k];
    const Patch& b = patches_[other];
    const bool any = a.thin || b.thin;
    const double area = a.area + b.area;
    if (!any && area > size_ * size_) return {};
    std::vector<Index> outline = joinLoops(a.group.outline, b.group.outline);
    if (outline.empty()) return {};
    if (!any && !isWithinReach(outline, (a.moment + b.moment) / area)) return {};
    const double shape = shapeOf(outline, area);
    if (!any && shape > std::max({kCompact, a.shape, b.shape})) return {};
    return {other, std::move(outline), shape};
  }

  bool isThin(const std::vector<Index>& outline, double area) const {
    return isThinPatch(outline, points_, area, thinnest_);
  }

  bool isWithinReach(const std::vector<Index>& outline, const Vec3& centroid) const {
    return std::all_of(outline.begin(), outline.end(),
                       [&](Index v) { return glm::distance(points_[v], centroid) <= size_; });
  }

  /// Square of the perimeter over the area.
  double shapeOf(const std::vector<Index>& outline, double area) const {
    double perimeter = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      perimeter += glm::distance(points_[outline[i]], points_[outline[(i + 1) % outline.size()]]);
    }
    return perimeter * perimeter / area;
  }

  /// Ascending.
  std::vector<Index> neighbours(Index k) {
    std::vector<Index> out;
    const std::vector<Index>& outline = patches_[k].group.outline;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const CornerPair across(outline[(i + 1) % outline.size()], outline[i]);
      const Index* const owner = ownerOf(across);
      if (owner == nullptr || *owner == k || std::ranges::binary_search(kept_, across)) continue;
      out.push_back(*owner);
    }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  /// A directed edge and the patch on its left.
  struct Owner {
    CornerPair edge;
    Index patch;
  };

  std::span<const Vec3> points_;
  double size_;
  double thinnest_;
  std::vector<CornerPair> kept_;  ///< ascending
  std::vector<Patch> patches_;
  std::vector<Owner> owner_;  ///< ascending by edge
};

/// If a corner of the cells is inside the patch, sets triangles between the corners of its outline,
/// so that only values at these are needed.
void dropInnerCorners(CellGroup& group, std::span<const Cell> cells, std::span<const Vec3> points) {
  std::vector<Index> corners = group.outline;
  std::sort(corners.begin(), corners.end());
  const bool inside = std::any_of(group.cells.begin(), group.cells.end(), [&](Index c) {
    return std::any_of(cells[c].begin(), cells[c].end(), [&](Index v) {
      return v != kNone && !std::binary_search(corners.begin(), corners.end(), v);
    });
  });
  if (!inside) return;
  const Vec3 area =
      vectorArea(group.outline.size(), [&](std::size_t k) { return points[group.outline[k]]; });
  const PlaneFrame frame =
      makeFrame(points[group.outline[0]], glm::normalize(area), axisAcross(area));
  std::vector<Vec2> flat;
  flat.reserve(group.outline.size());
  for (const Index v : group.outline) flat.push_back(frame.flat(points[v]));
  const auto triangles = delaunayTriangles(flat);
  if (!triangles) return;
  for (const auto& [a, b, c] : *triangles) {
    group.triangles.push_back({group.outline[a], group.outline[b], group.outline[c]});
  }
}

}  // namespace

bool anyThin(std::span<const Cell> cells, std::span<const Vec3> points, double thinnest) {
  return std::ranges::any_of(cells, [&](const Cell& cell) {
    const std::span<const Index> outline = outlineOf(cell);
    const Vec3 area = vectorArea(outline.size(), [&](std::size_t k) { return points[outline[k]]; });
    return isThinPatch(outline, points, glm::length(area), thinnest);
  });
}

std::vector<CellGroup> joinCells(std::span<const Cell> cells,
                                 std::span<const std::array<Index, 2>> inner,
                                 std::span<const Vec3> points, const JoinLimits& limits) {
  std::vector<CellGroup> groups = CellJoiner(cells, inner, points, limits).run();
  for (CellGroup& group : groups) {
    std::sort(group.cells.begin(), group.cells.end());
    dropInnerCorners(group, cells, points);
  }
  std::sort(groups.begin(), groups.end(), [](const CellGroup& a, const CellGroup& b) {
    return a.cells.front() < b.cells.front();
  });
  return groups;
}

}  // namespace radiosity
