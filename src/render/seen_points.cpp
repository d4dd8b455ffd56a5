#include "render/seen_points.h"

#include "base/parallel.h"
#include "render/item_buffer.h"

namespace radiosity {

std::vector<SeenPoint> middlesOfPixels(const PatchMesh& mesh, const Camera& camera,
                                       const RenderOptions& options) {
  options.validate();
  const ItemBuffer items(mesh, makeView(camera, options.width, options.height), 1,
                         options.show_backs);
  std::vector<SeenPoint> points(std::size_t(options.width) * std::size_t(options.height));
  parallelFor(std::size_t(items.tileCount()), 1, [&](std::size_t tile) {
    thread_local TileItems seen;
    items.resolve(int(tile), seen);
    for (int y = seen.y; y < seen.y + seen.height; ++y) {
      for (int x = seen.x; x < seen.x + seen.width; ++x) {
        const std::size_t sample = seen.at(x, y, 0);
        const Index piece = seen.piece[sample];
        if (piece == kNone) continue;
        points[std::size_t(y) * std::size_t(options.width) + std::size_t(x)] = {
            items.patchOf(piece), items.seenFromBehind(piece), 1 / seen.inverse_depth[sample]};
      }
    }
  });
  return points;
}

}  // namespace radiosity
