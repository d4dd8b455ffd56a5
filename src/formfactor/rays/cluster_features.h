// What light within a cluster is fitted to: place and normal.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "formfactor/rays/ray_caster.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Over one cluster. Places are in sizes of the cluster, so that they and normals spread alike.
class ClusterFeatures {
 public:
  static constexpr int kCount = 6;
  using Vector = Eigen::Matrix<double, kCount, 1>;
  using Square = Eigen::Matrix<double, kCount, kCount>;

  /// All are kept by reference; `origins`: of this cluster.
  ClusterFeatures(const PatchMesh& mesh, const RayCaster& caster, const RayOrigins& origins)
      : mesh_(mesh), caster_(caster), size_(std::max(origins.size(), 1e-12)) {}

  /// Of a point in the coordinates of rays.
  Vector at(const glm::vec3& place, const glm::vec3& normal) const {
    Vector f;
    f << place.x / size_, place.y / size_, place.z / size_, normal.x, normal.y, normal.z;
    return f;
  }
  Vector ofPatch(Index i) const {
    return at(caster_.place(mesh_.centroid[i]), glm::vec3(mesh_.normal[i]));
  }
  /// The mean by area of `patches`, of which one has an area at least.
  Vector middleOf(std::span<const Index> patches) const {
    double area = 0;
    Vector middle = Vector::Zero();
    for (const Index i : patches) {
      area += mesh_.area[i];
      middle += mesh_.area[i] * ofPatch(i);
    }
    return middle / area;
  }

  /// Of sums over rays of features and of their products: the products about the mean.
  static Square spread(const Square& products, const Vector& sum, double rays) {
    return products - sum * sum.transpose() / rays;
  }
  /// Added to the spread of each feature, so that one that hardly spreads (what is normal to a
  /// plane) is held.
  static double hold(const Square& spread) {
    return kHeld * std::max(spread.diagonal().maxCoeff(), 1e-30);
  }

  /// Rays of a replicate that look from each of so many clusters.
  static std::uint32_t rays(std::size_t clusters) {
    const double rays = kAllRays / (kReplicates * double(clusters));
    return std::bit_floor(std::uint32_t(std::clamp(rays, kFewestRays, kMostRays)));
  }

 private:
  /// Of the spread of the strongest feature.
  static constexpr double kHeld = 1e-6;
  /// Of all clusters together, about, and of one of them in each replicate.
  static constexpr double kAllRays = 1u << 24;
  static constexpr double kFewestRays = 256;
  static constexpr double kMostRays = 8192;

  const PatchMesh& mesh_;
  const RayCaster& caster_;
  double size_;
};

}  // namespace radiosity
