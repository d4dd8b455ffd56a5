// The faces of a scene with coincident vertices merged, for the checks.
#pragma once

#include <span>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// The F faces of the scene. Positions are relative to `centre`, so that a scene far from the
/// origin is checked as accurately as one near it.
struct WeldedFaces {
  Vec3 centre{0.0};
  double tolerance = 0;  ///< metres: closer points are one
  std::vector<Vec3> points;
  std::vector<std::size_t> offset;  ///< F + 1, into corners
  std::vector<Index> corners;       ///< into points, without repetition of the previous one
  std::vector<Vec3> area_vector;    ///< F, normal times area, of the unwelded face
  /// F, 1: fewer than three distinct corners, or thinner than the tolerance.
  std::vector<std::uint8_t> degenerate;

  std::size_t size() const { return area_vector.size(); }
  std::span<const Index> face(std::size_t f) const {
    return {corners.data() + offset[f], offset[f + 1] - offset[f]};
  }
};

/// `lower`, `upper`: box of the scene. `weld`: coincidence as a fraction of its diagonal.
WeldedFaces weldFaces(const Scene& scene, const Vec3& lower, const Vec3& upper, double weld);

}  // namespace radiosity
