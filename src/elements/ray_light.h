// What a ray brings from where it ends.
#pragma once

#include <span>

#include "elements/source_cells.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/light.h"

namespace radiosity {

/// The radiosity of the surface that a ray ends on, or pi times the radiance of the sky, a value a
/// band.
class RayLight {
 public:
  /// Keeps `sources` by reference.
  RayLight(const SourceCells& sources, std::span<const Light> lights)
      : sources_(sources), background_(lights, sources.bands()) {}

  /// Adds it; nothing of a back without patches, nor of a polygon that the ray left from.
  void add(const RayEnd& end, const Vec3& from, std::span<double> sum) const;

 private:
  const SourceCells& sources_;
  Background background_;
};

}  // namespace radiosity
