#include "render/item_buffer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <tuple>

#include "base/geometry/clip.h"
#include "base/parallel.h"

namespace radiosity {
namespace {

constexpr int kTile = 64;  // pixels; with 4 x 4 samples a tile's buffers fit a core's cache
constexpr std::size_t kGrain = 512;  // vertices or pieces in a task

std::vector<Index> ranksByName(const std::vector<std::string>& names) {
  std::vector<Index> order(names.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return names[a] < names[b]; });
  std::vector<Index> rank(names.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = Index(k);
  return rank;
}

}  // namespace

/// The data of the inner loop; values are linear over pixels: c.x * x + c.y * y + c.z.
struct ItemBuffer::Triangle {
  std::array<Vec3, 3> edge;  ///< >= 0 inside
  Vec3 inverse_depth;

  /// Narrows [x0, x1) to the pixels of row y that may hold a sample inside, so that long thin
  /// triangles cost their area, not that of their box. Each edge is evaluated where it is largest
  /// in the row, a whole sample's distance from any sample, and one pixel is added. So rounding
  /// cannot remove a sample that the exact test accepts.
  void narrow(int y, int& x0, int& x1) const {
    for (const Vec3& e : edge) {
      const double most = std::max(e.y * y, e.y * (y + 1)) + e.z;
      if (e.x > 0)
        x0 = int(std::max(double(x0), std::floor(std::min(-most / e.x, double(x1))) - 1));
      if (e.x < 0) x1 = int(std::min(double(x1), std::ceil(std::max(-most / e.x, double(x0))) + 1));
    }
  }
};

ItemBuffer::ItemBuffer(const PatchMesh& mesh, const View& view, int samples, bool show_backs)
    : mesh_(mesh),
      view_(view),
      samples_(samples),
      tiles_x_((view.width + kTile - 1) / kTile),
      tiles_y_((view.height + kTile - 1) / kTile),
      surface_rank_(ranksByName(mesh.surface_names)) {
  transform();
  const std::size_t pieces = mesh.pieces.size();
  patch_of_piece_.assign(pieces, kNone);
  facing_.assign(pieces, 0);
  bounds_.assign(pieces, Bounds{0, 0, 0, 0});
  parallelFor(mesh.size(), kGrain, [&](std::size_t i) {
    for (std::size_t k = mesh_.piece_offset[i]; k < mesh_.piece_offset[i + 1]; ++k) {
      patch_of_piece_[k] = Index(i);
      if (mesh_.area[i] > 0) classify(Index(k), show_backs);
    }
  });
  bin();
}

void ItemBuffer::transform() {
  camera_.resize(mesh_.vertices.size());
  pixels_.resize(mesh_.vertices.size());
  parallelFor(mesh_.vertices.size(), kGrain, [&](std::size_t v) {
    camera_[v] = view_.toCamera(mesh_.vertices[v]);
    pixels_[v] = view_.toPixels(camera_[v]);
  });
}

/// Decides whether the piece is drawn, which side is seen, and its bounds in the picture.
void ItemBuffer::classify(Index piece, bool show_backs) {
  const auto& [a, b, c] = mesh_.pieces[piece];
  const Vec3 normal = glm::cross(camera_[b] - camera_[a], camera_[c] - camera_[a]);
  // Camera space is left-handed (x right, y up, z away), so the cross product points to the back.
  const double height = glm::dot(normal, camera_[a]);
  if (height == 0) return;  // edge-on or without area: it covers no area of the picture
  const bool front = height > 0;
  if (!front) {
    const bool two_sided = mesh_.twin[patch_of_piece_[piece]] != kNone;
    if (two_sided || !show_backs) return;
  }
  bounds_[piece] = boundsOf(mesh_.pieces[piece]);
  if (bounds_[piece].x0 < bounds_[piece].x1 && bounds_[piece].y0 < bounds_[piece].y1) {
    facing_[piece] = front ? 1 : -1;
  }
}

/// Bounds of the pixels that the piece may touch. The frustum's four sides go through the eye: they
/// are linear and homogeneous in pixel space (0 <= X <= width z, 0 <= Y <= height z), so clipping
/// to them needs no near plane.
ItemBuffer::Bounds ItemBuffer::boundsOf(const std::array<Index, 3>& piece) const {
  const double w = view_.width;
  const double h = view_.height;
  const std::array<Vec3, 3> corners = {pixels_[piece[0]], pixels_[piece[1]], pixels_[piece[2]]};
  const auto all = [&](auto test) { return std::all_of(corners.begin(), corners.end(), test); };
  const Bounds nothing{0, 0, 0, 0};
  if (all([](const Vec3& p) { return p.z <= 0; })) return nothing;
  if (all([](const Vec3& p) { return p.x < 0; })) return nothing;
  if (all([](const Vec3& p) { return p.y < 0; })) return nothing;
  if (all([w](const Vec3& p) { return p.x > w * p.z; })) return nothing;
  if (all([h](const Vec3& p) { return p.y > h * p.z; })) return nothing;
  if (all([](const Vec3& p) { return p.z > 0; })) return boundsInFront(corners);

  std::vector<Vec3> polygon(corners.begin(), corners.end());
  std::vector<Vec3> scratch;
  clipLoop(polygon, scratch, [](const Vec3& p) { return p.x; });
  clipLoop(polygon, scratch, [](const Vec3& p) { return p.y; });
  clipLoop(polygon, scratch, [w](const Vec3& p) { return w * p.z - p.x; });
  clipLoop(polygon, scratch, [h](const Vec3& p) { return h * p.z - p.y; });
  if (polygon.empty()) return nothing;
  // The rest lies in the frustum, where z = 0 only at the eye: then the piece fills the picture.
  for (const Vec3& p : polygon) {
    if (!(p.z > 0)) return {0, 0, view_.width, view_.height};
  }
  return boundsInFront(polygon);
}

ItemBuffer::Bounds ItemBuffer::boundsInFront(std::span<const Vec3> corners) const {
  const Vec2 size(view_.width, view_.height);
  Vec2 low = size;
  Vec2 high(0.0, 0.0);
  for (const Vec3& p : corners) {
    const Vec2 seen = glm::clamp(Vec2(p.x / p.z, p.y / p.z), Vec2(0.0), size);
    low = glm::min(low, seen);
    high = glm::max(high, seen);
  }
  // One more pixel on each side, so that rounding never loses a sample; nothing else depends on it.
  return {std::max(int(low.x) - 1, 0), std::max(int(low.y) - 1, 0),
          std::min(int(high.x) + 2, view_.width), std::min(int(high.y) + 2, view_.height)};
}

/// Lists the pieces of every tile (counting sort, in the mesh's order).
void ItemBuffer::bin() {
  const auto forTiles = [&](Index piece, auto visit) {
    if (facing_[piece] == 0) return;
    const Bounds& b = bounds_[piece];
    for (int ty = b.y0 / kTile; ty <= (b.y1 - 1) / kTile; ++ty) {
      for (int tx = b.x0 / kTile; tx <= (b.x1 - 1) / kTile; ++tx) visit(ty * tiles_x_ + tx);
    }
  };
  tile_begin_.assign(tileCount() + 1, 0);
  for (Index k = 0; k < mesh_.pieces.size(); ++k) {
    forTiles(k, [&](int tile) { ++tile_begin_[tile + 1]; });
  }
  std::partial_sum(tile_begin_.begin(), tile_begin_.end(), tile_begin_.begin());
  tile_pieces_.resize(tile_begin_.back());
  std::vector<std::size_t> next(tile_begin_.begin(), tile_begin_.end() - 1);
  for (Index k = 0; k < mesh_.pieces.size(); ++k) {
    forTiles(k, [&](int tile) { tile_pieces_[next[tile]++] = k; });
  }
}

ItemBuffer::Triangle ItemBuffer::setUp(Index piece) const {
  const auto& p = mesh_.pieces[piece];
  Triangle t;
  for (int k = 0; k < 3; ++k) {
    const Index from = p[k];
    const Index to = p[(k + 1) % 3];
    t.edge[k] = facing_[piece] > 0 ? edgeFunction(from, to) : edgeFunction(to, from);
  }
  // The plane n . p = n . a: along the ray d with d.z = 1, 1/z = n . d / n . a. The normal is made
  // from differences, so a small piece far away keeps its depth to the last digits.
  const Vec3 normal = glm::cross(camera_[p[1]] - camera_[p[0]], camera_[p[2]] - camera_[p[0]]);
  t.inverse_depth = view_.overPixels(normal) / glm::dot(normal, camera_[p[0]]);
  return t;
}

bool ItemBuffer::goesFirst(Index piece, Index other) const {
  const auto key = [&](Index k) {
    const Index i = patch_of_piece_[k];
    return std::tuple(facing_[k] < 0, surface_rank_[mesh_.surface[i]], mesh_.index_in_surface[i],
                      mesh_.side[i], k - mesh_.piece_offset[i]);
  };
  return key(piece) < key(other);
}

void ItemBuffer::rasterise(Index piece, TileItems& items) const {
  const Bounds& b = bounds_[piece];
  const int y0 = std::max(b.y0, items.y);
  const int y1 = std::min(b.y1, items.y + items.height);
  const Triangle t = setUp(piece);
  for (int y = y0; y < y1; ++y) {
    int x0 = std::max(b.x0, items.x);
    int x1 = std::min(b.x1, items.x + items.width);
    t.narrow(y, x0, x1);
    for (int s = 0; s < samples_ * samples_; ++s) {
      const Vec2 offset = sampleOffset(s, samples_);
      const double sy = y + offset.y;
      const double e0 = t.edge[0].y * sy + t.edge[0].z;
      const double e1 = t.edge[1].y * sy + t.edge[1].z;
      const double e2 = t.edge[2].y * sy + t.edge[2].z;
      const double iz = t.inverse_depth.y * sy + t.inverse_depth.z;
      const std::size_t row = items.at(items.x, y, s);
      double* depth = items.inverse_depth.data() + row;
      Index* seen = items.piece.data() + row;
      for (int x = x0; x < x1; ++x) {
        const double sx = x + offset.x;
        const bool inside =
            t.edge[0].x * sx + e0 >= 0 && t.edge[1].x * sx + e1 >= 0 && t.edge[2].x * sx + e2 >= 0;
        if (!inside) continue;
        const double d = t.inverse_depth.x * sx + iz;
        const int k = x - items.x;
        if (d > depth[k] || (d == depth[k] && seen[k] != kNone && goesFirst(piece, seen[k]))) {
          depth[k] = d;
          seen[k] = piece;
        }
      }
    }
  }
}

void ItemBuffer::resolve(int tile, TileItems& items) const {
  items.x = tile % tiles_x_ * kTile;
  items.y = tile / tiles_x_ * kTile;
  items.width = std::min(kTile, view_.width - items.x);
  items.height = std::min(kTile, view_.height - items.y);
  items.samples = samples_;
  const std::size_t count = std::size_t(items.width) * items.height * samples_ * samples_;
  items.piece.assign(count, kNone);
  items.inverse_depth.assign(count, 0.0);
  for (std::size_t k = tile_begin_[tile]; k < tile_begin_[tile + 1]; ++k) {
    rasterise(tile_pieces_[k], items);
  }
}

}  // namespace radiosity
