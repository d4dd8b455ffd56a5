#include "formfactor/hemicube/clip.h"

#include <tuple>
#include <utility>

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
  if (in.empty()) return;
  FacePoint from = in.back();
  double from_distance = face.distance(from, plane);
  for (const FacePoint& to : in) {
    const double to_distance = face.distance(to, plane);
    if ((from_distance < 0) != (to_distance < 0)) {
      out.push_back(crossing(from, to, from_distance, to_distance));
    }
    if (!(to_distance < 0)) out.push_back(to);
    from = to;
    from_distance = to_distance;
  }
}

}  // namespace radiosity
