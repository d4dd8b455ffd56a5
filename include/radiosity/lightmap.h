// A lightmap: light of the elements as an image that is laid over the scene's own faces by a second
// set of texture coordinates. Faces are planar as a rule, so that charts need no unwrapping: each
// is a projection of connected faces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// What the texels are, W/m^2.
enum class LightmapShows {
  irradiance,  ///< H: what arrives, to be multiplied by the viewer's own material and texture
  radiosity    ///< B = E + rho H: what leaves; textures are averaged over patches
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
};

/// A triangle of one side of a face. Faces with more corners are cut into triangles.
struct LightmapTriangle {
  Index face = 0;                  ///< of the scene
  std::uint8_t side = 0;           ///< 0 front, 1 back
  std::array<Index, 3> corner{};   ///< of the face, from 0; counter-clockwise seen from the side
  Index chart = kNone;             ///< two triangles of one chart agree where they share a vertex
  std::array<Vec2, 3> texcoord{};  ///< (0, 0) is the top left of the first texel, v downwards
};

struct LightmapReport {
  std::size_t charts = 0;
  std::size_t triangles = 0;
  double texels_per_metre = 0;  ///< of all charts; curved ones have fewer, ...
  double least_density = 1;     ///< ... by this factor at most: the least cosine to a chart's plane
  std::size_t inside = 0;       ///< texels whose centre is in a chart, ...
  std::size_t padding = 0;      ///< ... near one, ...
  std::size_t unused = 0;       ///< ... and neither
  std::size_t dark = 0;         ///< of the first two: black, no patch of their surface is there
  double seconds = 0;           ///< by the clock
};

struct Lightmap {
  Image image;  ///< alpha 1 where there is light, 0 where nothing looks
  LightmapShows shows = LightmapShows::irradiance;
  /// Of all fronts, then of the backs that have patches; by face. A face without area has none.
  std::vector<LightmapTriangle> triangles;
  LightmapReport report;
};

/// Padding: every texel whose centre is so many texels from a chart, or nearer, has light.
inline constexpr int kLightmapPadding = 2;

/// Evaluates `light`'s elements at every texel that a chart touches and kLightmapPadding around:
/// at the point of the chart that is nearest to the texel's centre, and where no patch is there
/// (it is buried, or another face lies over it) at the nearest one of the same surface and side.
/// All charts have one density, the largest that fits. `mesh` is that of `scene`. n log n in the
/// faces and linear in the texels; the same bits for any number of threads. Errors: InputError for
/// options out of range, light without elements, and more charts than the map has room for (with
/// the size that would do). Throws Cancelled.
Lightmap makeLightmap(const Scene& scene, const PatchMesh& mesh, const SurfaceLight& light,
                      const LightmapOptions& options, Progress& progress);

}  // namespace radiosity
