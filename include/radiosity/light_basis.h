// One solution a lamp, all in the same passes over the matrix; any mixture of them afterwards
// without a solve.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace [[gnu::visibility("default")]] radiosity {

/// What emits together: a lamp, or all that shines at one hour of a day.
struct LightSource {
  std::string name;
  std::vector<double> emission;  ///< N * bands, row-major, radiant exitance, W/m^2
  std::vector<double> sky;       ///< radiance a band, W/m^2/sr; empty: dark
};

/// A source for each emitting surface, by its name, and one called "sky" where the sky shines: they
/// add up to the light of the scene.
std::vector<LightSource> lightSources(const PatchMaterials& materials, const PatchMesh& mesh);

/// Sources from a table (RFC 4180) with the columns `set`, `name` and `emission` (radiant exitance,
/// W/m^2), or `r`, `g` and `b` instead of it: what `name` stands for, as SceneOptions::set finds
/// it, shines so in the source `set`, in the order in which sets are first named. Errors:
/// InputError that names file and line: columns, numbers that are not finite and >= 0, a name that
/// nothing has, a surface twice in a set; columns of colours where `bands` is not 3.
std::vector<LightSource> readLightSources(const std::string& csv_path, const Scene& scene,
                                          const PatchMesh& mesh, int bands);

/// Light of sources, each by itself: of source s and band b in column s * bands + b.
struct LightBasis {
  std::vector<std::string> names;  ///< S
  int bands = 0;                   ///< of one source
  PatchMaterials materials;        ///< N x (S * bands): reflectance is the same for every source
  Solution solution;               ///< N x (S * bands)
};

/// Solves for all sources at once, each to options.tolerance of its own largest emission: every
/// product with the matrix serves them all. Errors: as solve(); InputError where there is no
/// source, or two have one name.
LightBasis solveBasis(const FormFactors& factors, const PatchMaterials& materials,
                      const PatchMesh& mesh, std::span<const LightSource> sources,
                      const SolveOptions& options, Progress& progress);

/// A source and what it is multiplied by: 1 as it was solved, 0 off.
struct LightWeight {
  std::string name;
  double factor = 1;
};

/// Materials and light of a mixture, as if it had been solved for. Of the summary: error_bound, the
/// sum of the sources' bound times the factors, and the energy; the message says what is mixed.
struct MixedLight {
  PatchMaterials materials;
  Solution solution;
};

/// Sources that are not named are off. Errors: InputError for a name that is not there, one that is
/// given twice, or a factor that is not finite and >= 0.
MixedLight mixLight(const LightBasis& basis, std::span<const LightWeight> weights);

}  // namespace radiosity
