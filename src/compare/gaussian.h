// Pictures of one value a pixel, convolved with kernels that are products of a row and a column.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace radiosity {

/// One value a pixel, row-major.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  double& at(int x, int y) { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
  double at(int x, int y) const {
    return values[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

/// Weights at -r ... r: 2 r + 1.
using Kernel = std::vector<double>;

/// weight(-r) ... weight(r).
Kernel kernelOf(int radius, const std::function<double(int)>& weight);

/// exp(-x^2 / (2 sigma^2)), not normalised.
Kernel gaussianKernel(int radius, double sigma);

/// Convolved along rows and along columns; beyond its border a picture goes on as there.
Plane convolved(const Plane& plane, const Kernel& along_rows, const Kernel& along_columns);

}  // namespace radiosity
