#include "formfactor/closed_scene.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "formfactor/hidden_backs.h"
#include "formfactor/row_builder.h"

namespace radiosity {

bool closedByTopology(const PatchMesh& mesh) {
  const ViewScene scene(mesh, false);
  const HiddenBacks backs(scene);
  std::vector<const ClosedSurface*> rooms;
  std::vector<std::uint8_t> on_room(mesh.polygons.size(), 0);
  for (const ClosedSurface& surface : backs.closedSurfaces()) {
    if (surface.outward) continue;
    rooms.push_back(&surface);
    for (const Index p : surface.polygons) on_room[scene.polygons[p].source] = 1;
  }
  if (rooms.empty()) return false;
  // Polygons are cut where they cross, so one patch speaks for all of its polygon.
  std::vector<std::uint8_t> known(mesh.polygons.size(), 0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Index polygon = mesh.polygon[i];
    if (polygon == kNone || known[polygon] != 0) continue;
    known[polygon] = 1;
    const bool inside = std::any_of(rooms.begin(), rooms.end(), [&](const ClosedSurface* room) {
      // -1 within a room but for rounding; on its surface there is no such value.
      const Vec3 point = mesh.centroid[i] * scene.scale;
      return std::abs(windingNumber(scene, room->polygons, point) + 1) < 0.01;
    });
    if (on_room[polygon] == 0 && !inside) return false;
  }
  return true;
}

bool closedByEye(const PatchMesh& mesh) {
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
  parallelFor(mesh.size(), 16, [&](std::size_t i) {
    if (open.load(std::memory_order_relaxed) || rows.isEmpty(i)) return;
    Worker& worker = workers.local();
    if (rows.look(i, worker.hemicube, worker.hidden).sky > 0) open = true;
    seen = true;
  });
  return seen && !open;
}

}  // namespace radiosity
