// Polygons against convex bodies.
#pragma once

#include <span>

#include "visibility/occluders/occluders.h"
#include "visibility/occluders/polygons.h"

namespace radiosity {

/// Area of a polygon's part inside a convex body (0 where it only touches), by clipping every loop
/// to the planes (Sutherland & Hodgman 1974) moved inward by `margin`: edges that run to and fro
/// in a plane and holes cancel in the sum of signed areas.
double areaInside(const OccluderPolygons& all, const OccluderPolygon& polygon, const Occluder& body,
                  double margin);

/// The largest dot(normal of the body's first plane, x) of that part; -infinity if there is none.
double highestInside(const OccluderPolygons& all, const OccluderPolygon& polygon,
                     const Occluder& body, double margin);

Occluder::Plane planeOf(const OccluderPolygon& polygon);

/// True if no corner of a polygon is in front of a plane, farther than the coincidence.
bool isBehind(const OccluderPolygons& all, const OccluderPolygon& polygon,
              const Occluder::Plane& plane);

/// The face of a solid that holds a polygon, or kNone.
Index faceThatHolds(const OccluderPolygons& all, const OccluderPolygon& polygon,
                    const Occluder& solid);

/// The box of a body, `margin` wider on all sides.
Box3 boxAround(const Occluder& body, double margin);

/// True if no polygon but those of `own`, ascending, comes inside, farther than the coincidence.
bool isEmpty(const OccluderPolygons& all, const Occluder& body, std::span<const Index> own);

}  // namespace radiosity
