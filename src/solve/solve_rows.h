// What solve() of patches and solve() of clusters share.
#pragma once

#include <span>
#include <string>

#include "radiosity/solve.h"

namespace radiosity {

/// How messages call patches: by surface where surfaces are known.
struct PatchNames {
  std::span<const Index> group;
  std::span<const std::string> names;

  std::string of(std::size_t i) const;
  /// The surfaces of some patches (else the patches), each once, at most twenty of them.
  std::string list(std::span<const std::size_t> patches) const;
};

/// Errors: InputError where a reflectance is not within 0 and 1, or an emission not finite and >=
/// 0.
void checkMaterials(std::span<const double> reflectance, std::span<const double> emission,
                    int bands, const PatchNames& names);

/// solve(), with more irradiance than the matrix and the sky give: N * bands, W/m^2, or empty.
Solution solveRows(const FormFactors& factors, std::span<const double> reflectance,
                   std::span<const double> emission, int bands, const SolveOptions& options,
                   Progress& progress, const PatchNames& names, std::span<const double> sky,
                   std::span<const double> more);

}  // namespace radiosity
