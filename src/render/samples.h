// The loop over tiles, pixels and samples for all pictures.
#pragma once

#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "radiosity/render.h"
#include "render/item_buffer.h"
#include "render/patch_shader.h"

namespace radiosity {

/// The side of a patch that one sample sees.
enum class Seen { nothing, front, back };

/// Whether all samples of a pixel see one patch with roots. Four samples are then enough for its
/// light, which costs more than interpolation between a patch's corners. (More samples only improve
/// the edges of patches.)
inline bool shadesWhole(const ItemBuffer& items, const PatchField& field, const TileItems& seen,
                        int x, int y) {
  const int count = seen.samples * seen.samples;
  if (field.roots == nullptr || count <= 4) return false;
  const Index first = seen.piece[seen.at(x, y, 0)];
  if (first == kNone || items.seenFromBehind(first)) return false;
  const Index patch = items.patchOf(first);
  // Each piece of a triangulated patch is a root.
  const ElementRoots& roots = field.roots->roots;
  const bool one_root = roots.of_patch[patch + 1] - roots.of_patch[patch] == 1;
  for (int s = 1; s < count; ++s) {
    const Index piece = seen.piece[seen.at(x, y, s)];
    if (piece == first) continue;
    if (!one_root || piece == kNone || items.patchOf(piece) != patch) return false;
  }
  return true;
}

/// Calls pixel(x, y, first sample) ... in tiles on all threads. `Pixel` is a class with
///   void begin();                                        a new pixel
///   void sample(Seen, const Shade&);                     S^2 times; values for Seen::front alone;
///                                                        for Seen::nothing `value` is the
///                                                        direction
///   void end(int x, int y);                              the pixel is complete
/// One Pixel is made per tile by make(tile); pixels come row by row, samples always in one order.
template <class Make>
void forSamples(const PatchMesh& mesh, const ItemBuffer& items, const PatchField& field,
                const Make& make, Progress& progress) {
  parallelFor(items.tileCount(), 1, [&](std::size_t tile) {
    progress.check();
    thread_local TileItems seen;
    items.resolve(int(tile), seen);
    auto pixel = make(tile);
    PatchShader shader(mesh, items, field);
    Index piece = kNone;
    const int count = seen.samples * seen.samples;
    const int every = field.roots != nullptr ? field.roots->every : 1;
    const Stopwatch watch;
    for (int y = seen.y; y < seen.y + seen.height; ++y) {
      progress.check();
      for (int x = seen.x; x < seen.x + seen.width; ++x) {
        if (x % every != 0 || y % every != 0) continue;
        pixel.begin();
        const bool whole = shadesWhole(items, field, seen, x, y);
        shader.setSamples(whole ? 4 : count);
        if (whole) {
          const Index hit = seen.piece[seen.at(x, y, 0)];
          if (hit != piece) shader.setPiece(piece = hit);
          for (int s = 0; s < 4; ++s) {
            const Vec2 offset = sampleOffset(s, 2);
            pixel.sample(Seen::front, shader.at(x + offset.x, y + offset.y));
          }
          pixel.end(x, y);
          continue;
        }
        for (int s = 0; s < count; ++s) {
          const Index hit = seen.piece[seen.at(x, y, s)];
          const Vec2 offset = sampleOffset(s, seen.samples);
          if (hit == kNone) {
            const Vec3 d = glm::normalize(items.view().rayThrough(x + offset.x, y + offset.y));
            pixel.sample(Seen::nothing, {.value = {d.x, d.y, d.z}});
            continue;
          }
          if (items.seenFromBehind(hit)) {
            pixel.sample(Seen::back, {});
            continue;
          }
          if (hit != piece) shader.setPiece(piece = hit);
          pixel.sample(Seen::front, shader.at(x + offset.x, y + offset.y));
        }
        pixel.end(x, y);
      }
    }
    if (field.roots != nullptr && !field.roots->tiles.empty()) {
      PointSums& sums = field.roots->tiles[tile];
      sums = shader.sums();
      sums.seconds = watch.seconds();
    }
    progress.advance();
  });
}

/// Prepares the field for a picture with these options. Throws InputError unless there are `bands`
/// finite values for each patch.
PatchField makeField(const PatchMesh& mesh, std::span<const double> values, int bands,
                     const RenderOptions& options);

}  // namespace radiosity
