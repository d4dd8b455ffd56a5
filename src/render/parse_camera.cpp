// --camera "eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEGREES"
#include "radiosity/render.h"
#include "render/view.h"
#include "scene/camera_text.h"

namespace radiosity {

Camera parseCamera(const std::string& text) {
  Camera camera = readCamera(text, ';');
  makeView(camera, 1, 1);  // the checks every camera has to pass
  return camera;
}

}  // namespace radiosity
