#include "mesh/patches/texture_mean.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "base/geometry/box.h"
#include "base/geometry/clip.h"

namespace radiosity {

namespace {

/// Halves rows of pixels (to at least one), each the area mean of the pixels that it covers. In a
/// row of odd length, pixels are shared between two.
std::vector<float> halveRows(std::span<const float> pixels, long count, long rows) {
  const long half = std::max(1L, count / 2);
  const double ratio = double(count) / double(half);
  std::vector<float> result;
  result.reserve(std::size_t(rows * half * 3));
  for (long row = 0; row < rows; ++row) {
    for (long k = 0; k < half; ++k) {
      const double from = double(k) * ratio;
      const double to = double(k + 1) * ratio;
      double sum[3] = {0, 0, 0};
      for (long i = long(from); i < std::min(count, long(std::ceil(to))); ++i) {
        const double share = std::min(to, double(i + 1)) - std::max(from, double(i));
        for (long c = 0; c < 3; ++c) {
          sum[c] += share * double(pixels[std::size_t((row * count + i) * 3 + c)]);
        }
      }
      for (const double s : sum) result.push_back(float(s / ratio));
    }
  }
  return result;
}

/// The part of a line of constant y within a convex polygon; empty (low > high) if it misses it.
struct Stretch {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Stretch stretchAt(std::span<const Vec2> polygon, double y) {
  Stretch stretch;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2& a = polygon[k];
    const Vec2& b = polygon[(k + 1) % polygon.size()];
    if (std::min(a.y, b.y) > y || std::max(a.y, b.y) < y) continue;
    const bool level = a.y == b.y;
    const double x = level ? a.x : a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
    stretch.low = std::min({stretch.low, x, level ? b.x : x});
    stretch.high = std::max({stretch.high, x, level ? b.x : x});
  }
  return stretch;
}

std::vector<float> transposed(std::span<const float> pixels, long width, long height) {
  std::vector<float> result(pixels.size());
  for (long j = 0; j < height; ++j) {
    for (long i = 0; i < width; ++i) {
      for (long c = 0; c < 3; ++c) {
        result[std::size_t((i * height + j) * 3 + c)] =
            pixels[std::size_t((j * width + i) * 3 + c)];
      }
    }
  }
  return result;
}

std::vector<float> halvedTexels(std::span<const float> texels, long width, long height) {
  const long half = std::max(1L, width / 2);
  const std::vector<float> turned = transposed(halveRows(texels, width, height), half, height);
  return transposed(halveRows(turned, height, half), std::max(1L, height / 2), half);
}

}  // namespace

Texture halved(const Texture& texture) {
  return {texture.name, std::max(1, texture.width / 2), std::max(1, texture.height / 2),
          halvedTexels(texture.texels, texture.width, texture.height), texture.repeat};
}

TextureMean::TextureMean(const Texture& texture) : texture_(texture) {
  levels_.push_back({texture.width, texture.height, {}});
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& last = levels_.back();
    const std::vector<float>& pixels = last.halved.empty() ? texture.texels : last.halved;
    const long width = std::max(1L, last.width / 2);
    const long height = std::max(1L, last.height / 2);
    levels_.push_back({width, height, halvedTexels(pixels, last.width, last.height)});
  }
}

const float* TextureMean::pixel(const Level& level, long i, long j) const {
  if (texture_.repeat) {
    i = (i % level.width + level.width) % level.width;
    j = (j % level.height + level.height) % level.height;
  } else {
    i = std::clamp(i, 0L, level.width - 1);
    j = std::clamp(j, 0L, level.height - 1);
  }
  const std::vector<float>& pixels = level.halved.empty() ? texture_.texels : level.halved;
  return pixels.data() + (j * level.width + i) * 3;
}

Vec3 TextureMean::texel(const Level& level, long i, long j) const {
  const float* p = pixel(level, i, j);
  return {double(p[0]), double(p[1]), double(p[2])};
}

Vec3 TextureMean::at(const Vec2& uv) const {
  const Level& level = levels_[0];
  return texel(level, long(std::floor(uv.x * double(level.width))),
               long(std::floor(uv.y * double(level.height))));
}

