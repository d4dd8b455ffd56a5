// The camera, size and exposure of a picture.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "radiosity/render.h"

namespace radiosity::cli {

struct Picture {
  Camera camera;
  std::string camera_from;  ///< in words: where the camera came from
  Up up = Up::y;            ///< of the scene
  RenderOptions options;
};

/// The camera asked for, else the scene's first, else none yet (camera_from is empty); the size
/// asked for, where a side left out follows the camera's shape. InputError where --camera,
/// --exposure or an option of the picture is wrong: found before the work is done.
Picture choosePicture(const Request& request, const Scene& scene);

/// InputError where `files` show colours and the bands have none: before the work is done.
void requireColours(const Pipeline& pipeline, const Request& request, const OutputSet& files);

/// Where no camera was chosen, one that frames the scene and what is lit in it: `reflected`, N
/// values as reflectedLight(), or none.
void framePicture(Picture& picture, const PatchMesh& mesh, bool closed,
                  std::span<const double> reflected = {});

/// The picture's part of the report: camera and size.
void reportPicture(Report& report, const Picture& picture);

/// Metadata of an image file.
using Metadata = std::vector<std::pair<std::string, std::string>>;
Metadata metadataOf(const Picture& picture, const std::string& quantity, const std::string& unit);

/// Writes a picture's radiance to the .png and .exr among `files`, the light of elements, or else
/// of patches, to the .glb (without --lightmap), and reports the exposure, which it
/// returns.
double writeLight(Session& session, const PatchMesh& mesh, const SurfaceLight& light,
                  const Image& radiance, const Picture& picture, OutputSet& files);

/// Writes the .glb among `files` as a lit mesh, and reports how many triangles it has.
void writeLitMesh(Report& report, const PatchMesh& mesh, const SurfaceLight& light,
                  OutputSet& files, double ev, double crease);

/// The picture that `render` draws of light where no more is said, and the EV that it has.
struct ExposedPicture {
  Picture picture;
  double ev = 0;
};
/// Draws it, to find its EV.
ExposedPicture exposePicture(Session& session, Pipeline& pipeline, const SurfaceLight& light);

/// The EV of --exposure: the number, or what suits the picture.
double exposureOf(const Request& request, const Image& radiance);

}  // namespace radiosity::cli
