// What lights without a surface give to patches and to other places.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Irradiance of places, N * bands, row-major, W/m^2.
struct LightFall {
  std::vector<double> irradiance;
  /// Standard, estimated: the root of the mean square, by area, over that of irradiance. 0 where
  /// nothing stands between places and lights.
  double error = 0;
  std::vector<std::string> lost;  ///< names of aimed lights that reach none of the places
};

/// Looks at a mesh, which is kept by reference, once and only if a light is aimed. All cores; the
/// same bits for any number of them.
class LightOnPatches {
 public:
  explicit LightOnPatches(const PatchMesh& mesh);
  ~LightOnPatches();

  /// Means over the patches of aimed lights, and of bright spots of skies. Throws Cancelled.
  LightFall aimed(std::span<const Light> lights, int bands, Progress& progress);
  /// The same, and of the lights that come from where nothing stands. `open`: by patch, the share
  /// of what leaves it that meets nothing, of which an exact row's account may be a little below 0.
  /// Errors: InputError if shares are not those of the mesh. Throws Cancelled.
  LightFall all(std::span<const Light> lights, std::span<const double> open, int bands,
                Progress& progress);

  /// A place that is on a polygon of the mesh, or off them all (kNone).
  struct Place {
    Vec3 position{0.0};
    Vec3 normal{0.0};
    Index own = kNone;
  };
  /// The irradiance of places by aimed lights, and by skies that are not uniform.
  std::vector<double> aimedAt(std::span<const Light> lights, std::span<const Place> places,
                              int bands, Progress& progress);

 private:
  struct Rays;
  struct Means;
  const Rays& rays();
  Means meansOfAimed(std::span<const Light> lights, int bands, Progress& progress);
  Means meansFromAround(std::span<const Light> lights, std::span<const double> open, int bands,
                        Progress& progress);
  LightFall fallOf(Means means) const;

  const PatchMesh& mesh_;
  std::unique_ptr<Rays> rays_;
};

}  // namespace radiosity
