// Form factors from points: the view of a sensor, a small surface in the scene, of each patch.
#pragma once

#include <span>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Sets factors[k * N + i]: the fraction of the flux leaving a small surface at points[k] (metres)
/// with the normal normals[k] (of any length but 0) that reaches patch i; P points, N patches,
/// P * N values, row-major. Point to polygon by Lambert's formula, with blocked parts clipped off
/// exactly: errors are those of rounding. The rest of a row, up to 1, goes to the sky and to backs.
/// By reciprocity sum_i factors[k * N + i] B_i is the irradiance at the point, W/m^2.
///
/// A point may be anywhere, also outside of the scene and inside of bodies. A point on a surface
/// (within 1e-7 of the scene's diagonal; it is taken to be that far in front of it unless the
/// normals agree) sees the side that its normal points to.
///
/// All cores, the same bits for any number of them. Errors: InputError if sizes do not match, and
/// for a number that is not finite or a normal without direction, by its row; Cancelled.
void pointFormFactors(const PatchMesh& mesh, std::span<const Vec3> points,
                      std::span<const Vec3> normals, std::span<double> factors, Progress& progress);

}  // namespace radiosity
