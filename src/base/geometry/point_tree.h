// Points by place: which lie above a plane.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "base/geometry/box_tree.h"

namespace radiosity {

/// Gives the same answers as a loop over all points, mostly in logarithmic time.
class PointTree {
 public:
  PointTree() = default;
  explicit PointTree(std::span<const Vec3> points) : points_(points.begin(), points.end()) {
    std::vector<Box3> boxes;
    boxes.reserve(points.size());
    for (const Vec3& p : points) boxes.push_back({p, p});
    tree_ = BoxTree(boxes);
  }

  /// Whether dot(normal, p) > height for any point. `normal`: of length 1, or less.
  bool anyAbove(const Vec3& normal, double height) const {
    bool found = false;
    tree_.search([&](const Box3& box) { return highest(box, normal) > height - slack(height); },
                 [&](Index p) {
                   found = glm::dot(normal, points_[p]) > height;
                   return !found;
                 });
    return found;
  }

  /// Points whose distance from the plane dot(normal, p) = offset is `most` at most, ascending.
  std::vector<Index> near(const Vec3& normal, double offset, double most) const {
    std::vector<Index> found;
    const double more = most + slack(offset);
    tree_.search(
        [&](const Box3& box) {
          return highest(box, normal) >= offset - more && -highest(box, -normal) <= offset + more;
        },
        [&](Index p) {
          if (std::abs(glm::dot(normal, points_[p]) - offset) <= most) found.push_back(p);
          return true;
        });
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  static double highest(const Box3& box, const Vec3& normal) {
    return glm::dot(0.5 * (box.low + box.high), normal) +
           glm::dot(0.5 * (box.high - box.low), glm::abs(normal));
  }
  /// Tolerance for the rounding of boxes, for coordinates of about 1; points are tested exactly.
  static double slack(double height) { return 1e-14 * (4 + std::abs(height)); }

  std::vector<Vec3> points_;
  BoxTree tree_;
};

}  // namespace radiosity
