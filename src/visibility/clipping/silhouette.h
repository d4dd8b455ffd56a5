// The cone of directions that a convex occluder blocks.
#pragma once

#include <cstdint>
#include <vector>

#include "visibility/clipping/convex_polygon.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

/// The region that a convex body hides from a point: p is hidden where the segment from the origin
/// (the point) to p meets the body. It does if p is inside all sides of the body's cone and not in
/// front of the faces that the point sees: then the ray enters the body before it reaches p. Those
/// faces matter only for a target whose plane cuts the body; elsewhere they are implied.
struct BlockingCone {
  std::vector<ClipPlane> planes;      ///< inside all of them: hidden
  std::vector<std::uint16_t> labels;  ///< of the planes: the body's edges, then its faces
  std::vector<double> heights;        ///< of the point above the body's faces
  bool inside = false;                ///< the point is inside the body: everything is hidden
};

/// Sets `cone` to the region that `occluder` hides from `eye`, whichever way the eye looks. The
/// sides are the planes through the eye and the edges between a face that is seen and one that is
/// not: there is no projection, so the body may reach below the eye's horizon. `with_faces`: the
/// target's plane cuts the body. Returns false if nothing is hidden (a flat body seen from its own
/// plane).
bool blockingCone(const Occluder& occluder, const Vec3& eye, bool with_faces, BlockingCone& cone);

}  // namespace radiosity
