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
  std::string camera_from;  ///< the origin of the camera in words
  Up up = Up::y;            ///< of the scene
  RenderOptions options;
};

/// The camera asked for, else the scene's first, else none yet (camera_from is empty); the size
/// asked for, in which a missing side follows from the camera's aspect. Errors: InputError if
/// --camera, --exposure or an option of the picture is wrong, before any work is done.
Picture choosePicture(const Request& request, const Scene& scene);

/// Throws InputError if `files` show colours and the bands have none, before any work is done.
void requireColours(const Pipeline& pipeline, const Request& request, const OutputSet& files);

/// If no camera was chosen, chooses one that frames the scene and its lit parts. `reflected`: N
/// values from reflectedLight(), or none.
void framePicture(Picture& picture, const PatchMesh& mesh, bool closed,
                  std::span<const double> reflected = {});

/// Reports the camera and size of the picture.
void reportPicture(Report& report, const Picture& picture);

/// The metadata of an image file.
using Metadata = std::vector<std::pair<std::string, std::string>>;
Metadata metadataOf(const Picture& picture, const std::string& quantity, const std::string& unit);

/// Whether a picture is asked for: .png, .exr or .hdr.
bool hasPicture(const OutputSet& files);

/// Writes a picture's radiance to the .png, .exr and .hdr among `files`, and the light of elements,
/// or else of patches, to the .glb (without --lightmap). Reports the exposure and returns it.
/// `layers`: of the .exr.
double writeLight(Session& session, const PatchMesh& mesh, const SurfaceLight& light,
                  const Image& radiance, const Picture& picture, OutputSet& files,
                  std::span<const ImageLayer> layers = {});

/// Writes the .glb among `files` as a lit mesh, and reports its number of triangles.
void writeLitMesh(Report& report, const PatchMesh& mesh, const SurfaceLight& light,
                  OutputSet& files, double ev, double crease);

/// The picture of light that `render` draws by default, with its EV.
struct ExposedPicture {
  Picture picture;
  double ev = 0;
};
/// Draws that picture to find its EV.
ExposedPicture exposePicture(Session& session, Pipeline& pipeline, const SurfaceLight& light);

/// The EV of --exposure: the number, or the automatic one of the picture of that light.
double exposureOf(const Request& request, const PatchMesh& mesh, const SurfaceLight& light,
                  const Image& radiance, const Picture& picture);

}  // namespace radiosity::cli
