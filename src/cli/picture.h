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
  RenderOptions options;
};

/// The camera asked for, else the scene's first, else none yet (camera_from is empty); the size
/// asked for, where a side left out follows the camera's shape. InputError where --camera,
/// --exposure or an option of the picture is wrong: found before the work is done.
Picture choosePicture(const Request& request, const Scene& scene);

/// What is drawn: radiosity, W/m^2.
struct Light {
  std::vector<double> patches;    ///< N * 3
  std::vector<double> corners;    ///< mesh.corners.size() * 3; empty: from the patches around them
  std::vector<double> reflected;  ///< N: reflectedLight()
  Vec3 sky{0.0};                  ///< radiance where nothing is hit, W/m^2/sr
};
/// One band is drawn grey; InputError where there are more than three, or two.
Light solvedLight(Pipeline& pipeline);
Light gatheredLight(Pipeline& pipeline);

/// InputError where `files` show colours and the bands have none: before the work is done.
void requireColours(const Pipeline& pipeline, const Request& request, const OutputSet& files);

/// N: how bright what each patch does not emit itself is, of any bands (brightnessOf()), W/m^2.
/// `radiosity`: N * bands.
std::vector<double> reflectedLight(Pipeline& pipeline, std::span<const double> radiosity);

/// Where no camera was chosen, one that frames the scene and what is lit in it: `reflected`, N
/// values or none.
void framePicture(Picture& picture, const PatchMesh& mesh, bool closed,
                  std::span<const double> reflected = {});

/// Radiance B / pi, W/m^2/sr, linear; the sky's, where it shines, behind all.
Image radiancePicture(const Picture& picture, const PatchMesh& mesh, const Light& light,
                      Progress& progress);

/// The picture's part of the report: camera and size.
void reportPicture(Report& report, const Picture& picture);

/// What an image file says of itself.
using Metadata = std::vector<std::pair<std::string, std::string>>;
Metadata metadataOf(const Picture& picture, const std::string& quantity, const std::string& unit);

/// Draws the .png and .exr among `files`, writes the .glb, and reports the exposure.
void drawLight(Session& session, const PatchMesh& mesh, const Light& light, const Picture& picture,
               OutputSet& files);

/// Writes the .glb among `files` as a lit mesh.
void writeLitMesh(const PatchMesh& mesh, const Light& light, OutputSet& files, double ev,
                  double crease);

/// The EV of --exposure: the number, or what suits the picture.
double exposureOf(const Request& request, const Image& radiance);

}  // namespace radiosity::cli
