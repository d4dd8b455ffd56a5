// The part of a convex polygon that a point sees past convex occluders.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "visibility/clipping/convex_polygon.h"
#include "visibility/clipping/silhouette.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

/// An occluder as it concerns one pair of elements.
struct Blocker {
  const Occluder* body = nullptr;
  Index id = 0;              ///< of the OccluderSet
  bool cuts_target = false;  ///< it reaches behind the target's plane
};

/// The answer from one point.
struct PointView {
  double visible = 0;  ///< form factor to the visible part of the target, 0 to `whole`
  double whole = 0;    ///< form factor to all of it
  /// A number for the set of edges that bound the hidden part. If it differs between neighbouring
  /// points, the form factor has a kink between them.
  std::uint64_t shape = 0;
};

/// Exact in double precision. Holds scratch memory: one a thread.
class VisiblePart {
 public:
  /// Looks from `eye`, on a surface of normal `normal`, at `target`: convex, wholly above the eye's
  /// horizon, its front to the eye.
  PointView look(const Vec3& eye, const Vec3& normal, std::span<const Vec3> target,
                 std::span<const Blocker> blockers);

 private:
  struct Shadow {
    BlockingCone cone;
    double form_factor = 0;
    Index id = 0;
  };

  double clipToCone(const BlockingCone& cone, const Vec3& normal, Index id, PointView& view);
  double subtractAll(const Vec3& normal);
  void subtract(const BlockingCone& cone);

  ConvexPolygon target_;
  std::array<ConvexPolygon, 2> clipped_;
  ConvexPolygon outside_;
  ConvexPolygon whole_;
  std::vector<Shadow> shadows_;  ///< the first shadow_count_ are in use
  std::size_t shadow_count_ = 0;
  std::vector<ConvexPolygon> pieces_;  ///< of the visible part; the first piece_count_ are in use
  std::size_t piece_count_ = 0;
  std::vector<ConvexPolygon> next_;
};

}  // namespace radiosity
