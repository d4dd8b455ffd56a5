// The directions in which rays can meet anything: in an open scene often few of them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/geometry/box_tree.h"
#include "formfactor/rays/embree_scene.h"
#include "formfactor/rays/ray_origins.h"

namespace radiosity {

/// Finds the windows of origins among the triangles of a scene. Outside them there is nothing but
/// sky, so that rays into them alone know a small thing far away by a few thousand rays, of which
/// 10^12 would be needed blind.
class RayWindows {
 public:
  /// Windows with more of the hemisphere than this spare few rays.
  static constexpr double kMostShare = 0.25;

  /// `embree` is kept by reference.
  explicit RayWindows(const EmbreeScene& embree);

  /// A window with all directions in which rays can meet a triangle, and more. None if it has more
  /// than kMostShare of the hemisphere.
  std::optional<DirectionWindow> of(const RayOrigins& origins) const;

  std::size_t bytes() const { return tree_.bytes(); }

 private:
  class Search;

  const EmbreeScene& embree_;
  BoxTree tree_;  ///< of the triangles, in Embree's coordinates
};

}  // namespace radiosity
