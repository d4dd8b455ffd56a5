// The rows of a few patches, by shadow rays from all others.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/known_rows.h"
#include "formfactor/rays/patch_points.h"
#include "formfactor/rays/point_rays.h"

namespace radiosity {

class WantedRows;

/// What each patch sees of some that emit, where exact rows past what stands in between take too
/// long. At points of the patch Lambert's formula tells what there is; rays from there to points
/// that are spread over the emitter tell which share of it is hidden (direct lighting by
/// stratified shadow rays: Shirley, Wang & Zimmerman, ACM TOG 15(1), 1996). There are the more rays
/// the less two halves of them agree, until they are off by 2% of what the patch sees of all
/// emitters, or .2% of what it would see of them with nothing in between.
class ShadowRows {
 public:
  /// `wanted`: patches, each once. `mesh` is kept by reference.
  ShadowRows(const PatchMesh& mesh, std::vector<Index> wanted, std::uint64_t seed);

  /// Rays of compute(), at least.
  double rays() const;
  /// Seconds of compute() by the clock, from some patches. Throws Cancelled.
  double seconds(Progress& progress) const;
  /// Bytes held by compute() beside this, about.
  std::size_t bytes() const;
  /// A row for each wanted patch. The same bits for any number of threads. Throws Cancelled.
  std::vector<KnownRow> compute(Progress& progress) const;

 private:
  struct Emitter {
    Index patch;
    PatchArea area;
    double radius;  ///< metres, from the centroid
  };
  struct Share {
    double value = 0;  ///< F from a patch to an emitter
    double error = 0;  ///< standard, estimated
  };
  struct Found;

  void addBlock(std::size_t begin, std::size_t count, WantedRows& rows, Progress& progress) const;
  void receive(Index patch, std::span<Share> shares) const;
  bool faces(Index patch, const Emitter& emitter) const;
  std::size_t firstLevel() const;
  bool settle(std::span<const std::array<Found, 2>> found, std::span<const std::size_t> facing,
              std::size_t count, std::span<Share> shares) const;
  Found look(const Emitter& emitter, const PatchPoints& points, std::size_t first,
             std::size_t count) const;
  double formula(const Emitter& emitter, const Vec3& at, const Vec3& normal) const;
  std::vector<SeenBack> backsOf(const Emitter& emitter) const;

  const PatchMesh& mesh_;
  std::vector<Index> wanted_;
  std::uint64_t seed_;
  std::vector<Emitter> emitters_;
  std::vector<Index> emitter_of_;  ///< N: among emitters_, or kNone
  PointRays rays_;
  SobolPoints sobol_;
};

}  // namespace radiosity
