// A mesh ready for rays, row by row.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "formfactor/rays/ray_caster.h"
#include "formfactor/rays/ray_rows.h"
#include "formfactor/rays/ray_windows.h"
#include "radiosity/base.h"

namespace radiosity {

/// The caster of a mesh, and its patches in the order of the matrix.
class RayScene {
 public:
  /// `mesh` is kept by reference.
  RayScene(const PatchMesh& mesh, std::uint64_t seed);

  const RayCaster& caster() const { return caster_; }
  std::size_t size() const { return order_.size(); }
  /// The patch at each position.
  const std::vector<Index>& order() const { return order_; }
  /// The position of each patch.
  const std::vector<Index>& position() const { return position_; }
  /// Areas by position, m^2.
  const std::vector<double>& area() const { return area_; }
  /// By position, the share of the area whose distance from the border rays do not resolve; 0 but
  /// for patches that are hardly wider.
  const std::vector<double>& unresolved() const { return unresolved_; }
  /// Continues a row, by position, to `rays` rays in each replicate. If `progress` is cancelled,
  /// returns early with a useless row. Thread-safe for different rows.
  void cast(std::size_t position, std::uint32_t rays, RayRow& row, const Progress& progress) const;

  /// Bytes held by this, about.
  std::size_t bytes() const { return caster_.bytes() + (windows_ ? windows_->bytes() : 0); }

 private:
  double aim(RayOrigins& origins) const;
  void addCounts(std::array<RayCaster::Counts, kReplicates>& counts, RayRow& row) const;

  RayCaster caster_;
  std::vector<Index> order_;
  std::vector<Index> position_;  ///< of each patch in it
  std::vector<double> area_;
  std::vector<double> unresolved_;
  std::vector<std::uint64_t> seed_;    ///< by position
  std::optional<RayWindows> windows_;  ///< of an open scene
};

}  // namespace radiosity
