// Light without a surface that rays do not find, past what stands in its way.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "formfactor/rays/point_rays.h"
#include "formfactor/rays/sharp_shadows.h"
#include "formfactor/rays/sobol.h"
#include "radiosity/light.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

struct PatchPoints;

/// All calls but the constructor are thread-safe.
class AimedLight {
 public:
  /// Takes those of the lights that are aimed. Keeps `rays`, of `mesh`, by reference.
  AimedLight(const PatchMesh& mesh, const PointRays& rays, std::span<const Light> lights);

  std::span<const Light> lights() const { return lights_; }

  /// Adds the irradiance at a point, W/m^2, a value a band. Points see the same places of a wide
  /// light, so that their errors vary as smoothly as light does. Returns the square of the standard
  /// error, summed over the bands.
  double add(const RaySource& at, std::span<double> irradiance) const;

  /// The mean over a patch of irradiance over the strength, of one light.
  struct Share {
    double value = 0;
    double error = 0;  ///< standard, estimated
  };
  /// Of each of lights(). By the closed form of the parts that see it, if the light has one and no
  /// more hides it than SharpShadows takes; of a patch of which nothing is hidden by that of a wide
  /// light; else by points of the patch, the more the less two halves of them agree, until what
  /// they are off is little of all light on the patch. `seed`: of the points.
  void overPatch(std::size_t patch, const SharpShadows& sharp, std::uint64_t seed,
                 std::span<Share> shares) const;

 private:
  struct Ways;
  struct Found;

  Vec3 endOf(const Vec3& from, const LightRay& ray) const;
  double addWide(const Light& light, const RaySource& at, std::span<double> irradiance) const;
  Found atPoints(const Light& light, const PatchPoints& points) const;
  Share overPatch(const Light& light, std::size_t patch, const PatchPoints& first,
                  const PatchPoints& second) const;
  std::optional<double> unobstructed(const Light& light, std::size_t patch) const;

  const PatchMesh& mesh_;
  const PointRays& rays_;
  std::vector<Light> lights_;
  double beyond_ = 0;  ///< metres: longer than the scene
  SobolPoints sobol_;
};

}  // namespace radiosity
