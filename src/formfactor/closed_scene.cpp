#include "formfactor/closed_scene.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "formfactor/hemicube/row_builder.h"
#include "formfactor/hidden_backs.h"
#include "mesh/union_find.h"

namespace radiosity {

namespace {

/// A point of the patches of each set of polygons joined by vertices that are not on the surfaces:
/// polygons are cut where they cross, so such a set lies on one side of each surface.
std::vector<Vec3> onePerSet(const PatchMesh& mesh, const ViewScene& scene,
                            const std::vector<std::uint8_t>& on_surface) {
  const auto forCorners = [&](Index p, const auto& visit) {
    const ViewPolygon& polygon = scene.polygons[p];
    const std::uint32_t end = scene.loop_offset[polygon.loop_end];
    for (std::uint32_t k = scene.loop_offset[polygon.loop_begin]; k < end; ++k) {
      visit(scene.corners[k]);
    }
  };
  std::vector<std::uint8_t> of_surface(scene.vertices.size(), 0);
  for (Index p = 0; p < scene.polygons.size(); ++p) {
    if (on_surface[p] != 0) forCorners(p, [&](std::uint32_t v) { of_surface[v] = 1; });
  }
  UnionFind sets(scene.polygons.size());
  std::vector<Index> user(scene.vertices.size(), kNone);
  for (Index p = 0; p < scene.polygons.size(); ++p) {
    forCorners(p, [&](std::uint32_t v) {
      if (of_surface[v] != 0) return;
      if (user[v] != kNone) sets.unite(p, user[v]);
      user[v] = p;
    });
  }
  std::vector<Index> place(mesh.polygons.size(), kNone);
  for (Index p = 0; p < scene.polygons.size(); ++p) {
    if (on_surface[p] == 0) place[scene.polygons[p].source] = p;
  }
  std::vector<std::uint8_t> known(scene.polygons.size(), 0);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.polygon[i] == kNone || place[mesh.polygon[i]] == kNone) continue;
    const Index set = sets.find(place[mesh.polygon[i]]);
    if (known[set] == 0) points.push_back(mesh.centroid[i] * scene.scale);
    known[set] = 1;
  }
  return points;
}

}  // namespace

bool closedByTopology(const PatchMesh& mesh, Progress& progress) {
  const ViewScene scene(mesh, false);
  progress.check();
  const HiddenBacks backs(scene);
  std::vector<const ClosedSurface*> rooms;
  std::vector<std::uint8_t> on_room(scene.polygons.size(), 0);
  for (const ClosedSurface& surface : backs.closedSurfaces()) {
    if (surface.outward) continue;
    rooms.push_back(&surface);
    for (const Index p : surface.polygons) on_room[p] = 1;
  }
  if (rooms.empty()) return false;
  const std::vector<Vec3> points = onePerSet(mesh, scene, on_room);
  return std::all_of(points.begin(), points.end(), [&](const Vec3& point) {
    progress.check();
    return std::any_of(rooms.begin(), rooms.end(), [&](const ClosedSurface* room) {
      // -1 within a room but for rounding; on its surface there is no such value.
      return std::abs(windingNumber(scene, room->polygons, point) + 1) < 0.01;
    });
  });
}

bool closedByEye(const PatchMesh& mesh, Progress& progress) {
  FormFactorOptions options;
  options.resolution = 32;
  const RowBuilder rows(mesh, options);
  struct Worker {
    Hemicube hemicube;
    std::vector<std::uint8_t> hidden;
  };
  tbb::enumerable_thread_specific<Worker> workers([&] { return Worker{rows.makeHemicube(), {}}; });
  std::atomic<bool> open{false};
  std::atomic<bool> seen{false};
  progress.begin("looking for sky", mesh.size());
  parallelFor(mesh.size(), 16, [&](std::size_t i) {
    progress.check();
    progress.advance();
    if (open.load(std::memory_order_relaxed) || rows.isEmpty(i)) return;
    Worker& worker = workers.local();
    if (rows.look(i, worker.hemicube, worker.hidden).sky > 0) open = true;
    seen = true;
  });
  progress.end();
  return seen && !open;
}

}  // namespace radiosity
