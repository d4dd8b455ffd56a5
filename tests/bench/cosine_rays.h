// Form factors by ray casting: the method to beat, given every advantage we know of.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "embree_scene.h"
#include "formfactor/view_scene.h"
#include "radiosity/form_factors.h"
#include "sobol.h"

namespace radiosity::bench {

/// Casts rays from random points of a patch in cosine-distributed directions; the share of them
/// that ends on patch j is an unbiased estimate of F_ij, area to area.
///
/// Points are Owen-scrambled Sobol points, scrambled afresh for each patch: two dimensions place
/// the ray on the patch, two turn it. Rays go out in packets of 16 through Embree, sorted so that a
/// packet leaves in nearly one direction, against the coarse planar polygons; the patch is found
/// from the hit's position by the polygon's grid.
class CosineRays {
 public:
  /// `mesh` is kept by reference.
  explicit CosineRays(const PatchMesh& mesh);

  struct Row {
    std::vector<std::uint32_t> hits;  ///< by item: patches, then black backs by surface
    std::uint32_t sky = 0;
    std::uint32_t own = 0;  ///< ended on the polygon they left from: rounding at grazing angles
  };
  /// `rays`: a power of two. A patch without area gets no rays. Thread-safe.
  void cast(std::size_t patch, std::uint32_t rays, Row& row) const;

  std::size_t patches() const { return scene_.patches; }

 private:
  /// What one side of a triangle counts for, and how a hit's position (Embree's s and t) maps to
  /// the grid of its polygon: u[0] + u[1] s + u[2] t.
  struct Target {
    const PatchGrid* grid = nullptr;  ///< null: `item` everywhere
    std::array<float, 3> u{};
    std::array<float, 3> v{};
    std::uint32_t item = 0;
    std::uint32_t itemAt(float s, float t) const;
  };
  struct Batch;
  void fillBatch(std::size_t patch, std::size_t count, Batch& batch) const;
  void tracePacket(const Batch& batch, const std::uint32_t* order, std::uint32_t own_polygon,
                   int lanes, Row& row) const;

  const PatchMesh& mesh_;
  ViewScene scene_;
  EmbreeScene embree_;
  SobolPoints sobol_;
  std::vector<std::array<Target, 2>> targets_;  ///< by triangle; front, back
  std::vector<std::uint32_t> polygon_place_;    ///< in scene_.polygons, of each polygon of the mesh
};

/// The whole matrix, all threads. `both_ends`: the two estimates of each pair are merged by the
/// inverse of their variances, G = A_i A_j (F_ij + F_ji) / (A_i + A_j), which costs next to nothing
/// and takes nearly sqrt 2 off the error; row sums are then no longer exactly 1.
FormFactors castFormFactors(const PatchMesh& mesh, std::uint32_t rays, bool both_ends);

}  // namespace radiosity::bench
