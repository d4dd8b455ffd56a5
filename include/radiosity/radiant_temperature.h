// The radiant temperature of surroundings, as a person at a point feels them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/heat.h"
#include "radiosity/light.h"
#include "radiosity/patch_mesh.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The faces of a small cube, in their order: +x, -x, +y, -y, +z, -z.
inline constexpr std::size_t kRadiantFaces = 6;
inline constexpr std::array<const char*, kRadiantFaces> kRadiantFaceNames = {"+x", "-x", "+y",
                                                                             "-y", "+z", "-z"};

/// At P points, K. A radiant temperature is that of uniform black surroundings which send as much
/// heat; ISO 7726:1998, annexes B and C.
struct RadiantTemperatures {
  std::vector<double> plane;  ///< P * 6: of each face of a small cube
  /// Mean radiant temperature, the fourth root of the mean of plane^4 weighed by the areas that an
  /// upright person shows in the six directions, whichever way he or she faces: standing .08 up and
  /// down, .29 (the mean of .23 and .35) to each side; seated .18 and .26.
  std::vector<double> standing;
  std::vector<double> seated;
  std::vector<double> surfaces;  ///< P: the share of what the cube sees that are fronts of surfaces

  std::size_t size() const { return standing.size(); }
};

/// Of solved heat, all bands together. Exact but for rounding and the heat itself: each patch sends
/// J by its form factor from the point (pointFormFactors()), the rest is taken to be the black sky
/// of options.sky_temperature. Errors: as pointFormFactors(), and InputError for heat of another
/// mesh.
RadiantTemperatures radiantTemperatures(const PatchMesh& mesh, const HeatSolution& heat,
                                        const HeatOptions& options, std::span<const Vec3> points,
                                        Up up, Progress& progress);

}  // namespace radiosity
