// Form factors by rays: what it takes, and the whole matrix.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formfactor/rays/ray_caster.h"
#include "formfactor/rays/ray_rows.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// What rays need of a mesh, and the order of its unknowns.
class RayScene {
 public:
  /// `mesh` is kept by reference.
  RayScene(const PatchMesh& mesh, std::uint64_t seed);

  const RayCaster& caster() const { return caster_; }
  std::size_t size() const { return order_.size(); }
  /// The unknown at each position.
  const std::vector<Index>& order() const { return order_; }
  /// By position, m^2.
  const std::vector<double>& area() const { return area_; }
  /// No ray can get out: those that do went through a gap.
  bool provedClosed() const { return proved_closed_; }
  /// That making this took, by the clock.
  double seconds() const { return seconds_; }

  /// Continues a row, by position, to `rays` rays in each replicate. Returns early, with a row that
  /// is of no use, when `progress` is cancelled. Thread-safe for different rows.
  void cast(std::size_t position, std::uint32_t rays, RayRow& row, const Progress& progress) const;

 private:
  void addCounts(std::array<RayCaster::Counts, kReplicates>& counts, RayRow& row) const;

  double start_;
  RayCaster caster_;
  std::vector<Index> order_;
  std::vector<double> area_;
  std::vector<std::uint64_t> seed_;  ///< by position
  bool proved_closed_ = false;
  double seconds_ = 0;
};

struct RayEstimate {
  double rays = 0;  ///< all in all
  double seconds = 0;
  std::size_t bytes = 0;
  std::size_t matrix_bytes = 0;
};

/// From some rows, which are cast to see how their error falls.
RayEstimate estimateRays(const RayScene& scene, const FormFactorOptions& options,
                         Progress& progress);

/// Rows are cast in rounds: each is continued until the error expected of it, merged with what the
/// others count, is below options.toleranceOf(rays) times its norm (relL2). Errors: RunError where the
/// estimate exceeds options.memory_limit.
FormFactors rayFactors(const PatchMesh& mesh, const RayScene& scene, const RayEstimate& estimate,
                       const FormFactorOptions& options, Progress& progress);

}  // namespace radiosity
