#include "formfactor/hemicube/face_buffer.h"

#include <algorithm>
#include <array>
#include <limits>

namespace radiosity {
namespace {

int dividedUp(int x, int by) { return (x + by - 1) / by; }

}  // namespace

FaceBuffer::FaceBuffer(int columns, int rows)
    : columns_(columns),
      rows_(rows),
      stride_(dividedUp(columns, kRowAlignment) * kRowAlignment),
      tile_columns_(dividedUp(columns, kTile)),
      tiles_(std::size_t(tile_columns_) * std::size_t(dividedUp(rows, kTile))) {
  const std::size_t pixels = std::size_t(stride_) * std::size_t(rows);
  depth_.reserve(pixels);
  items_.reserve(pixels);
}

void FaceBuffer::clear(const RasterKernels& kernels) {
  kernels.clear(depth_.data(), items_.data(), std::size_t(stride_) * std::size_t(rows_));
  std::fill(tiles_.begin(), tiles_.end(), Tile{-std::numeric_limits<float>::infinity(), false});
}

void FaceBuffer::fill(const RasterKernels& kernels, const std::vector<Span>& spans, float slope,
                      std::uint32_t item) {
  kernels.fillAnyOrder({depth_.data(), items_.data(), stride_, 0.5F * float(1 - columns_)},
                       spans.data(), spans.size(), slope, item);
  for (const Span& span : spans) {
    Tile* row = tiles_.data() + std::size_t(span.y / kTile) * std::size_t(tile_columns_);
    for (int t = span.begin / kTile; t <= (span.end - 1) / kTile; ++t) row[t].is_old = true;
  }
}

/// The farthest depth of a tile, by columns first: four or eight of them make a vector.
float FaceBuffer::farthestOf(int column, int row) const {
  std::array<float, kTile> farthest;
  farthest.fill(std::numeric_limits<float>::infinity());
  const int y_end = std::min((row + 1) * kTile, rows_);
  for (int y = row * kTile; y < y_end; ++y) {
    const float* depth = depth_.data() + std::size_t(y) * std::size_t(stride_) + column * kTile;
    for (std::size_t x = 0; x < kTile; ++x) {
      farthest[x] = depth[x] < farthest[x] ? depth[x] : farthest[x];
    }
  }
  return *std::min_element(farthest.begin(), farthest.end());
}

bool FaceBuffer::isNearer(const PixelBox& box, double nearest) const {
  for (int y = box.y_begin; y < box.y_end; ++y) {
    const float* depth = depth_.data() + std::size_t(y) * std::size_t(stride_);
    for (int x = box.x_begin; x < box.x_end; ++x) {
      if (!(double(depth[x]) > nearest)) return false;
    }
  }
  return true;
}

bool FaceBuffer::hides(const PixelBox& box, double nearest) {
  const int x_middle = (box.x_begin + box.x_end) / 2;
  const int y_middle = (box.y_begin + box.y_end) / 2;
  if (!isNearer({x_middle, x_middle + 1, y_middle, y_middle + 1}, nearest)) return false;
  for (int row = box.y_begin / kTile; row <= (box.y_end - 1) / kTile; ++row) {
    for (int column = box.x_begin / kTile; column <= (box.x_end - 1) / kTile; ++column) {
      Tile& tile = tiles_[std::size_t(row) * std::size_t(tile_columns_) + std::size_t(column)];
      if (double(tile.farthest) > nearest) continue;
      if (tile.is_old) {
        tile = {farthestOf(column, row), false};
        if (double(tile.farthest) > nearest) continue;
      }
      const PixelBox part = {
          std::max(column * kTile, box.x_begin), std::min((column + 1) * kTile, box.x_end),
          std::max(row * kTile, box.y_begin), std::min((row + 1) * kTile, box.y_end)};
      if (!isNearer(part, nearest)) return false;
    }
  }
  return true;
}

}  // namespace radiosity
