#include "formfactor/hemicube/box_on_face.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

namespace radiosity {
namespace {

/// Far above rounding, in scenes of size 1 and in pixels, and far below anything seen.
constexpr double kRounding = 1e-14;
constexpr double kPixelRounding = 1e-6;

/// The first of the centres of `count` pixels that lies within [low, high], and one past the last.
std::pair<int, int> centresWithin(double low, double high, int count) {
  // std::ceil and std::floor are library calls without SSE4.1.
  const double from = std::clamp(low - 0.5 - kPixelRounding, 0.0, double(count));
  const double to = std::clamp(high + 0.5 + kPixelRounding, 0.0, double(count));
  const int below = int(from);
  return {below + int(below < from), int(to)};
}

/// The least and the largest x / w over [low, high] x [near, far], near > 0.
double leastQuotient(double low, double near, double far) { return low / (low < 0 ? near : far); }
double mostQuotient(double high, double near, double far) { return high / (high > 0 ? near : far); }

}  // namespace

BoxesFromEye::BoxesFromEye(const EyeFrame& frame) : frame_(frame) {
  for (int k = 0; k < 3; ++k) spread_[k] = glm::abs(frame.axes[k]);
}

Box3 BoxesFromEye::operator()(const Box3& box) const {
  const Vec3 middle = frame_.toEye(box.centre());
  const Vec3 half = 0.5 * box.size() * spread_ + kRounding;
  return {middle - half, middle + half};
}

PixelBox pixelsWithin(const Box2& rectangle, int columns, int rows) {
  const auto [x_begin, x_end] = centresWithin(rectangle.low.x, rectangle.high.x, columns);
  const auto [y_begin, y_end] = centresWithin(rectangle.low.y, rectangle.high.y, rows);
  return {x_begin, x_end, y_begin, y_end};
}

BoxOnFace boxOnFace(const Box3& box, const FaceGeometry& face, int resolution) {
  FacePoint low{};
  FacePoint high{};
  face.project(box.low, box.high, low, high);
  const int rows = face.isTop() ? resolution : resolution / 2;
  const double bottom = face.isTop() ? -high.w : 0.0;
  if (!(high.w > 0) || low.x > high.w || high.x < -high.w || low.y > high.w || high.y < bottom) {
    return {};
  }
  if (!(low.w > 0)) return {{0, resolution, 0, rows}, std::numeric_limits<double>::infinity()};
  const double half = 0.5 * resolution;
  const double middle = face.isTop() ? half : 0.0;
  const Box2 rectangle = {{half + half * leastQuotient(low.x, low.w, high.w),
                           middle + half * leastQuotient(low.y, low.w, high.w)},
                          {half + half * mostQuotient(high.x, low.w, high.w),
                           middle + half * mostQuotient(high.y, low.w, high.w)}};
  return {pixelsWithin(rectangle, resolution, rows), 1 / low.w};
}

}  // namespace radiosity
