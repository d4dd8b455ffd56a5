// The gather method beside the matrix method: time and memory by passes and by patches.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clocks.h"

namespace radiosity::bench {

/// One way to the light of one scene.
struct GatherCost {
  std::string method;
  int passes = 0;  ///< of the gather method; 0: a matrix, filled and solved
  Timing timing;   ///< one thread, no files
  /// Area-weighted relL2 of the light reflected (B - E) by patch, against the solution with a
  /// tighter exact matrix of the same patches.
  double error = 0;
  std::size_t bytes = 0;  ///< the matrix alone; of the gather method all that it holds
};

struct GatherCosts {
  std::string scene;
  std::size_t patches = 0;
  std::size_t eyes = 0;  ///< at vertices
  std::vector<GatherCost> costs;
};

/// Verifies, on each scene, that gathering at patches is Jacobi's iteration on the matrix of the
/// same hemicubes and that at vertices a furnace stays one; then times all methods, prints a table
/// a scene and where the lines cross, and writes FOLDER/gather-costs.csv. False where the check
/// failed: that scene was not timed.
bool benchGather(bool quick, const std::string& folder);

}  // namespace radiosity::bench
