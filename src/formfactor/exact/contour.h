// Exchange areas by contour integrals.
#pragma once

#include <span>

#include "radiosity/base.h"

namespace radiosity {

/// G = A_a F_ab of two planar loops, each counter-clockwise about its normal, nothing between them
/// and neither crossing the other's plane (clip them first), by Stokes' theorem:
///
///     G = 1/(2 pi) sum over edges e of a, f of b of  integral integral ln r  de . df
///
/// Parallel edges in closed form, orthogonal ones vanish, others by the closed form along the
/// longer edge and quadrature along the shorter, split where it comes nearest to the other's ends
/// and line. Loops may share edges, vertices, or parts of edges (T-junctions).
///
/// Error, against the same sum in long double with the finest rules: below `tolerance` * G, for
/// loops no farther apart than about 10 radii, but at least about 1e-15 times the square of the
/// larger loop's diameter: the sum cancels far away and where the loops differ much in size.
/// `tolerance`: 1e-2 to 1e-14.
double contourExchange(std::span<const Vec3> a, std::span<const Vec3> b, double tolerance);

}  // namespace radiosity
