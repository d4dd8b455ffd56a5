// The camera, size and exposure of a picture.
#pragma once

#include <string>
#include <vector>

#include "cli/commands.h"
#include "radiosity/render.h"

namespace radiosity::cli {

struct Picture {
  Camera camera;
  std::string camera_from;  ///< in words: where the camera came from
  RenderOptions options;
};

/// The camera asked for, else the scene's first, else none yet (camera_from is empty); the size
/// asked for, where a side left out follows the camera's shape. InputError where --camera,
/// --exposure or an option of the picture is wrong: found before the work is done.
Picture choosePicture(const Request& request, const Scene& scene);

/// Where no camera was chosen, one that frames the scene, from inside a closed one. Needs the mesh
/// and the accounts of the form factors.
void framePicture(Picture& picture, Pipeline& pipeline);

/// Radiance B / pi, W/m^2/sr, linear.
Image radiancePicture(const Picture& picture, Pipeline& pipeline, Session& session);

/// The EV of --exposure: the number, or what suits the picture.
double exposureOf(const Request& request, const Image& radiance);

}  // namespace radiosity::cli
