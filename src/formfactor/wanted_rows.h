// The rows of some patches, collected from pairs.
#pragma once

#include <span>
#include <vector>

#include "formfactor/known_rows.h"

namespace radiosity {

/// Holds two numbers for each pair of a wanted patch and any other.
class WantedRows {
 public:
  /// `wanted`: of `patches`, each once.
  WantedRows(std::size_t patches, std::span<const Index> wanted);

  /// Adds to a pair of patches: exchange, m^2, and its error, independent of others.
  void add(Index a, Index b, double exchange, double error);
  /// Adds the backs that a patch sees, shares of its view.
  void addBacks(Index patch, std::span<const SeenBack> seen);
  /// A row for each wanted patch. Leaves nothing behind.
  std::vector<KnownRow> take();

  static std::size_t bytes(std::size_t wanted, std::size_t patches) {
    return 2 * sizeof(double) * wanted * patches;
  }

 private:
  void addFrom(Index from, Index to, double exchange, double error);

  std::vector<Index> which_;      ///< N: among those wanted, or kNone
  std::vector<double> exchange_;  ///< wanted * N, m^2
  std::vector<double> squares_;   ///< of its error
  std::vector<KnownRow> rows_;
};

}  // namespace radiosity
