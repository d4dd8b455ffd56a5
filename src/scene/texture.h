// Reads images as linear texels.
#pragma once

#include <span>
#include <string>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// The result of reading an image: a texture, or the `problem` in a few words.
struct TextureResult {
  Texture texture;
  bool has_alpha = false;  ///< a channel that is not used
  bool above_one = false;  ///< a texel is above 1, so it is not a reflectance
  std::string problem;
};

/// TextureResult::problem of a missing image.
inline constexpr const char* kImageMissing = "is not there";

/// The quantity that a texture multiplies.
enum class TextureUse { reflectance, emission };

/// The result of looking for an image once.
struct LoadedTexture {
  Index index = kNone;  ///< into Scene::textures
  std::string problem;  ///< why there is no texture
  bool above_one = false;

  /// The reason why it cannot be used so; empty if it can.
  std::string problemAs(TextureUse use) const;
};

/// Notes that the image `file` cannot be used because of `problem`, so that only the `what` (factor
/// or colour) of `material` counts. Without its emission texture a material must emit nothing: a
/// house of which the windows alone should would emit all over. Missing images share one note: if a
/// folder is missing, all are.
void noteUnusedTexture(const std::string& file, const std::string& problem, TextureUse use,
                       const char* what, const std::string& material, FeatureNotes& notes);

/// Adds a result to the scene's textures.
LoadedTexture keepTexture(TextureResult result, bool repeat, Scene& scene);

/// Reads an image file. Integer samples are sRGB-encoded unless the file says that they are linear;
/// float samples are linear. Grey is repeated in all bands, alpha is left out. `max_image`:
/// SceneOptions::max_image; larger images are not unpacked. Errors: RunError if it does not fit
/// into memory.
TextureResult readTexture(const std::string& path, double max_image);

/// The same for an image in memory; its first bytes tell the format.
TextureResult decodeTexture(const std::string& name, std::span<const unsigned char> bytes,
                            double max_image);

}  // namespace radiosity
