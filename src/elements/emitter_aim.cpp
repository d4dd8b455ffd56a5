#include "elements/emitter_aim.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

namespace radiosity {
namespace {

/// Every cell takes at least this share of what it would take if all took the same: a part of it
/// may be above the horizon though its corners are not.
constexpr double kLeastShare = 0.02;

/// The interval of running sums, the last of which is 1, that holds x; x becomes the place in it.
template <std::size_t N>
std::size_t intervalOf(const std::array<double, N>& ends, double& x, double& width) {
  std::size_t k = 0;
  while (k + 1 < N && x >= ends[k]) ++k;
  const double begin = k == 0 ? 0.0 : ends[k - 1];
  width = ends[k] - begin;
  x = width > 0 ? std::clamp((x - begin) / width, 0.0, 1.0) : 0.5;
  return k;
}

template <std::size_t N>
void runningSums(std::array<double, N>& values) {
  double sum = 0;
  for (double& value : values) value = sum += value;
  for (double& value : values) value /= sum;
  values[N - 1] = 1;
}

}  // namespace

EmitterAim::EmitterAim(const Emitter& emitter, const Vec3& eye, const Vec3& normal, bool even)
    : emitter_(emitter), eye_(eye), normal_(normal), even_(even) {
  if (!even_) weighCells();
}

/// In a triangle, places beyond its longest side are mirrored into it.
Vec3 EmitterAim::placeAt(double u, double v) const {
  const auto& o = emitter_.outline;
  if (o.size() == 4) {
    return (1 - v) * ((1 - u) * o[0] + u * o[1]) + v * ((1 - u) * o[3] + u * o[2]);
  }
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return o[0] + u * (o[1] - o[0]) + v * (o[2] - o[0]);
}

/// The emitter's area per area of the unit square.
double EmitterAim::stretchAt(double u, double v) const {
  const auto& o = emitter_.outline;
  if (o.size() != 4) return emitter_.area;
  const Vec3 along = (1 - v) * (o[1] - o[0]) + v * (o[2] - o[3]);
  const Vec3 across = (1 - u) * (o[3] - o[0]) + u * (o[2] - o[1]);
  return glm::length(glm::cross(along, across));
}

double EmitterAim::factorAt(const Vec3& at) const {
  const Vec3 to = at - eye_;
  const double here = glm::dot(to, normal_);
  const double there = -glm::dot(to, emitter_.normal);
  const double square = glm::dot(to, to);
  if (!(here > 0 && there > 0)) return 0;
  return here * there / (std::numbers::pi * square * square);
}

void EmitterAim::weighCells() {
  // Light at the corners of cells, no higher than a cell's own size away from it.
  const double nearest = emitter_.area / double(kSide * kSide);
  std::array<std::array<double, kSide + 1>, kSide + 1> light{};
  for (std::size_t r = 0; r <= kSide; ++r) {
    for (std::size_t c = 0; c <= kSide; ++c) {
      const double u = double(c) / kSide;
      const double v = double(r) / kSide;
      const Vec3 at = placeAt(u, v);
      const double square = glm::dot(at - eye_, at - eye_);
      const double near = std::min(1.0, square / nearest);
      light[r][c] = near * factorAt(at) * stretchAt(u, v);
    }
  }
  double whole = 0;
  for (std::size_t r = 0; r < kSide; ++r) {
    for (std::size_t c = 0; c < kSide; ++c) {
      column_end_[r][c] = light[r][c] + light[r][c + 1] + light[r + 1][c] + light[r + 1][c + 1];
      whole += column_end_[r][c];
    }
  }
  if (!(whole > 0)) {
    even_ = true;
    return;
  }
  const double least = kLeastShare * whole / double(kSide * kSide);
  for (std::size_t r = 0; r < kSide; ++r) {
    for (double& cell : column_end_[r]) row_end_[r] += cell += least;
    runningSums(column_end_[r]);
  }
  runningSums(row_end_);
}

AimedPlace EmitterAim::at(double u, double v) const {
  double density = 1;
  if (!even_) {
    double height = 0;
    double width = 0;
    const std::size_t r = intervalOf(row_end_, v, height);
    const std::size_t c = intervalOf(column_end_[r], u, width);
    density = double(kSide * kSide) * height * width;
    u = (double(c) + u) / kSide;
    v = (double(r) + v) / kSide;
  }
  AimedPlace place;
  place.at = placeAt(u, v);
  place.factor = factorAt(place.at) * stretchAt(u, v) / density;
  return place;
}

}  // namespace radiosity
