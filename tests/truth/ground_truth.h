// Form factors to check others against: slow, simple, and on a code path of their own. Of the
// library only PatchMesh is used.
#pragma once

#include <cstddef>
#include <vector>

#include "blockers.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::truth {

struct TruthOptions {
  /// Error of each F_ij aimed at, as a fraction of the mean form factor 1/N.
  double accuracy = 1e-7;
  /// Looks a pair may cost; a pair that takes more keeps the error it has, and the row says so.
  std::size_t most_points = 400000;
};

/// Row i of the form-factor matrix.
struct TruthRow {
  std::vector<double> form_factors;  ///< N; F_ij, area to area, one-sided patches
  double largest_error = 0;    ///< largest error figure of an F_ij; the true error is below it
  std::size_t occluded = 0;    ///< pairs that see each other past something
  std::size_t hidden = 0;      ///< pairs that face each other and see nothing of each other
  std::size_t unfinished = 0;  ///< pairs that ran out of points
  std::size_t points = 0;      ///< looked from, over all pairs
};

/// Unoccluded pairs: contour integrals in long double. Occluded ones: the same minus the blocked
/// part, clipped exactly against every planar polygon that comes between, integrated over the
/// patch that lies farther from the blockers, cell by cell between the critical lines.
class GroundTruth {
 public:
  /// Keeps a reference to the mesh.
  explicit GroundTruth(const PatchMesh& mesh, const TruthOptions& options = {});

  /// Thread-safe: rows may be computed in parallel.
  TruthRow row(std::size_t i) const;

  /// F_ij alone.
  double formFactor(std::size_t i, std::size_t j) const;

 private:
  struct Exchange {
    double value = 0;
    double error = 0;
    std::size_t points = 0;
    bool occluded = false;
    bool hidden = false;
    bool unfinished = false;
  };
  Exchange exchange(const Sheet& a, const Sheet& b, double tolerance) const;
  void addPair(std::size_t i, std::size_t j, TruthRow& row) const;

  const PatchMesh& mesh_;
  TruthOptions options_;
  std::vector<Vec3> vertices_;  ///< the mesh's, about the scene's middle
  double coincidence_ = 0;
  std::vector<std::vector<Sheet>> sheets_;  ///< N: convex parts of each patch
  BlockerSet blockers_;
};

/// Row i alone.
std::vector<double> truthRow(const PatchMesh& mesh, std::size_t i,
                             const TruthOptions& options = {});

}  // namespace radiosity::truth
