// Form factor from a point to a polygon: Lambert's formula.
#pragma once

#include <span>

#include "radiosity/base.h"

namespace radiosity {

/// The fraction of the light leaving a small patch at `point` with unit `normal` that reaches a
/// planar polygon, nothing between them (Lambert 1760; Baum, Rushmeier & Winget 1989, eq. 9). The
/// polygon is counter-clockwise seen from the point and lies wholly in front of the point's plane
/// (clip it first); the other way round the value is negative.
///
/// With edges e from a to b, a and b relative to the point, c = a x e and s = |c|:
///
///     F = -1/(2 pi) sum of (normal . c) g,   g = atan2(s, a . b) / s
///
/// (e is the difference of the corners, never of a and b rounded; there is no division by zero but
/// on the edge itself, whose term is 0). Error: a few 1e-16 times the sum of the edges' angles, so
/// relative to F it grows with the square of distance over size.
double pointToPolygon(const Vec3& point, const Vec3& normal, std::span<const Vec3> polygon);

}  // namespace radiosity
