// The five faces of a hemicube and their projection.
//
// Each face looks along one axis of the eye's frame. Points are kept homogeneous, (x, y, w) with w
// the distance along that axis; the picture is at w = 1, and pixel units come last. A face sees
// the pyramid of its four side planes through the eye. They alone imply w >= 0, so there is no
// near plane and nothing with a length in it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "radiosity/base.h"

namespace radiosity {

inline constexpr int kFaces = 5;

/// A point as one face sees it.
struct FacePoint {
  double x, y, w;
};

/// Signs of n+s, n-s, n+t, n-t, s+t, s-t, n for a point (s, t, n) in the eye's frame: every side
/// plane of every face is one of these, up to sign. Bit k: negative; bit k + 8: positive.
/// Codes of several points are combined by OR.
using SignCode = std::uint16_t;
inline constexpr int kHeightSign = 6;
/// Set where the point is off the horizon's plane by more than coincidence.
inline constexpr SignCode kOffPlane = 1u << 15;
inline constexpr SignCode kAboveHorizon = 1u << (kHeightSign + 8);

inline SignCode signCode(const Vec3& p) {
  const std::array<double, 7> value = {p.z + p.x, p.z - p.x, p.z + p.y, p.z - p.y,
                                       p.x + p.y, p.x - p.y, p.z};
  unsigned code = 0;
  for (unsigned k = 0; k < value.size(); ++k) {
    code |= unsigned(value[k] < 0) << k | unsigned(value[k] > 0) << (k + 8);
  }
  return SignCode(code);
}

/// One of a face's four planes.
enum class SidePlane { left, right, bottom, top };
inline constexpr std::array<SidePlane, 4> kSidePlanes = {SidePlane::left, SidePlane::right,
                                                         SidePlane::bottom, SidePlane::top};

/// Face 0 is the top; 1 to 4 are the sides, which show only the part above the horizon.
class FaceGeometry {
 public:
  explicit FaceGeometry(int face) : face_(face) {}

  std::size_t index() const { return std::size_t(face_); }
  bool isTop() const { return face_ == 0; }
  /// Projects a point in the eye's frame; also for directions and normals.
  FacePoint project(const Vec3& p) const {
    switch (face_) {
      case 0:
        return {p.x, p.y, p.z};
      case 1:
        return {p.y, p.z, p.x};
      case 2:
        return {-p.x, p.z, p.y};
      case 3:
        return {-p.y, p.z, -p.x};
      default:
        return {p.x, p.z, -p.y};
    }
  }
  /// Positive inside. Rounded, but the same for equal points, and of the sign signCode() says.
  double distance(const FacePoint& p, SidePlane plane) const {
    switch (plane) {
      case SidePlane::left:
        return p.w + p.x;
      case SidePlane::right:
        return p.w - p.x;
      case SidePlane::bottom:
        return isTop() ? p.w + p.y : p.y;
      default:
        return p.w - p.y;
    }
  }
  /// Bit of a combined code that says some point lies strictly outside the plane.
  SignCode outsideBit(SidePlane plane) const { return SignCode(1u << bits()[int(plane)]); }
  /// Bit that says some point lies strictly inside the plane.
  SignCode insideBit(SidePlane plane) const { return SignCode(1u << (bits()[int(plane)] ^ 8u)); }
  /// Projects a box along the axes of the eye's frame, low and high corner in place.
  void project(const Vec3& low, const Vec3& high, FacePoint& from, FacePoint& to) const {
    const FacePoint a = project(low);
    const FacePoint b = project(high);
    from = {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.w, b.w)};
    to = {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.w, b.w)};
  }
  /// False where all points lie on or outside one plane: no pixel can be covered.
  bool mayCover(SignCode combined) const {
    unsigned inside = 0;
    for (const SidePlane plane : kSidePlanes) inside |= insideBit(plane);
    return (combined & inside) == inside;
  }

 private:
  /// Index of each plane's "outside" bit: k if the plane is value k of signCode() >= 0, k + 8 if
  /// it is value k <= 0.
  const std::array<unsigned, 4>& bits() const {
    static constexpr std::array<std::array<unsigned, 4>, kFaces> kBits = {
        {{0, 1, 2, 3}, {4, 5, 6, 9}, {13, 4, 6, 11}, {12, 13, 6, 8}, {5, 12, 6, 10}}};
    return kBits[std::size_t(face_)];
  }
  int face_;
};

}  // namespace radiosity
