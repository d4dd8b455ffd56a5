// The rows of some unknowns, summed over patches.
#pragma once

#include <span>
#include <vector>

#include "formfactor/known_rows.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Holds two numbers for each pair of a wanted unknown and any other.
class UnknownRows {
 public:
  /// `mesh` is kept by reference. `wanted`: unknowns, each once.
  UnknownRows(const PatchMesh& mesh, std::span<const Index> wanted);

  /// Adds a pair of patches, each pair once: exchange, m^2, and its error.
  void add(Index a, Index b, double exchange, double error);
  /// Adds the backs that a patch sees.
  void addBacks(Index patch, std::span<const SeenBack> seen);
  /// A row for each wanted unknown. Leaves nothing behind.
  std::vector<KnownRow> take();

  static std::size_t bytes(std::size_t wanted, std::size_t unknowns) {
    return 2 * sizeof(double) * wanted * unknowns;
  }

 private:
  void addFrom(Index from, Index to, double exchange, double error);

  const PatchMesh& mesh_;
  std::vector<Index> which_;      ///< K: among those wanted, or kNone
  std::vector<double> exchange_;  ///< wanted * K, m^2
  std::vector<double> squares_;   ///< of its error
  std::vector<KnownRow> rows_;
  std::vector<double> area_;
};

}  // namespace radiosity
