// Form factors from points: what a sensor, a small surface in the scene, sees of each patch.
#pragma once

#include <span>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace [[gnu::visibility("default")]] radiosity {

/// factors[k * N + i]: the fraction of what leaves a small surface at points[k] (metres), of normal
/// normals[k] (of any length but 0), that reaches patch i; P points, N patches, P * N values,
/// row-major. Point to polygon by Lambert's formula, with what is in between clipped off exactly:
/// errors are those of rounding. What a row lacks of 1 goes to the sky and to backs. By
/// reciprocity sum_i factors[k * N + i] B_i is the irradiance at the point, W/m^2.
///
/// A point may be anywhere, also outside of the scene and inside of bodies. One on a surface
/// (within 1e-7 of the scene's diagonal, where it is taken to be so far in front of it unless the
/// normals agree) sees what is on the side that its normal points to.
///
/// All cores, the same bits for any number of them. Errors: InputError where sizes do not fit and
/// for a number that is not finite or a normal without direction, by its row; Cancelled.
void pointFormFactors(const PatchMesh& mesh, std::span<const Vec3> points,
                      std::span<const Vec3> normals, std::span<double> factors, Progress& progress);

}  // namespace radiosity
