// A set of points in which no two are closer than the weld radius.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

class WeldedPoints {
 public:
  explicit WeldedPoints(double radius) : radius_(radius), cell_(2.0 * radius) {}

  /// The nearest point closer than the radius, or kNone.
  Index find(const Vec3& p) const;
  /// All points closer than the radius, ascending.
  std::vector<Index> findAll(const Vec3& p) const;
  /// find(), or else a new point at `p`. A point never moves, so chains of close points do not
  /// drift.
  Index insert(const Vec3& p);

  /// Retires point `i`: find() and insert() no longer return it; its place stays readable.
  void retire(Index i);

  const Vec3& operator[](Index i) const { return points_[i]; }
  std::size_t size() const { return points_.size(); }

 private:
  using Cell = glm::i64vec3;
  static std::uint64_t key(const Cell& cell);
  template <class Take>
  void forNear(const Vec3& p, const Take& take) const;

  double radius_;
  double cell_;
  std::vector<Vec3> points_;
  std::unordered_multimap<std::uint64_t, Index> cells_;
};

/// Welds places, all at once: fills `points` and returns the point of each place, closer to it than
/// the radius. Places become one point in their order, unless a group that would be several points
/// has a place closer than the radius to all of the group: then they are one, at that place.
std::vector<Index> weldPoints(std::span<const Vec3> places, double radius, WeldedPoints& points);

}  // namespace radiosity
