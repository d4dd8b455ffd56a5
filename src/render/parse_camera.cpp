// Cameras as text: "eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEGREES".
#include <fmt/format.h>

#include <numbers>

#include "radiosity/render.h"
#include "render/view.h"
#include "scene/obj/camera_text.h"

namespace radiosity {

Camera parseCamera(const std::string& text, Up up) {
  Camera camera = readCamera(text, ';', up);
  makeView(camera, 1, 1);  // checks the camera
  return camera;
}

std::string cameraText(const Camera& c) {
  return fmt::format("eye={},{},{};target={},{},{};up={},{},{};fov={}", c.eye.x, c.eye.y, c.eye.z,
                     c.target.x, c.target.y, c.target.z, c.up.x, c.up.y, c.up.z,
                     c.vertical_fov * 180 / std::numbers::pi);
}

}  // namespace radiosity
