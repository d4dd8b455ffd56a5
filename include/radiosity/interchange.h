// A scene for other renderers: its light can be computed elsewhere, and the pictures compared.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/render.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The picture that the other program is asked for.
struct ForeignPicture {
  Camera camera;
  int width = 512;   ///< pixels
  int height = 512;  ///< pixels
  /// What the files beside the scene are called, up to their own ending.
  std::string stem = "scene";
};

/// A scene in the words of another renderer, and the files that it names, which have to lie beside
/// it. Each surface is a mesh of triangles in metres, turned as the scene's faces are.
struct ForeignScene {
  std::string text;
  /// Names and contents; that of Mitsuba's meshes.
  std::vector<std::pair<std::string, std::vector<std::byte>>> files;
  /// Names and contents, linear: reflectances of textures, radiances of skies.
  std::vector<std::pair<std::string, Image>> images;
  std::vector<Note> notes;  ///< what the other program cannot be told, a line each
};

/// Mitsuba 3's XML (Jakob et al., mitsuba-renderer.org), for its variants of `rgb`: materials are
/// `diffuse`, within `twosided` where both sides reflect; emission is the radiance E / pi of
/// `area`. The meshes are a file of their own, STEM.serialized. Errors: InputError as
/// validate(scene).
ForeignScene mitsubaScene(const Scene& scene, const ForeignPicture& picture);

/// pbrt-v4's scene (Pharr, Jakob & Humphreys, pbrt.org). It renders spectra: greys are the same
/// there, the light of saturated colours after several bounces is not quite. Errors: likewise.
ForeignScene pbrtScene(const Scene& scene, const ForeignPicture& picture);

}  // namespace radiosity
