// The part of solve() that patches and clusters have in common.
#pragma once

#include <span>
#include <string>

#include "formfactor/light_on_patches.h"
#include "radiosity/solve.h"

namespace radiosity {

/// Names of patches in messages: their surfaces, where these are known.
struct PatchNames {
  std::span<const Index> group;
  std::span<const std::string> names;

  std::string of(std::size_t i) const;
  /// A list of the surfaces of some patches, or of the patches if surfaces are not known: each
  /// once, at most twenty.
  std::string list(std::span<const std::size_t> patches) const;
};

/// Errors: InputError if a reflectance is not within 0 and 1, or an emission not finite and >= 0.
void checkMaterials(std::span<const double> reflectance, std::span<const double> emission,
                    int bands, const PatchNames& names);

/// solve() with irradiance by lights without a surface, N * bands, W/m^2, and, where it is not
/// empty, `more` beyond that and that of the matrix.
Solution solveRows(const FormFactors& factors, std::span<const double> reflectance,
                   std::span<const double> emission, int bands, const SolveOptions& options,
                   Progress& progress, const PatchNames& names, std::span<const double> by_lights,
                   std::span<const double> more);

/// Says in the message which lights reach nothing, and how far the others may be off.
void noteErrorOf(const LightFall& by_lights, SolveSummary& summary);

}  // namespace radiosity
