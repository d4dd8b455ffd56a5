#include "formfactor/hemicube/clip.h"

#include <tuple>
#include <utility>

#include "base/geometry/clip.h"

namespace radiosity {
namespace {

bool before(const FacePoint& a, const FacePoint& b) {
  return std::tie(a.x, a.y, a.w) < std::tie(b.x, b.y, b.w);
}

FacePoint crossing(FacePoint a, FacePoint b, double distance_a, double distance_b) {
  if (before(b, a)) {
    std::swap(a, b);
    std::swap(distance_a, distance_b);
  }
  const double t = distance_a / (distance_a - distance_b);
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.w + t * (b.w - a.w)};
}

}  // namespace

void clipLoop(const std::vector<FacePoint>& in, const FaceGeometry& face, SidePlane plane,
              std::vector<FacePoint>& out) {
  out.clear();
  clipCorners(
      in, [&](const FacePoint& p) { return face.distance(p, plane); }, crossing,
      [&](const FacePoint& p) { out.push_back(p); });
}

}  // namespace radiosity
