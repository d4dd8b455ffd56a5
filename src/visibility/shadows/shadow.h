// Planes that bound the shadow of a convex body, cast by a convex planar shape.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "radiosity/base.h"
#include "visibility/occluders/occluders.h"
#include "visibility/shadows/kernels.h"

namespace radiosity {

enum class ShadowRelation : std::uint8_t {
  kOutside,  ///< no segment between the two shapes meets the body
  kInside,   ///< every segment between the two shapes is blocked by the body
  kUnclear   ///< neither was proved
};

/// The shadow of a convex body from a light of convex shape, by planes.
///
/// Outside: the body and the hull of two shapes are apart if a plane separates them (touching
/// within the coincidence is apart). The planes tried touch both the body and the light: through an
/// edge of the one and a corner of the other, and the body's own faces. One of them is enough for
/// another shape on the light's side of it.
///
/// Inside: the region that a convex body hides from a point is convex (for x = p + s (o - p), s >=
/// 1 and o in the body: a mean of two such points is one). So it is the intersection of
/// half-spaces, below the faces that the point is in front of and within the planes through the
/// point and the silhouette. A convex shape whose corners are hidden is hidden; and since that
/// holds of both ends, corners of both shapes are enough (checked against random segments in
/// exact_visibility_test).
class ShadowPlanes {
 public:
  /// `coincidence` as ElementSet's: corners within it of a face count as on the face.
  void build(const ShapeCorners& light, const Occluder& body, double coincidence);

  /// The first 64 separating planes, a bit each: set if the plane may still tell a shape from the
  /// body. A plane that is above the whole of a shape needs no second look for its parts.
  using Planes = std::uint64_t;
  static constexpr Planes kAllPlanes = ~Planes(0);

  /// `open`: kAllPlanes, or the planes left open by a shape that holds this one; planes above all
  /// of this shape are taken out. Not thread-safe: remembers which plane gave the last answer.
  ShadowRelation relation(const VisibilityKernels& kernels, const ShapeCorners& shape,
                          Planes& open);

 private:
  void findFaces(const Occluder& body);
  void findSilhouettes(const Occluder& body);
  void findTangentsAtEdges(const Occluder& body);
  bool isAbove(const ShadowPlane& plane) const;
  bool separates(const VisibilityKernels& kernels, const ShapeCorners& shape, Planes& open);
  bool hides(const VisibilityKernels& kernels, const ShapeCorners& shape);

  ShapeCorners light_{};
  double coincidence_ = 0;
  std::vector<ShadowPlane> outside_;  ///< the body below, the light above
  std::vector<ShadowPlane> inside_;   ///< points hidden from the light are below all of them
  std::vector<Index> strictly_;       ///< of inside_: not all of it may be on the plane
  bool may_hide_ = false;
  std::size_t last_outside_ = 0;
  std::size_t last_inside_ = 0;
  std::vector<std::uint8_t> front_;  ///< per plane: bit i, corner i in front; bit 4 + i, or on it
};

}  // namespace radiosity
