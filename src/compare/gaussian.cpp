#include "compare/gaussian.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace radiosity {

Kernel kernelOf(int radius, const std::function<double(int)>& weight) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(weight(x));
  return kernel;
}

Kernel gaussianKernel(int radius, double sigma) {
  return kernelOf(radius, [&](int x) { return std::exp(-double(x * x) / (2 * sigma * sigma)); });
}

Plane convolved(const Plane& plane, const Kernel& along_rows, const Kernel& along_columns) {
  const auto rows = std::size_t(plane.height);
  Plane across = plane;
  const int wide = int(along_rows.size() / 2);
  parallelFor(rows, 8, [&](std::size_t row) {
    const int y = int(row);
    for (int x = 0; x < plane.width; ++x) {
      double sum = 0;
      for (int k = -wide; k <= wide; ++k) {
        sum += along_rows[std::size_t(k) + std::size_t(wide)] *
               plane.at(std::clamp(x + k, 0, plane.width - 1), y);
      }
      across.at(x, y) = sum;
    }
  });
  Plane out = across;
  const int high = int(along_columns.size() / 2);
  parallelFor(rows, 8, [&](std::size_t row) {
    const int y = int(row);
    for (int x = 0; x < plane.width; ++x) out.at(x, y) = 0;
    for (int k = -high; k <= high; ++k) {
      const int from = std::clamp(y + k, 0, plane.height - 1);
      for (int x = 0; x < plane.width; ++x) {
        out.at(x, y) += along_columns[std::size_t(k) + std::size_t(high)] * across.at(x, from);
      }
    }
  });
  return out;
}

}  // namespace radiosity
