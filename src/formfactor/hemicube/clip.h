// Clipping a polygon to the view of one face of the hemicube.
#pragma once

#include <vector>

#include "formfactor/hemicube/face_geometry.h"

namespace radiosity {

/// Clips one closed loop to the half-space `plane` as clipCorners() does, in homogeneous
/// coordinates. `in` and `out` must differ. Concave loops come back as one loop with edges that
/// run to and fro in the plane: harmless, since the fill is even-odd and no pixel centre lies in
/// a side plane.
///
/// A crossing is computed from its two ends in a fixed order, so two polygons that share an edge,
/// one this way and one that way, get the same point to the bit: no cracks.
void clipLoop(const std::vector<FacePoint>& in, const FaceGeometry& face, SidePlane plane,
              std::vector<FacePoint>& out);

}  // namespace radiosity
