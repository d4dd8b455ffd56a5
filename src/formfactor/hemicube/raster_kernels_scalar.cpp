#include <algorithm>
#include <cmath>
#include <limits>

#include "formfactor/hemicube/raster_kernels.h"

namespace radiosity {
namespace {

void cross(const EdgeRows& edge, std::int32_t* crossings) {
  const double columns = edge.columns;
  for (std::int32_t y = edge.first; y < edge.end; ++y) {
    const double x = edge.low_x + ((y + 0.5) - edge.low_y) * edge.slope - 0.5;
    const double right = x > 0 ? x : 0;
    crossings[y - edge.first] = std::int32_t(std::ceil(right < columns ? right : columns));
  }
}

void clear(float* depth, std::uint32_t* items, std::size_t count) {
  std::fill_n(depth, count, -std::numeric_limits<float>::infinity());
  std::fill_n(items, count, kSky);
}

void fill(const FillTarget& target, const Span* spans, std::size_t count, float slope,
          std::uint32_t item) {
  for (std::size_t k = 0; k < count; ++k) {
    const Span& span = spans[k];
    const std::size_t row = std::size_t(span.y) * std::size_t(target.stride);
    for (int x = span.begin; x < span.end; ++x) {
      const float centre = float(x) + target.first_centre;
      const float depth = slope * centre + span.inverse_depth;
      float& nearest = target.depth[row + std::size_t(x)];
      if (depth > nearest) {
        nearest = depth;
        target.items[row + std::size_t(x)] = item;
      }
    }
  }
}

std::size_t findRuns(const std::uint32_t* values, int count, std::int32_t* starts) {
  std::size_t found = 0;
  starts[found++] = 0;
  for (int x = 1; x < count; ++x) {
    if (values[x] != values[x - 1]) starts[found++] = x;
  }
  starts[found] = count;
  return found;
}

float clampTo(float value, float last) {
  const float positive = value > 0 ? value : 0;
  return positive < last ? positive : last;
}

float roundToWhole(float value) { return (value + kRounder) - kRounder; }

std::size_t locate(const RowMap& map, int begin, int end, std::int32_t* starts,
                   std::int32_t* cells) {
  std::size_t found = 0;
  float before = -1;  // no cell: the first pixel starts a run
  for (int x = begin; x < end; ++x) {
    const float centre = float(x) + map.first_centre;
    const float w = map.w_slope * centre + map.w;
    const float scale = 1.0F / (w > kLeastW ? w : kLeastW);
    const float u = (map.u_slope * centre + map.u) * scale;
    const float v = (map.v_slope * centre + map.v) * scale;
    const float column = roundToWhole(clampTo(u, map.last_column));
    const float row = roundToWhole(clampTo(v, map.last_row));
    const float cell = row * map.columns + column;
    if (cell != before) {
      starts[found] = x;
      cells[found++] = map.first_cell + std::int32_t(cell);
    }
    before = cell;
  }
  return found;
}

}  // namespace

RasterKernels scalarKernels() { return {"scalar", cross, clear, fill, findRuns, locate}; }

}  // namespace radiosity
