// Exchange areas by contour integrals.
#pragma once

#include <span>

#include "radiosity/base.h"

namespace radiosity {

/// Corners a loop may have: a quadrilateral cut by one plane.
inline constexpr std::size_t kMostContourCorners = 5;

/// G = A_a F_ab of two planar loops, each counter-clockwise about its normal, nothing between them
/// and neither crossing the other's plane (clip them first), by Stokes' theorem:
///
///     G = 1/(2 pi) sum over edges e of a, f of b of  integral integral ln r  de . df
///
/// Parallel edges and edges whose lines meet (as those of neighbours do) are in closed form,
/// orthogonal ones vanish, others take the closed form along the longer edge and quadrature along
/// the shorter, split, if that takes fewer points, at the places nearest to the other's ends and
/// line. Loops may share edges, vertices, or parts of edges (T-junctions).
///
/// Error: below `tolerance` * G, 1e-2 to 1e-14, but for the rounding left where terms cancel, about
/// 1e-16 times the square of the pair's extent. exact_closed_forms_test and exact_unoccluded_test
/// hold it to published values and to long double.
double contourExchange(std::span<const Vec3> a, std::span<const Vec3> b, double tolerance);

}  // namespace radiosity
