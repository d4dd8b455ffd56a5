// The features to which light within a cluster is fitted: place and normal.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "formfactor/rays/ray_caster.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Features over one cluster. Places are in its sizes, so that they and normals spread alike.
class ClusterFeatures {
 public:
  static constexpr int kCount = 6;
  using Vector = Eigen::Matrix<double, kCount, 1>;
  using Square = Eigen::Matrix<double, kCount, kCount>;

  /// Mesh and caster are kept by reference; `size`: RayOrigins::size() of this cluster.
  ClusterFeatures(const PatchMesh& mesh, const RayCaster& caster, double size)
      : mesh_(mesh), caster_(caster), size_(std::max(size, 1e-12)) {}

  /// The features of a point in the coordinates of rays.
  Vector at(const glm::vec3& place, const glm::vec3& normal) const {
    Vector f;
    f << place.x / size_, place.y / size_, place.z / size_, normal.x, normal.y, normal.z;
    return f;
  }
  Vector ofPatch(Index i) const {
    return at(caster_.place(mesh_.centroid[i]), glm::vec3(mesh_.normal[i]));
  }
  /// The mean by area of `patches`, at least one of which has an area.
  Vector middleOf(std::span<const Index> patches) const {
    double area = 0;
    Vector middle = Vector::Zero();
    for (const Index i : patches) {
      area += mesh_.area[i];
      middle += mesh_.area[i] * ofPatch(i);
    }
    return middle / area;
  }

  /// The products about the mean, from sums over rays of features and of their products.
  static Square spread(const Square& products, const Vector& sum, double rays) {
    return products - sum * sum.transpose() / rays;
  }
  /// A term to add to the spread of each feature, which holds one that hardly spreads (the place
  /// across a plane).
  static double hold(const Square& spread) {
    return kHeld * std::max(spread.diagonal().maxCoeff(), 1e-30);
  }

  /// Rays of a replicate that look from each of so many clusters. All of them leave 0.9e-3 and
  /// 1.6e-3 of radiosity (relL2; a cow and a chair, 800 and 1,000 clusters, beside eight times as
  /// many). A fourth as many leave 2.8e-3 and 4.3e-3, and 1.5% of the power of single books.
  static std::uint32_t rays(std::size_t clusters) {
    const double rays = kAllRays / (kReplicates * double(clusters));
    return std::bit_floor(std::uint32_t(std::clamp(rays, kFewestRays, kMostRays)));
  }

 private:
  /// Share of the spread of the strongest feature.
  static constexpr double kHeld = 1e-6;
  /// Rays of all clusters together, about; the bounds are those of one cluster in each replicate.
  static constexpr double kAllRays = 1u << 24;
  static constexpr double kFewestRays = 256;
  static constexpr double kMostRays = 8192;

  const PatchMesh& mesh_;
  const RayCaster& caster_;
  double size_;
};

}  // namespace radiosity
