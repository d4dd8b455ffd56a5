// Points over the area of a patch, where its rays start.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "formfactor/rays/direction_window.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A unit normal and two directions across it.
struct RayFrame {
  glm::vec3 x;
  glm::vec3 y;
  glm::vec3 z;
  // Of rays that go into a window, whose middle lies over x:
  float low = 0;     ///< squared sine of the lowest elevation
  float across = 1;  ///< the squared cosine of the same, which is exact where the sine is near 1
};

/// A patch as triangles and parallelograms to choose from by area. Coordinates are the mesh's times
/// `scale` less `middle`, in single precision.
class RayOrigins {
 public:
  RayOrigins(const PatchMesh& mesh, std::size_t patch, double scale, const Vec3& middle);

  struct Part {
    glm::vec3 corner;
    glm::vec3 ab;  ///< edges that leave the corner
    glm::vec3 ac;
    std::uint32_t parallelogram;  ///< 1, or 0 for a triangle: kernels read whole words
  };

  bool empty() const { return parts_.empty(); }
  const RayFrame& frame() const { return frame_; }
  /// That the patch is in.
  Index polygon() const { return polygon_; }
  const Part& part(std::uint32_t k) const { return parts_[k]; }
  std::size_t parts() const { return parts_.size(); }

  /// The part that x in [0, 1) falls on, and the place in its own range. Parts have shares of x by
  /// their area, so that points spread evenly over x spread evenly over all of it.
  std::uint32_t partAt(float x, float& within) const;
  /// Of all parts.
  std::vector<Vec3> corners() const;

  /// Rays go into the window alone, which has a share above 0. Returns the share of the hemisphere
  /// that it takes up.
  double aim(const DirectionWindow& window);
  bool isAimed() const { return is_aimed_; }
  /// Of the window: the range of squared sines of elevations, and half that of azimuths.
  float range() const { return range_; }
  float halfTurn() const { return half_turn_; }

 private:
  void addParts(const PatchMesh& mesh, std::size_t patch, double scale, const Vec3& middle);

  Index polygon_;
  RayFrame frame_{};
  bool is_aimed_ = false;
  float range_ = 1;
  float half_turn_ = 0;
  std::vector<Part> parts_;
  std::vector<double> end_;     ///< of each part's share of x; while adding, areas summed up
  std::vector<float> first_;    ///< where each part's share begins
  std::vector<float> stretch_;  ///< 1 / share
  /// The part at the low end of each of equal steps of x, one a part.
  std::vector<std::uint32_t> part_of_step_;
};

}  // namespace radiosity
