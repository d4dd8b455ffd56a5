#include "compare/similarity.h"

#include <numeric>

namespace radiosity {

std::optional<double> structuralSimilarity(const Plane& a, const Plane& b) {
  constexpr int kRadius = 5;
  constexpr double kSigma = 1.5;
  constexpr double kC1 = 0.01 * 0.01;
  constexpr double kC2 = 0.03 * 0.03;
  if (a.width <= 2 * kRadius || a.height <= 2 * kRadius) return std::nullopt;
  Kernel window = gaussianKernel(kRadius, kSigma);
  const double sum = std::accumulate(window.begin(), window.end(), 0.0);
  for (double& weight : window) weight /= sum;
  const auto mean = [&](const Plane& x, const Plane& y) {
    Plane product = x;
    for (std::size_t k = 0; k < product.values.size(); ++k) product.values[k] *= y.values[k];
    return convolved(product, window, window);
  };
  const Plane mean_a = convolved(a, window, window);
  const Plane mean_b = convolved(b, window, window);
  const Plane aa = mean(a, a);
  const Plane bb = mean(b, b);
  const Plane ab = mean(a, b);
  double total = 0;
  std::size_t windows = 0;
  for (int y = kRadius; y < a.height - kRadius; ++y) {
    for (int x = kRadius; x < a.width - kRadius; ++x) {
      const double ma = mean_a.at(x, y);
      const double mb = mean_b.at(x, y);
      const double variances = aa.at(x, y) - ma * ma + bb.at(x, y) - mb * mb;
      const double covariance = ab.at(x, y) - ma * mb;
      total += (2 * ma * mb + kC1) * (2 * covariance + kC2) /
               ((ma * ma + mb * mb + kC1) * (variances + kC2));
      ++windows;
    }
  }
  return total / double(windows);
}

}  // namespace radiosity
