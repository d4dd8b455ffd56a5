// Area to area without anything between, by contour integrals in long double.
#pragma once

#include "loop.h"

namespace radiosity::truth {

/// A F, the exchange area of two convex polygons with nothing between them, m^2, each facing the
/// side it is counter-clockwise from. Parts behind the other's plane are cut away first.
/// A F = 1/(2 pi) sum over pairs of edges of (e.f) * double integral of ln r (Stokes; Sparrow
/// 1963): the inner integral in closed form, the outer by Gauss where the edges are apart and by
/// the double exponential rule (Takahasi & Mori 1974), cut at the singular points, where they are
/// close or touch. About 1e-15 of the smaller area.
double unoccludedExchange(const Loop& a, const Loop& b);

/// The same where neither reaches behind the other's plane: nothing is cut, so that slivers whose
/// plane is lost in rounding do.
double facingExchange(const Loop& a, const Loop& b);

}  // namespace radiosity::truth
