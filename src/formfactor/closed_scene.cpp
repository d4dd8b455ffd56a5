#include "formfactor/closed_scene.h"

#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <vector>

#include "base/parallel.h"
#include "formfactor/hemicube/row_builder.h"

namespace radiosity {

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
