// Images into linear texels.
#pragma once

#include <span>
#include <string>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// Outcome of reading an image: a texture, or `problem` says in a few words why there is none.
struct TextureResult {
  Texture texture;
  bool has_alpha = false;  ///< a channel that is not used
  bool above_one = false;  ///< a texel is above 1: it is no reflectance
  std::string problem;
};

/// TextureResult::problem where there is no such image.
inline constexpr const char* kImageMissing = "is not there";

/// The quantity that a texture multiplies.
enum class TextureUse { reflectance, emission };

/// An image that was looked for once, and what came of it.
struct LoadedTexture {
  Index index = kNone;  ///< into Scene::textures
  std::string problem;  ///< where there is none
  bool above_one = false;

  /// Why it cannot be used so; empty: it can.
  std::string problemAs(TextureUse use) const;
};

/// Says that the `what` (factor or colour) of `material` alone counts, since the image `file`
/// cannot be used for what LoadedTexture::problem says. Those that are not there are one note
/// together: where a folder is missing they are all.
void noteUnusedTexture(const std::string& file, const std::string& problem, const char* what,
                       const std::string& material, FeatureNotes& notes);

/// Puts what was read among the scene's textures.
LoadedTexture keepTexture(TextureResult result, bool repeat, Scene& scene);

/// Reads an image file. Integer samples are sRGB-encoded unless the file says that they are
/// linear; float samples are linear. Grey is repeated in all bands, alpha is left out.
/// `max_image`: SceneOptions::max_image; a larger one is not unpacked. Errors: RunError where it
/// does not fit into memory.
TextureResult readTexture(const std::string& path, double max_image);

/// The same for an image that is already in memory; the format is told by its first bytes.
TextureResult decodeTexture(const std::string& name, std::span<const unsigned char> bytes,
                            double max_image);

}  // namespace radiosity