Vec3 TextureMean::filtered(const Vec2& uv, double spacing) const {
  const double halvings = spacing > 1 ? std::round(std::log2(spacing)) : 0.0;
  const Level& level = levels_[std::size_t(std::min(halvings, double(levels_.size() - 1)))];
  const Vec2 at = uv * Vec2(double(level.width), double(level.height)) - Vec2(0.5);
  const Vec2 low = glm::floor(at);
  const Vec2 share = at - low;
  const long i = long(low.x);
  const long j = long(low.y);
  const Vec3 above = glm::mix(texel(level, i, j), texel(level, i + 1, j), share.x);
  const Vec3 below = glm::mix(texel(level, i, j + 1), texel(level, i + 1, j + 1), share.x);
  return glm::mix(above, below, share.y);
}

Vec3 TextureMean::over(std::span<const Vec2> uv) const {
  Box2 box;
  for (const Vec2& p : uv) box.add(p);
  const auto& [low, high] = box;
  std::size_t l = 0;
  const auto texels = [&] {
    return ((high.x - low.x) * double(levels_[l].width) + 1) *
           ((high.y - low.y) * double(levels_[l].height) + 1);
  };
  while (l + 1 < levels_.size() && texels() > kMostTexels) ++l;
  const Level& level = levels_[l];
  if (level.width == 1 && level.height == 1) return texel(level, 0, 0);

  const Vec2 size(double(level.width), double(level.height));
  std::vector<Vec2> polygon;
  for (const Vec2& p : uv) polygon.push_back(p * size);
  Sum sum;
  Stretch above = stretchAt(polygon, std::floor(low.y * size.y));
  for (double j = std::floor(low.y * size.y); j < high.y * size.y; ++j) {
    const Stretch below = stretchAt(polygon, j + 1);
    // In a convex polygon, columns within both stretches are covered over the whole row.
    const double from = std::ceil(std::max(above.low, below.low));
    const double to = std::max(from, std::floor(std::min(above.high, below.high)));
    addRow(level, polygon, j, from, to, sum);
    above = below;
  }
  return sum.area > 0 ? sum.colour / sum.area : at(0.5 * (low + high));  // no area, by rounding
}

void TextureMean::addRow(const Level& level, const std::vector<Vec2>& polygon, double j,
                         double from, double to, Sum& sum) const {
  if (from < to) {
    sum.colour += texelsBetween(level, long(from), long(to), long(j));
    sum.area += to - from;
  }
  std::vector<Vec2> row = polygon;
  std::vector<Vec2> cell;
  std::vector<Vec2> scratch;
  clipLoop(row, scratch, [&](const Vec2& p) { return p.y - j; });
  clipLoop(row, scratch, [&](const Vec2& p) { return j + 1 - p.y; });
  double left = std::numeric_limits<double>::infinity();
  double right = -left;
  for (const Vec2& p : row) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
  }
  for (double i = std::floor(left); i < right; ++i) {
    if (i == from) i = to;
    if (i >= right) break;
    cell = row;
    clipLoop(cell, scratch, [&](const Vec2& p) { return p.x - i; });
    clipLoop(cell, scratch, [&](const Vec2& p) { return i + 1 - p.x; });
    const double share = std::abs(polygonArea(cell));
    sum.colour += share * texel(level, long(i), long(j));
    sum.area += share;
  }
}

/// The sum of a row's texels from column `i` to `end`, without the last.
Vec3 TextureMean::texelsBetween(const Level& level, long i, long end, long j) const {
  Vec3 sum(0.0);
  while (i < end) {
    // Up to here the texture is contiguous in memory, or a clamped texel is repeated.
    const long inside = texture_.repeat ? (i % level.width + level.width) % level.width : i;
    const bool clamped = inside < 0 || inside >= level.width;
    if (clamped) {
      const long next = inside < 0 ? std::min(end, 0L) : end;
      sum += double(next - i) * texel(level, i, j);
      i = next;
      continue;
    }
    const long count = std::min(end - i, level.width - inside);
    const float* p = pixel(level, inside, j);
    for (long k = 0; k < count; ++k, p += 3) {
      sum += Vec3(double(p[0]), double(p[1]), double(p[2]));
    }
    i += count;
  }
  return sum;
}

}  // namespace radiosity
