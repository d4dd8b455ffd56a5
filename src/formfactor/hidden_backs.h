// Which black backs an eye cannot see, so that they need not be drawn.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formfactor/view_scene.h"

namespace radiosity {

/// Two reasons why a back is never seen, both exact and known from the mesh (Enclosures):
/// - A polygon on the very same corners faces the other way (a plate without thickness): its
///   front hides this one's back from every eye, where depths alone would be a tie.
/// - It belongs to a closed surface and the eye is on the fronts' side of it. A ray from there
///   meets the surface first from the front.
/// Polygons of surfaces not proved closed are left to the depth test.
class HiddenBacks {
 public:
  /// Both are kept by reference.
  HiddenBacks(const ViewScene& scene, const PatchMesh& mesh);

  /// By position in ViewScene::polygons: hidden[p] = 1 if the back of polygon p cannot be seen by
  /// an eye (metres) on the front of the mesh's polygon `own` (kNone: an eye in free space).
  void fromEye(const Vec3& eye, Index own, std::vector<std::uint8_t>& hidden) const;

 private:
  const PatchMesh& mesh_;
  std::optional<Enclosures> found_;  ///< if the mesh does not have them
  const Enclosures& enclosures_;
  std::vector<std::uint8_t> covered_;         ///< by position
  std::vector<std::vector<Index>> surfaces_;  ///< positions of each closed surface's polygons
};

}  // namespace radiosity
