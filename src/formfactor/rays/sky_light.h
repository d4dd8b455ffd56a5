// Light of skies that are not alike in all directions, past what stands before them.
#pragma once

#include <cstdint>
#include <span>

#include "formfactor/rays/point_rays.h"
#include "formfactor/rays/sobol.h"
#include "radiosity/light.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// All calls but the constructor are thread-safe.
class SkyLight {
 public:
  /// Takes those of the lights that are such skies (unevenSkies()). Keeps the mesh and `rays`,
  /// which are of it, by reference.
  SkyLight(const PatchMesh& mesh, const PointRays& rays, std::span<const Light> lights, int bands);

  /// Adds the mean irradiance of a patch, W/m^2, a value a band: pi times the share `open` of what
  /// leaves it that meets nothing, which is known better than a few rays tell it, times the mean
  /// radiance that rays find there. Rays are as many as it takes for a standard error, by four sets
  /// of them, of .5% of it, or of a fiftieth of what the patch would get in the open: 256 to 4,096.
  /// Returns the square of that error, summed over the bands. `seed`: of the rays.
  double overPatch(std::size_t patch, double open, std::uint64_t seed,
                   std::span<double> irradiance) const;
  /// Adds that of a point, by 4,096 rays.
  void add(const RaySource& at, std::span<double> irradiance) const;

 private:
  struct Sum;
  void look(std::size_t patch, std::size_t count, std::uint64_t seed, Sum& sum) const;

  const PatchMesh& mesh_;
  const PointRays& rays_;
  Background sky_;
  HemisphereSet of_point_;
  double beyond_ = 0;  ///< metres: longer than the scene
  SobolPoints sobol_;
};

}  // namespace radiosity
