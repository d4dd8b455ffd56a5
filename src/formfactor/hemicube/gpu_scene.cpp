#include "formfactor/hemicube/gpu_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "base/geometry/box_tree.h"
#include "base/parallel.h"
#include "formfactor/view_triangles.h"

namespace radiosity {
namespace {

std::array<double, 3> numbers(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Finds the vertices that lie on an edge, to within coincidence, its ends left out.
class EdgeVertices {
 public:
  EdgeVertices(const std::vector<Vec3>& vertices, double coincidence)
      : vertices_(vertices), coincidence_(coincidence) {
    std::vector<Box3> boxes;
    boxes.reserve(vertices.size());
    for (const Vec3& v : vertices) boxes.push_back({v, v});
    tree_ = BoxTree(boxes);
  }

  /// True if the triangle is at most four coincidences high: it cannot be told from a line.
  bool isThin(const std::array<Index, 3>& triangle) const {
    const Vec3 u = vertices_[triangle[1]] - vertices_[triangle[0]];
    const Vec3 v = vertices_[triangle[2]] - vertices_[triangle[0]];
    const double longest = std::max({glm::length(u), glm::length(v), glm::length(v - u)});
    return !(glm::length(glm::cross(u, v)) > 4 * coincidence_ * longest);
  }

  /// The vertices from `a` to `b`: those from `b` to `a` in reverse.
  std::vector<Index> between(Index a, Index b) const {
    if (a > b) {
      std::vector<Index> found = between(b, a);
      std::reverse(found.begin(), found.end());
      return found;
    }
    const Vec3 from = vertices_[a];
    const Vec3 edge = vertices_[b] - from;
    const double squared = glm::dot(edge, edge);
    std::vector<std::pair<double, Index>> found;
    if (!(squared > 0)) return {};
    const auto distanceOf = [&](const Vec3& p) {
      const double along = std::clamp(glm::dot(p - from, edge) / squared, 0.0, 1.0);
      return glm::distance(p, from + along * edge);
    };
    tree_.search(
        [&](const Box3& box) {
          return distanceOf(box.centre()) <= 0.5 * box.diagonal() + 2 * coincidence_;
        },
        [&](Index v) {
          const Vec3& p = vertices_[v];
          // Vertices that coincide with an end cut nothing off.
          const bool at_end = glm::distance(p, from) <= coincidence_ ||
                              glm::distance(p, vertices_[b]) <= coincidence_;
          if (!at_end && distanceOf(p) <= coincidence_) {
            found.emplace_back(glm::dot(p - from, edge) / squared, v);
          }
          return true;
        });
    std::sort(found.begin(), found.end());
    std::vector<Index> ordered;
    ordered.reserve(found.size());
    for (const auto& [along, v] : found) ordered.push_back(v);
    return ordered;
  }

 private:
  const std::vector<Vec3>& vertices_;
  double coincidence_;
  BoxTree tree_;
};

/// Cuts a triangle from a vertex on an edge to the corner opposite, and its parts likewise. `used`:
/// its corners and those of the triangles that it was cut from. None of these cuts again: where a
/// vertex lies close beside an obtuse corner, the cut from it passes by that corner, and cutting
/// there would bring back the triangle of before.
void appendCut(const std::array<Index, 3>& triangle, Index polygon, const EdgeVertices& on,
               std::vector<Index>& used, std::vector<GpuTriangle>& parts) {
  for (std::size_t k = 0; k < 3 && !on.isThin(triangle); ++k) {
    const Index a = triangle[k];
    const Index b = triangle[(k + 1) % 3];
    const Index c = triangle[(k + 2) % 3];
    std::vector<Index> between = on.between(a, b);
    std::erase_if(between, [&](Index v) { return std::ranges::find(used, v) != used.end(); });
    if (between.empty()) continue;
    const Index middle = between[between.size() / 2];
    used.push_back(middle);
    appendCut({a, middle, c}, polygon, on, used, parts);
    appendCut({middle, b, c}, polygon, on, used, parts);
    used.pop_back();
    return;
  }
  parts.push_back({triangle[0], triangle[1], triangle[2], polygon});
}

}  // namespace

GpuScene::GpuScene(const ViewScene& scene, const PatchMesh& mesh)
    : coincidence(scene.coincidence), items(std::uint32_t(scene.items)), cells(scene.cells) {
  addGrids(scene);
  addPolygons(scene);
  ViewTriangles all(scene, mesh);
  vertices = std::move(all.vertices);
  const EdgeVertices on(vertices, coincidence);
  std::vector<std::vector<GpuTriangle>> cut(all.triangles.size());
  parallelFor(cut.size(), 64, [&](std::size_t t) {
    const std::array<Index, 3>& triangle = all.triangles[t];
    std::vector<Index> used(triangle.begin(), triangle.end());
    appendCut(triangle, all.polygon_of[t], on, used, cut[t]);
  });
  for (const std::vector<GpuTriangle>& parts : cut) {
    triangles.insert(triangles.end(), parts.begin(), parts.end());
  }
  // At equal depths the polygon that is drawn first stays.
  std::stable_sort(triangles.begin(), triangles.end(),
                   [](const GpuTriangle& a, const GpuTriangle& b) { return a[3] < b[3]; });
}

void GpuScene::addGrids(const ViewScene& scene) {
  for (std::size_t g = 0; g < scene.grids.size(); ++g) {
    const PatchGrid& grid = scene.grids[g];
    grids.push_back({numbers(grid.uAxis()), numbers(grid.vAxis()), grid.uOffset(), grid.vOffset(),
                     grid.columns(), grid.rows(), scene.first_cell[g], std::int32_t(nodes.size())});
    for (const CellNode& node : grid.nodes()) {
      nodes.push_back({float(node.a), float(node.b), float(node.c), node.inside, node.outside});
    }
  }
}

void GpuScene::addPolygons(const ViewScene& scene) {
  for (const ViewPolygon& polygon : scene.polygons) {
    const auto [front, back] = polygon.side;
    polygons.push_back({numbers(polygon.normal),
                        numbers(polygon.origin),
                        scene.loop_offset[polygon.loop_begin],
                        scene.loop_offset[polygon.loop_end],
                        {std::int32_t(front.item), std::int32_t(back.item)},
                        {std::int32_t(front.grid), std::int32_t(back.grid)}});
  }
  corners = scene.corners;
}

}  // namespace radiosity
