#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "base/parallel.h"
#include "mesh/edge_key.h"
#include "mesh/patches/mesh_figures.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

namespace {

constexpr std::size_t kEdgesAtATime = 1024;  // for each task of a thread

/// Points by their cell in a cubic grid, and rows of cells by a hash.
class PointGrid {
 public:
  PointGrid(const PatchMesh& mesh, const std::vector<Index>& points, const Vec3& lower, double cell)
      : lower_(lower),
        per_metre_(1 / cell),
        mask_(std::bit_ceil(points.size() + 1) - 1),
        begin_(mask_ + 2, 0),
        points_(points.size()) {
    std::vector<Point> in_order(points.size());
    parallelFor(points.size(), 1024, [&](std::size_t k) {
      in_order[k] = {cellOf(mesh.vertices[points[k]]), points[k]};
    });
    for (const Point& point : in_order) ++begin_[slot(point.cell) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (const Point& point : in_order) points_[next[slot(point.cell)]++] = point;
  }

  /// Calls visit(vertex) once for every point in the cells between `low` and `high`.
  template <class Visit>
  void forBox(const Vec3& low, const Vec3& high, const Visit& visit) const {
    const auto a = cellOf(low);
    const auto b = cellOf(high);
    for (long z = a[2]; z <= b[2]; ++z) {
      for (long y = a[1]; y <= b[1]; ++y) {
        for (long x = a[0]; x <= b[0]; ++x) {
          const Cell cell{x, y, z};
          const std::size_t at = slot(cell);
          for (std::size_t k = begin_[at]; k < begin_[at + 1]; ++k) {
            // Several cells may share a slot.
            if (points_[k].cell == cell) visit(points_[k].vertex);
          }
        }
      }
    }
  }

 private:
  using Cell = std::array<long, 3>;
  struct Point {
    Cell cell;
    Index vertex;
  };

  Cell cellOf(const Vec3& p) const {
    const Vec3 c = glm::floor((p - lower_) * per_metre_);
    return {long(c.x), long(c.y), long(c.z)};
  }
  /// Neighbours in x have neighbouring slots.
  std::size_t slot(const Cell& cell) const {
    const std::uint64_t row = std::uint64_t(cell[1]) * 0xc2b2ae3d27d4eb4full ^
                              std::uint64_t(cell[2]) * 0x165667b19e3779f9ull;
    return ((row ^ row >> 32) + std::uint64_t(cell[0])) & mask_;
  }

  Vec3 lower_;
  double per_metre_;                ///< cells
  std::size_t mask_;                ///< slots - 1
  std::vector<std::size_t> begin_;  ///< by slot, into points_
  std::vector<Point> points_;
};

struct Edges {
  std::vector<std::array<Index, 2>> ends;
  std::vector<Index> patch;  ///< a patch with the edge
  double mean_length = 0;
};

Edges distinctEdges(const PatchMesh& mesh) {
  struct Side {
    std::uint64_t key;
    std::size_t corner;  ///< where it begins
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(mesh.corners.size());
  std::vector<std::array<Index, 2>> ends;
  ends.reserve(mesh.corners.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      ends.push_back({outline[k], outline[(k + 1) % outline.size()]});
      sides.push_back({edgeKey(ends.back()[0], ends.back()[1]), ends.size() - 1});
    }
  }
  parallelSort(sides);
  std::vector<char> is_first(ends.size(), 0);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    is_first[sides[k].corner] = k == 0 || sides[k].key != sides[k - 1].key;
  }
  Edges edges;
  std::size_t corner = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (const std::size_t end = corner + mesh.outline(i).size(); corner < end; ++corner) {
      if (!is_first[corner]) continue;
      const auto& [a, b] = ends[corner];
      edges.ends.push_back({a, b});
      edges.patch.push_back(Index(i));
      edges.mean_length += glm::length(mesh.vertices[b] - mesh.vertices[a]);
    }
  }
  if (!edges.ends.empty()) edges.mean_length /= double(edges.ends.size());
  return edges;
}

}  // namespace

std::vector<Index> patchesAtTJunctions(const PatchMesh& mesh, double tolerance) {
  const Edges edges = distinctEdges(mesh);
  std::vector<Index> out;
  if (!(edges.mean_length > 0)) return out;
  Vec3 lower = mesh.vertices[edges.ends[0][0]];
  for (const Vec3& vertex : mesh.vertices) lower = glm::min(lower, vertex);
  const double cell = std::max(edges.mean_length, 4 * tolerance);
  std::vector<Index> points;
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Index vertex : mesh.corners) {
    if (!used[vertex]) points.push_back(vertex);
    used[vertex] = true;
  }
  const PointGrid grid(mesh, points, lower, cell);

  const auto lookAlong = [&](std::size_t e, std::vector<Index>& found) {
    const auto [from, to] = edges.ends[e];
    const Vec3& a = mesh.vertices[from];
    const Vec3 along = mesh.vertices[to] - a;
    const double length = glm::length(along);
    if (length <= 2 * tolerance) return;
    // We walk along long edges in steps of a cell; a point belongs to the step onto which it
    // projects.
    const double steps = std::ceil(length / cell);
    for (double step = 0; step < steps; ++step) {
      const Vec3 p = a + along * (step / steps);
      const Vec3 q = a + along * ((step + 1) / steps);
      grid.forBox(glm::min(p, q) - tolerance, glm::max(p, q) + tolerance, [&](Index vertex) {
        if (vertex == from || vertex == to) return;
        const Vec3 away = mesh.vertices[vertex] - a;
        const double t = glm::dot(away, along) / (length * length);
        if (std::floor(t * steps) != step) return;
        if (t * length <= tolerance || (1 - t) * length <= tolerance) return;
        if (glm::length(away - t * along) <= tolerance) found.push_back(edges.patch[e]);
      });
    }
  };
  std::vector<std::vector<Index>> found((edges.ends.size() + kEdgesAtATime - 1) / kEdgesAtATime);
  parallelFor(found.size(), 1, [&](std::size_t block) {
    const std::size_t end = std::min(edges.ends.size(), (block + 1) * kEdgesAtATime);
    for (std::size_t e = block * kEdgesAtATime; e < end; ++e) lookAlong(e, found[block]);
  });
  for (const auto& some : found) out.insert(out.end(), some.begin(), some.end());
  return out;
}

std::size_t countTJunctions(const PatchMesh& mesh, double tolerance) {
  return patchesAtTJunctions(mesh, tolerance).size();
}

}  // namespace radiosity
