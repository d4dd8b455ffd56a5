// Finds the cell size that gives a wanted number of cells.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>

namespace radiosity {

/// The size up to `largest` for which count(size) is nearest to `wanted`, starting at `start`;
/// count falls about as size^-2, in steps. Stops within 2% of `wanted`, when the count no longer
/// changes, or after 8 calls. The last call of `count` may have another size than the returned one.
double sizeForCount(double start, double largest, double wanted,
                    const std::function<double(double)>& count);

}  // namespace radiosity
