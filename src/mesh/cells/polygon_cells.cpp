#include "mesh/cells/polygon_cells.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "base/geometry/plane_frame.h"
#include "mesh/plane_image.h"

namespace radiosity {

namespace {

/// The points of one side, both ends included.
std::vector<Index> sidePoints(const EdgeCuts& cuts, const std::vector<DirectedEdge>& side) {
  std::vector<Index> ids;
  for (const DirectedEdge& edge : side) cuts.append(edge, ids);
  ids.push_back(cuts.lastOf(side.back()));
  return ids;
}

/// The places of a side's points between its ends, 0 to 1.
std::vector<double> fractions(const EdgeCuts& cuts, const std::vector<Index>& side) {
  const Vec3 start = cuts.point(side.front());
  const double length = glm::length(cuts.point(side.back()) - start);
  std::vector<double> result;
  result.reserve(side.size());
  for (Index id : side) result.push_back(glm::length(cuts.point(id) - start) / length);
  return result;
}

/// Whether two opposite sides have their points in the same places.
bool cutAlike(double coincidence, const EdgeCuts& cuts, const std::vector<Index>& side,
              const std::vector<Index>& opposite) {
  if (side.size() != opposite.size()) return false;
  const std::vector<double> s = fractions(cuts, side);
  const std::vector<double> t = fractions(cuts, {opposite.rbegin(), opposite.rend()});
  const double length = glm::length(cuts.point(side.back()) - cuts.point(side.front()));
  for (std::size_t k = 0; k < s.size(); ++k) {
    // The sides are divided alike within the coincidence, or by equal fractions but for rounding.
    if (std::abs(s[k] - t[k]) * length > coincidence + 1e-12 * length) return false;
  }
  return true;
}

/// The bilinear grid over the four corners. Lines of constant s or t are straight, so that every
/// cell of a convex quadrilateral is convex.
PolygonCells gridCells(const EdgeCuts& cuts, const FourSides& sides,
                       const std::array<std::vector<Index>, 4>& points) {
  const std::size_t columns = points[0].size();
  const std::size_t rows = points[1].size();
  const std::vector<double> s = fractions(cuts, points[0]);
  const std::vector<double> t = fractions(cuts, points[1]);
  std::array<Vec3, 4> p;
  for (std::size_t k = 0; k < 4; ++k) p[k] = cuts.point(sides.corners[k]);

  PolygonCells result;
  for (const auto& side : points) {
    result.boundary.insert(result.boundary.end(), side.begin(), side.end() - 1);
  }
  for (std::size_t j = 1; j + 1 < rows; ++j) {
    for (std::size_t i = 1; i + 1 < columns; ++i) {
      const Vec3 low = p[0] + s[i] * (p[1] - p[0]);
      const Vec3 high = p[3] + s[i] * (p[2] - p[3]);
      result.interior.push_back(low + t[j] * (high - low));
    }
  }
  const std::size_t around = result.boundary.size();
  const std::size_t last_column = columns - 1;
  const std::size_t last_row = rows - 1;
  const auto corner = [&](std::size_t i, std::size_t j) -> Index {
    if (j == 0) return Index(i);
    if (i == last_column) return Index(last_column + j);
    if (j == last_row) return Index(last_column + last_row + (last_column - i));
    if (i == 0) return Index((around - j) % around);
    return Index(around + (j - 1) * (last_column - 1) + (i - 1));
  };
  for (std::size_t j = 0; j < last_row; ++j) {
    for (std::size_t i = 0; i < last_column; ++i) {
      result.cells.push_back(
          {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
    }
  }
  return result;
}

/// Flattens a polygon: by a frame, in which lengths and angles are true, or by the image, in which
/// the polygon is known not to cross itself.
class Flattening {
 public:
  Flattening(const PlaneFrame& frame, bool exact) : frame_(frame), image_(frame.n), exact_(exact) {}

  Vec2 flat(const Vec3& p) const { return exact_ ? image_(p) : frame_.flat(p); }
  Vec3 lift(const Vec2& p) const {
    return exact_ ? image_.lift(p, frame_.origin, frame_.n) : frame_.lift(p);
  }
  Vec2 along() const {
    return exact_ ? image_(frame_.u) / glm::length(image_(frame_.u)) : Vec2(1.0, 0.0);
  }

 private:
  PlaneFrame frame_;
  PlaneImage image_;
  bool exact_;
};

/// Gathers the boundary of a polygon, each point once, in flat coordinates.
class RegionBuilder {
 public:
  RegionBuilder(const CoarseComplex& complex, const EdgeCuts& cuts, std::size_t polygon, bool exact)
      : cuts_(cuts), flattening_(frameOf(complex, complex.polygons[polygon]), exact) {
    const CoarsePolygon& coarse = complex.polygons[polygon];
    region_.along = flattening_.along();
    for (std::size_t l = 0; l < coarse.loops.size(); ++l) {
      std::vector<Index> ids;
      for (const DirectedEdge& edge : cuts.loop(polygon, l)) cuts.append(edge, ids);
      auto& loop = region_.loops.emplace_back();
      for (Index id : ids) loop.push_back(local(id));
    }
    for (const auto& [from, to] : coarse.inner_edges) {
      std::vector<Index> ids;
      cuts.append(cuts.find(from, to), ids);
      ids.push_back(to);
      for (std::size_t k = 0; k + 1 < ids.size(); ++k) {
        region_.inner.push_back({local(ids[k]), local(ids[k + 1])});
      }
    }
  }

  Region& region() { return region_; }
  const Flattening& flattening() const { return flattening_; }
  std::vector<Index>& boundary() { return boundary_; }

 private:
  /// A frame along the longest edge.
  static PlaneFrame frameOf(const CoarseComplex& complex, const CoarsePolygon& polygon) {
    Vec3 longest(0.0);
    for (const auto& loop : polygon.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3 edge = complex.vertices[loop[(k + 1) % loop.size()]] - complex.vertices[loop[k]];
        if (glm::dot(edge, edge) > glm::dot(longest, longest)) longest = edge;
      }
    }
    return makeFrame(complex.vertices[polygon.loops[0][0]], polygon.normal, longest);
  }

  Index local(Index id) {
    const auto [place, is_new] = local_.try_emplace(id, Index(boundary_.size()));
    if (is_new) {
      boundary_.push_back(id);
      region_.points.push_back(flattening_.flat(cuts_.point(id)));
    }
    return place->second;
  }

  const EdgeCuts& cuts_;
  Flattening flattening_;
  Region region_;
  std::vector<Index> boundary_;
  std::unordered_map<Index, Index> local_;
};

/// The cells of a polygon; empty if the pieces of its boundary cross.
std::optional<PolygonCells> regionCells(const CoarseComplex& complex, const EdgeCuts& cuts,
                                        std::size_t polygon, const CellSize& size, bool exact) {
  RegionBuilder builder(complex, cuts, polygon, exact);
  Region& region = builder.region();
  region.size = size.size;
  region.longest = size.longest;
  region.improve = size.improve;
  region.clearance = 2 * complex.coincidenceOf(complex.polygons[polygon]);
  auto mesh = meshRegion(region);
  if (!mesh) return std::nullopt;
  PolygonCells result;
  result.cells = std::move(mesh->cells);
  result.boundary = std::move(builder.boundary());
  result.inner = std::move(region.inner);
  for (const Vec2& p : mesh->interior) result.interior.push_back(builder.flattening().lift(p));
  return result;
}

}  // namespace

std::optional<PolygonCells> cellsOf(const CoarseComplex& complex, const EdgeCuts& cuts,
                                    std::size_t polygon, const CellSize& size) {
  if (const auto& sides = cuts.fourSides(polygon)) {
    std::array<std::vector<Index>, 4> points;
    for (std::size_t k = 0; k < 4; ++k) points[k] = sidePoints(cuts, sides->edges[k]);
    const double coincidence = complex.coincidenceOf(complex.polygons[polygon]);
    if (cutAlike(coincidence, cuts, points[0], points[2]) &&
        cutAlike(coincidence, cuts, points[1], points[3])) {
      return gridCells(cuts, *sides, points);
    }
  }
  auto cells = regionCells(complex, cuts, polygon, size, false);
  return cells ? cells : regionCells(complex, cuts, polygon, size, true);
}

}  // namespace radiosity
