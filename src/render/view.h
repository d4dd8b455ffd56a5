// A camera and a picture size as the homogeneous transform of the rasteriser.
#pragma once

#include <glm/geometric.hpp>

#include "radiosity/base.h"
#include "radiosity/scene.h"

namespace radiosity {

/// World -> camera -> pixels. Camera space: x right, y up, z the depth along the view. Pixel space
/// is homogeneous: (X, Y, z) is seen at X / z pixels from the left and Y / z from the top of the
/// picture, pixel centres at halves. There is no division, so points behind the eye (z < 0) or
/// beside it (z = 0) need no special case.
struct View {
  Vec3 eye{0.0};
  Vec3 right{1.0, 0.0, 0.0};
  Vec3 up{0.0, 1.0, 0.0};
  Vec3 forward{0.0, 0.0, -1.0};
  double focal = 1;  ///< pixels: the distance at which one metre is one pixel wide
  double centre_x = 0.5;
  double centre_y = 0.5;
  int width = 1;
  int height = 1;

  Vec3 toCamera(const Vec3& world) const {
    const Vec3 v = world - eye;
    return {glm::dot(right, v), glm::dot(up, v), glm::dot(forward, v)};
  }
  Vec3 toPixels(const Vec3& camera) const {
    return {focal * camera.x + centre_x * camera.z, centre_y * camera.z - focal * camera.y,
            camera.z};
  }
  /// World direction d of the ray through a pixel position, with d . forward = 1.
  Vec3 rayThrough(double x, double y) const {
    return forward + right * ((x - centre_x) / focal) + up * ((centre_y - y) / focal);
  }
  /// Coefficients of a function linear in camera space, n . d, over pixels: for the ray d through
  /// pixel (x, y) with d.z = 1 the value is c.x * x + c.y * y + c.z.
  Vec3 overPixels(const Vec3& n) const {
    return {n.x / focal, -n.y / focal, n.z - (n.x * centre_x - n.y * centre_y) / focal};
  }
};

/// Pixels are square. If the picture is narrower than the camera's own aspect, the vertical field
/// grows so that the camera's horizontal field stays in the picture. Errors: InputError naming the
/// camera if its eye is its target, if it looks along its up vector, or if its field of view is not
/// between 0 and 180 degrees.
View makeView(const Camera& camera, int width, int height);

}  // namespace radiosity
