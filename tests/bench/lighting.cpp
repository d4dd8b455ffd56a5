#include "lighting.h"

#include <cmath>

namespace radiosity::bench {

Lighting::Lighting(const BenchScene& scene) : materials_(patchMaterials(scene.scene, scene.mesh)) {}

std::vector<double> Lighting::solve(const FormFactors& factors, double tolerance) const {
  SolveOptions options;
  options.tolerance = tolerance;
  Progress silent;
  return radiosity::solve(factors, materials_.reflectance, materials_.emission, materials_.bands,
                          options, silent)
      .radiosity;
}

std::vector<double> Lighting::bounce(const ExchangeMatrix& matrix,
                                     const std::vector<double>& b) const {
  const auto bands = std::size_t(materials_.bands);
  std::vector<double> next = materials_.emission;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    matrix.forRow(i, [&](Index j, double f) {
      for (std::size_t k = 0; k < bands; ++k) {
        next[bands * i + k] += materials_.reflectance[bands * i + k] * f * b[bands * j + k];
      }
    });
  }
  return next;
}

double relativeError(const PatchMesh& mesh, const std::vector<double>& b,
                     const std::vector<double>& reference, const std::vector<double>& base) {
  double wrong = 0;
  double all = 0;
  const std::size_t bands = reference.size() / mesh.size();
  for (std::size_t k = 0; k < reference.size(); ++k) {
    const double area = mesh.area[k / bands];
    const double value = reference[k] - (base.empty() ? 0 : base[k]);
    wrong += area * (b[k] - reference[k]) * (b[k] - reference[k]);
    all += area * value * value;
  }
  return std::sqrt(wrong / all);
}

}  // namespace radiosity::bench
