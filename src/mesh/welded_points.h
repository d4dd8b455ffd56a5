// Points that are one if they are closer than the weld radius.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A set of points, each with a radius: two are one if they are closer than both radii. So small
/// things beside large ones keep their details.
class WeldedPoints {
 public:
  /// The nearest point closer than `radius` and its own, or kNone.
  Index find(const Vec3& p, double radius) const;
  /// All such points, ascending.
  std::vector<Index> findAll(const Vec3& p, double radius) const;
  /// find(), or else a new point at `p`. A point never moves, so chains of close points do not
  /// drift.
  Index insert(const Vec3& p, double radius);

  /// Retires point `i`: find() and insert() no longer return it; its place stays readable.
  void retire(Index i);

  const Vec3& operator[](Index i) const { return points_[i]; }
  double radius(Index i) const { return radius_[i]; }
  std::size_t size() const { return points_.size(); }

 private:
  using Cell = glm::i64vec3;
  /// The points of one radius, by cells two radii wide. There are few radii.
  struct Layer {
    double radius;
    std::unordered_multimap<std::uint64_t, Index> cells;
  };
  static std::uint64_t key(const Cell& cell);
  static Cell cellOf(const Vec3& p, const Layer& layer);
  Layer& layerOf(double radius);
  template <class Take>
  void forNear(const Vec3& p, double radius, const Take& take) const;

  std::vector<Vec3> points_;
  std::vector<double> radius_;
  std::vector<Layer> layers_;
};

/// Welds places, all at once: fills `points` and returns the point of each place, closer to it than
/// the radius. Places become one point in their order, unless a group that would be several points
/// has a place closer than the radius to all of the group: then they are one, at that place.
std::vector<Index> weldPoints(std::span<const Vec3> places, std::span<const double> radius,
                              WeldedPoints& points);

}  // namespace radiosity
