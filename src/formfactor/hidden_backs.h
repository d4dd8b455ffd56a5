// Which bare backs an eye cannot see, so that they need not be drawn.
#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/view_scene.h"

namespace radiosity {

/// A connected set of one-sided polygons proved to be a closed surface that does not touch or
/// cross itself: the fronts face one of the two regions it separates.
struct ClosedSurface {
  std::vector<Index> polygons;  ///< positions in ViewScene::polygons
  Vec3 lower{0.0};
  Vec3 upper{0.0};
  bool outward = true;  ///< fronts face the unbounded region: a solid; else a room
};

/// Two reasons why a back is never seen, both exact:
/// - A polygon on the very same corners faces the other way (a plate without thickness): its
///   front hides this one's back from every eye, where depths alone would be a tie.
/// - It belongs to a closed surface and the eye is on the fronts' side of it. A ray from there
///   meets the surface first from the front.
/// Polygons of surfaces not proved closed are left to the depth test.
class HiddenBacks {
 public:
  explicit HiddenBacks(const ViewScene& scene);

  /// hidden[p] = 1 where the back of polygon p cannot be seen by an eye on the front of polygon
  /// `own` (kNone: an eye in free space).
  void fromEye(const Vec3& eye, Index own, std::vector<std::uint8_t>& hidden) const;

  const std::vector<ClosedSurface>& closedSurfaces() const { return surfaces_; }
  /// Of each polygon, 1: one on the very same corners faces the other way.
  const std::vector<std::uint8_t>& covered() const { return covered_; }
  /// Whether a point lies on the side that the fronts of a closed surface face. On the surface:
  /// false.
  bool onFrontSide(const ClosedSurface& surface, const Vec3& eye) const;

 private:
  void findCovered();
  void findClosedSurfaces();

  const ViewScene& scene_;
  std::vector<std::uint8_t> covered_;
  std::vector<ClosedSurface> surfaces_;
  std::vector<Index> surface_of_;  ///< of each polygon; kNone: not proved closed
};

/// How often a surface winds about a point: 1 inside an outward solid, -1 inside a room, 0
/// outside of either (the sum of signed solid angles, van Oosterom & Strackee 1983, over 4 pi).
double windingNumber(const ViewScene& scene, const std::vector<Index>& polygons, const Vec3& point);

/// True if no two of the polygons cross or touch, except at vertices and edges that both have.
/// Doubtful cases (closer than the scene's coincidence) count as touching.
bool isEmbedded(const ViewScene& scene, const std::vector<Index>& polygons);

}  // namespace radiosity
