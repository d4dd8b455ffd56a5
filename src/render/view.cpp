#include "render/view.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/finite.h"

namespace radiosity {
namespace {

void check(const Camera& camera) {
  const std::string name = camera.name.empty() ? "camera" : "camera \"" + camera.name + "\"";
  if (!isFinite(camera.eye) || !isFinite(camera.target) || !isFinite(camera.up)) {
    throw InputError(name + ": eye, target and up must be finite numbers");
  }
  if (camera.eye == camera.target) {
    throw InputError(name + ": eye and target are the same point; move one of them");
  }
  if (!(camera.vertical_fov > 0 && camera.vertical_fov < std::numbers::pi)) {
    throw InputError(
        fmt::format("{}: the field of view is {:g} degrees; it must lie between 0 and 180", name,
                    camera.vertical_fov * 180 / std::numbers::pi));
  }
  if (!(camera.aspect >= 0) || !std::isfinite(camera.aspect)) {
    throw InputError(
        fmt::format("{}: the aspect ratio is {:g}; it must be positive, or 0 for the picture's",
                    name, camera.aspect));
  }
}

}  // namespace

View makeView(const Camera& camera, int width, int height) {
  check(camera);
  View view;
  view.eye = camera.eye;
  view.forward = glm::normalize(camera.target - camera.eye);
  const Vec3 right = glm::cross(view.forward, camera.up);
  // With a sine below 1e-6 the sideways direction would consist of rounding errors.
  if (!(glm::length(right) > 1e-6 * glm::length(camera.up))) {
    throw InputError(
        fmt::format("camera{}: it looks along its up vector ({:g}, {:g}, {:g}); give another up",
                    camera.name.empty() ? "" : " \"" + camera.name + "\"", camera.up.x, camera.up.y,
                    camera.up.z));
  }
  view.right = glm::normalize(right);
  view.up = glm::cross(view.right, view.forward);

  double half = std::tan(camera.vertical_fov / 2);
  const double aspect = double(width) / height;
  if (camera.aspect > aspect) half *= camera.aspect / aspect;
  view.focal = height / (2 * half);
  view.centre_x = width / 2.0;
  view.centre_y = height / 2.0;
  view.width = width;
  view.height = height;
  return view;
}

}  // namespace radiosity
