// One target seen in double precision, and the converged view of it from a finely cut cell.
#pragma once

#include <span>

#include "formfactor/exact/occluded/batch_visibility.h"
#include "formfactor/exact/occluded/cell_rule.h"
#include "visibility/clipping/clip_kernels.h"

namespace radiosity::bench {

/// Integrals of the form factor over a cell.
struct PairSum {
  double visible = 0;
  double whole = 0;
};

class TargetLook {
 public:
  /// Keeps `target` and its blockers by reference. `normal`: of the sampled element.
  void take(const GroupTarget& target, const Vec3& normal) {
    target_ = &target;
    normal_ = normal;
  }
  /// Looks from points of a cell; the answers stay until the next call. `far`: by the kernels for
  /// far targets.
  void at(const SamplePoints& points, const SampleCell& cell, bool far = false) {
    view_.look(points.all(), cell.middle(), normal_, std::span(&target_, 1), far);
  }
  double visible(std::size_t point) const { return view_.visible(point)[0]; }
  double whole(std::size_t point) const { return view_.whole(point)[0]; }
  auto shape(std::size_t point) const { return view_.shape(point)[0]; }
  bool overlapping(std::size_t point) const { return view_.overlapping(point, 0); }
  PairSum sum(const SamplePoints& points) const {
    PairSum sum;
    for (std::size_t q = 0; q < points.count; ++q) {
      sum.visible += points.point[q].weight * visible(q);
      sum.whole += points.point[q].weight * whole(q);
    }
    return sum;
  }

 private:
  ClipKernelSet kernels_ = clipKernels(true);
  BatchVisibility<double> view_{kernels_.exact};
  const GroupTarget* target_ = nullptr;
  Vec3 normal_{0.0};
};

/// By 3 x 3 points in each of 4^levels parts: errors of kinks fall by a factor of four to eight a
/// level, all others by far more.
inline PairSum convergedCell(TargetLook& look, const SampleCell& cell, int levels) {
  if (levels == 0) {
    const SamplePoints points = cell.points(3);
    look.at(points, cell);
    return look.sum(points);
  }
  PairSum sum;
  for (std::size_t k = 0; k < 4; ++k) {
    const PairSum part = convergedCell(look, cell.child(k), levels - 1);
    sum.visible += part.visible;
    sum.whole += part.whole;
  }
  return sum;
}

}  // namespace radiosity::bench
