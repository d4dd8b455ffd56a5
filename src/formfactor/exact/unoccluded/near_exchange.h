// Exchange areas of elements close to each other.
#pragma once

#include <span>

#include "radiosity/base.h"
#include "visibility/clipping/clip_kernels.h"

namespace radiosity {

/// A triangle or convex quadrilateral with the quantities that its formulas need.
struct PlanarElement {
  std::span<const Vec3> outline;  ///< counter-clockwise about the normal
  Vec3 normal{0.0};               ///< unit
  Vec3 centroid{0.0};
  double radius = 0;  ///< largest distance of a corner from the centroid
};

struct NearValue {
  double exchange = 0;
  bool contour = false;  ///< contour integrals; else point to polygon over Gauss points
};

/// G of two elements, neither crossing the other's plane, to `tolerance` relative. Lambert's
/// formula over n x n Gauss points on the smaller one where its radius is small against its
/// centroid's distance from the other's edges, for there the formula is analytic, or where contour
/// integrals would cancel too far (thin elements); contour integrals otherwise.
NearValue nearExchange(const PlanarElement& a, const PlanarElement& b, double tolerance,
                       const ClipKernels<double>& kernels);

inline constexpr int kMostLambert = 16;
/// The same by n x n Gauss points on `from`, whatever the distance; n up to kMostLambert.
double lambertExchange(const PlanarElement& from, const PlanarElement& to, int n,
                       const ClipKernels<double>& kernels);

}  // namespace radiosity
