#include "formfactor/view_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "base/geometry/box.h"
#include "base/parallel.h"
#include "mesh/patches/enclosures.h"
#include "mesh/triangulate.h"

namespace radiosity {
namespace {

/// 2^-k with 2^k about the length; 1 for an empty scene.
double powerOfTwoBelow(double length) {
  if (!(length > 0)) return 1;
  int exponent = 0;
  std::frexp(length, &exponent);
  return std::ldexp(1.0, -exponent);
}

bool isConvex(const PatchMesh& mesh, std::size_t patch) {
  const std::span<const Index> outline = mesh.outline(patch);
  const std::size_t n = outline.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& a = mesh.vertices[outline[k]];
    const Vec3& b = mesh.vertices[outline[(k + 1) % n]];
    const Vec3& c = mesh.vertices[outline[(k + 2) % n]];
    if (glm::dot(glm::cross(b - a, c - b), mesh.normal[patch]) < 0) return false;
  }
  return true;
}

}  // namespace

void appendPieces(const PatchMesh& mesh, std::size_t patch, double scale,
                  std::vector<GridPiece>& pieces) {
  const auto item = std::int32_t(patch);
  const std::span<const Index> outline = mesh.outline(patch);
  // A star-shaped outline that turns one way throughout has five corners or more.
  if (outline.size() <= 4 && isConvex(mesh, patch)) {
    GridPiece piece{{}, item};
    for (const Index vertex : outline) piece.corners.push_back(mesh.vertices[vertex] * scale);
    pieces.push_back(std::move(piece));
    return;
  }
  for (std::size_t t = mesh.piece_offset[patch]; t < mesh.piece_offset[patch + 1]; ++t) {
    GridPiece piece{{}, item};
    for (const Index vertex : mesh.pieces[t]) {
      piece.corners.push_back(mesh.vertices[vertex] * scale);
    }
    const Vec3 a = piece.corners[1] - piece.corners[0];
    const Vec3 b = piece.corners[2] - piece.corners[0];
    if (glm::dot(glm::cross(a, b), mesh.normal[patch]) > 0) pieces.push_back(std::move(piece));
  }
}

ViewScene::ViewScene(const PatchMesh& mesh)
    : patches(mesh.size()),
      items(mesh.size() + mesh.surface_names.size()),
      scale(powerOfTwoBelow(boxOf(mesh.vertices).diagonal())),
      coincidence(coincidenceOf(mesh) * scale) {
  addPolygons(mesh);
  addSides(mesh);
  numberCells();
}

/// Collects the polygons' vertices, equal points once (files give each face its own), in an order
/// of their values. Returns each mesh vertex's place.
std::vector<Index> ViewScene::packVertices(const PatchMesh& mesh) {
  const auto key = [&](Index v) {
    return std::tie(mesh.vertices[v].x, mesh.vertices[v].y, mesh.vertices[v].z);
  };
  std::vector<Index> used = mesh.polygons.corners;
  std::sort(used.begin(), used.end(), [&](Index a, Index b) { return key(a) < key(b); });
  std::vector<Index> packed(mesh.vertices.size(), kNone);
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (k == 0 || key(used[k - 1]) != key(used[k])) {
      vertices.push_back(mesh.vertices[used[k]] * scale);
    }
    packed[used[k]] = Index(vertices.size() - 1);
  }
  return packed;
}

void ViewScene::addPolygons(const PatchMesh& mesh) {
  const PlanarPolygons& source = mesh.polygons;
  std::vector<Index> order(source.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tie(mesh.surface_names[source.surface[a]], source.index_in_surface[a]) <
           std::tie(mesh.surface_names[source.surface[b]], source.index_in_surface[b]);
  });
  const std::vector<Index> packed = packVertices(mesh);
  loop_offset.push_back(0);
  for (const Index p : order) {
    ViewPolygon polygon{};
    polygon.source = p;
    polygon.normal = source.normal[p];
    polygon.origin = source.origin[p] * scale;
    polygon.loop_begin = std::uint32_t(loop_offset.size() - 1);
    for (std::size_t l = source.loopBegin(p); l < source.loopEnd(p); ++l) {
      for (const Index vertex : source.loop(l)) corners.push_back(packed[vertex]);
      loop_offset.push_back(std::uint32_t(corners.size()));
    }
    polygon.loop_end = std::uint32_t(loop_offset.size() - 1);
    polygons.push_back(polygon);
  }
}

void ViewScene::addSides(const PatchMesh& mesh) {
  std::vector<std::array<std::vector<Index>, 2>> members(mesh.polygons.size());
  for (Index i = 0; i < mesh.size(); ++i) {
    if (mesh.polygon[i] != kNone && mesh.area[i] > 0) {
      members[mesh.polygon[i]][mesh.side[i] != 0].push_back(i);
    }
  }
  std::vector<std::pair<const ViewPolygon*, std::vector<Index>*>> with_grid;
  for (ViewPolygon& polygon : polygons) {
    for (std::size_t s = 0; s < 2; ++s) {
      std::vector<Index>& own = members[polygon.source][s];
      PolygonSide& side = polygon.side[s];
      if (own.empty()) {
        side.item = std::uint32_t(mesh.size()) + mesh.polygons.surface[polygon.source];
        continue;
      }
      side.item = own.front();
      if (own.size() == 1) continue;
      std::sort(own.begin(), own.end(), [&](Index a, Index b) {
        return mesh.index_in_surface[a] < mesh.index_in_surface[b];
      });
      side.grid = Index(with_grid.size());
      with_grid.emplace_back(&polygon, &own);
    }
  }
  std::vector<std::optional<PatchGrid>> made(with_grid.size());
  parallelFor(made.size(), 1, [&](std::size_t g) {
    const auto& [polygon, own] = with_grid[g];
    std::vector<GridPiece> pieces;
    for (const Index patch : *own) appendPieces(mesh, patch, scale, pieces);
    made[g].emplace(pieces, polygon->origin, polygon->normal);
  });
  grids.reserve(made.size());
  for (std::optional<PatchGrid>& grid : made) {
    if (grid) grids.push_back(std::move(*grid));
  }
}

void ViewScene::numberCells() {
  cells.resize(items + 1);
  std::iota(cells.begin(), cells.end(), std::int32_t(0));
  for (const PatchGrid& grid : grids) {
    first_cell.push_back(std::int32_t(cells.size()));
    cells.insert(cells.end(), grid.cells().begin(), grid.cells().end());
  }
}

std::size_t ViewScene::bytes() const {
  std::size_t sum = vertices.size() * sizeof(Vec3) + polygons.size() * sizeof(ViewPolygon) +
                    (corners.size() + loop_offset.size()) * sizeof(std::uint32_t) +
                    (cells.size() + first_cell.size()) * sizeof(std::int32_t);
  for (const PatchGrid& grid : grids) sum += grid.bytes();
  return sum;
}

std::optional<std::vector<std::array<Index, 3>>> ViewScene::trianglesOf(
    const ViewPolygon& polygon) const {
  std::vector<std::span<const Index>> loops;
  for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) loops.push_back(loop(l));
  return triangulatePolygon(vertices, loops, polygon.normal);
}

}  // namespace radiosity
