// The light of a benchmark scene from given form factors, and how far two lights are apart.
#pragma once

#include <vector>

#include "bench_scenes.h"
#include "radiosity/form_factors.h"
#include "radiosity/solve.h"

namespace radiosity::bench {

/// The scene's own reflectances and emissions.
class Lighting {
 public:
  explicit Lighting(const BenchScene& scene);

  const PatchMaterials& materials() const { return materials_; }
  /// Radiosity, N * 3, to `tolerance` of SolveOptions.
  std::vector<double> solve(const FormFactors& factors, double tolerance) const;
  /// E + rho F b.
  std::vector<double> bounce(const ExchangeMatrix& matrix, const std::vector<double>& b) const;
  /// N * 3.
  const std::vector<double>& emission() const { return materials_.emission; }

 private:
  PatchMaterials materials_;
};

/// Area-weighted relL2 over all bands: |b - reference| / |reference - base|. With the emission as
/// `base` (empty: 0) the light that is reflected counts alone.
double relativeError(const PatchMesh& mesh, const std::vector<double>& b,
                     const std::vector<double>& reference, const std::vector<double>& base = {});

}  // namespace radiosity::bench
