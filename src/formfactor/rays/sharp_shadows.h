// Shadows with sharp edges as areas, without rays: of points, and of suns without a disc.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/geometry/box_tree.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/light.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// All calls but the constructor are thread-safe.
class SharpShadows {
 public:
  /// Keeps `mesh` and `rays`, which are of it, by reference.
  SharpShadows(const PatchMesh& mesh, const PointRays& rays);

  /// The mean over a patch of irradiance over the strength of a light, past all that hides it:
  /// exact but for rounding. None: the light has no closed form (Light::share()), it comes several
  /// ways, or too many triangles are in its way. Precondition: the patch has an area.
  std::optional<double> share(const Light& light, std::size_t patch) const;

 private:
  using Corners = std::array<Vec3, 3>;
  struct Shaft;

  Corners cornersOf(std::size_t triangle) const;
  std::optional<double> overPiece(const Light& light, std::size_t patch,
                                  const Corners& piece) const;
  static std::optional<double> shareOfParts(const Light& light, const Shaft& shaft,
                                            const std::vector<std::vector<Vec2>>& parts);
  std::optional<std::vector<std::vector<Vec2>>> shadowsOn(const Shaft& shaft, Index own) const;

  const PatchMesh& mesh_;
  const EmbreeScene& scene_;
  const ViewScene& view_;
  BoxTree tree_;  ///< of the scene's triangles, metres
};

}  // namespace radiosity
