// One solution per lamp, all from the same passes over the matrix; any mixture of them then needs
// no solve.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Emission that belongs together: a lamp, or all light at one hour of a day.
struct LightSource {
  std::string name;
  std::vector<double> emission;  ///< N * bands, row-major, radiant exitance, W/m^2
  std::vector<Light> lights;     ///< without a surface
};

/// A source for each emitting surface, by its name, and for each light without a surface ("sky"),
/// as far as they shine. They add up to the light of the scene.
std::vector<LightSource> lightSources(const PatchMaterials& materials, const PatchMesh& mesh);

/// Reads sources from a table (RFC 4180) with the columns `set`, `name` and `emission` (radiant
/// exitance, W/m^2), or `r`, `g` and `b` instead of it. A line gives this emission, in the source
/// `set`, to all that SceneOptions::set finds by `name`. Sources are in the order in which sets
/// first occur. Errors: InputError that names file and line: columns, numbers that are not finite
/// and >= 0, an unknown name, a surface twice in a set; columns of colours if `bands` is not 3.
std::vector<LightSource> readLightSources(const std::string& csv_path, const Scene& scene,
                                          const PatchMesh& mesh, int bands);

/// Light of each source by itself: that of source s and band b is in column s * bands + b.
struct LightBasis {
  std::vector<std::string> names;  ///< S
  int bands = 0;                   ///< of one source
  PatchMaterials materials;        ///< N x (S * bands): reflectance is the same for every source
  Solution solution;               ///< N x (S * bands)
};

/// Solves for all sources at once, each to options.tolerance of its own largest emission: every
/// product with the matrix serves them all. Errors: as solve(); InputError if there is no source,
/// or if two have one name.
LightBasis solveBasis(const FormFactors& factors, const PatchMaterials& materials,
                      const PatchMesh& mesh, std::span<const LightSource> sources,
                      const SolveOptions& options, Progress& progress);

/// A source and its factor: 1 as it was solved, 0 off.
struct LightWeight {
  std::string name;
  double factor = 1;
};

/// Materials and light of a mixture, as if it had been solved for. The summary has error_bound (the
/// sum of the sources' bounds times the factors), the energy and a message that names the mixture.
struct MixedLight {
  PatchMaterials materials;
  Solution solution;
};

/// Mixes the sources; those not named are off. Errors: InputError for an unknown name, a name given
/// twice, or a factor that is not finite and >= 0.
MixedLight mixLight(const LightBasis& basis, std::span<const LightWeight> weights);

}  // namespace radiosity
