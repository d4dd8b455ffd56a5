// A lightmap: light of the elements as an image that is laid over the scene's own faces by a second
// set of texture coordinates. Faces are planar as a rule, so that charts need no unwrapping: each
// is a projection of connected faces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/option_line.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The quantity of the texels, W/m^2.
enum class LightmapShows {
  irradiance,  ///< H, to be multiplied by the viewer's own material and texture
  radiosity    ///< B = E + rho H; textures are averaged over patches
};

struct LightmapOptions {
  static constexpr int kSmallest = 16;
  static constexpr int kLargest = 4096;

  int size = 1024;  ///< kSmallest to kLargest: texels along either edge
  LightmapShows shows = LightmapShows::irradiance;
  double crease = 30;  ///< degrees, 0 to 180; no chart goes across sharper edges

  /// Bytes that making and writing the map takes at most, beside the scene and its light.
  std::size_t bytes() const;
  /// Throws InputError naming the option and its range.
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "size",
          .option = "lightmap-size",
          .value = "TEXELS",
          .unit = "texels",
          .help = "Width and height"},
         o.size, {.from = kSmallest, .to = kLargest});
    list(
        {.name = "shows",
         .option = "lightmap-shows",
         .value = "QUANTITY",
         .help = "irradiance (default): what arrives, for viewers that multiply it by material and "
                 "texture; radiosity: what leaves, textures averaged over patches; W/m^2"},
        o.shows);
    list({.name = "crease",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "Interpolate across edges that bend less"},
         o.crease, {.from = 0, .to = 180});
  }
};

/// A triangle of one side of a face. Faces with more corners are cut into triangles.
struct LightmapTriangle {
  Index face = 0;                  ///< of the scene
  std::uint8_t side = 0;           ///< 0 front, 1 back
  std::array<Index, 3> corner{};   ///< of the face, from 0; counter-clockwise seen from the side
  Index chart = kNone;             ///< at a shared vertex two triangles of one chart agree
  std::array<Vec2, 3> texcoord{};  ///< (0, 0) is the top left of the first texel, v downwards
};

struct LightmapReport {
  std::size_t charts = 0;
  std::size_t triangles = 0;
  double texels_per_metre = 0;  ///< in flat charts; curved ones have fewer
  double least_density = 1;     ///< share of that in the worst chart: the least cosine to its plane
  std::size_t inside = 0;       ///< texels whose centre is in a chart
  std::size_t padding = 0;      ///< texels near a chart
  std::size_t unused = 0;       ///< all others
  std::size_t dark = 0;  ///< in a chart or near one, but black: no patch of the surface is there
  double seconds = 0;    ///< by the clock
};

struct Lightmap {
  Image image;  ///< alpha 1 in and near charts, else 0
  LightmapShows shows = LightmapShows::irradiance;
  /// Of all fronts, then of the backs that have patches, by face; none of a face without area.
  std::vector<LightmapTriangle> triangles;
  LightmapReport report;
};

/// The padding: every texel whose centre is at most this many texels from a chart has light.
inline constexpr int kLightmapPadding = 2;

/// Evaluates the elements of `light` at every texel that a chart touches and kLightmapPadding
/// around. The point is the chart's nearest to the texel's centre. If no patch is there (it is
/// buried, or another face lies over it), it is the nearest one of the same surface and side. All
/// charts have one density, the largest that fits. `mesh` is that of `scene`. n log n in the faces
/// and linear in the texels; the same bits for any number of threads. Errors: InputError for
/// options out of range, light without elements, and more charts than the map has room for (with
/// the size that would do). Throws Cancelled.
Lightmap makeLightmap(const Scene& scene, const PatchMesh& mesh, const SurfaceLight& light,
                      const LightmapOptions& options, Progress& progress);

}  // namespace radiosity
