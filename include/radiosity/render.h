// Pictures of a lit mesh, and pictures that explain one.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/elements.h"
#include "radiosity/option_line.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/point_materials.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// RGBA, float, row-major, top row first, straight (not premultiplied) linear colour.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<float> rgba;  ///< width * height * 4; alpha 0 where nothing was hit
};

/// Values beside a picture's colours, which .exr has in channels of their own.
struct ImageLayer {
  std::string name;                   ///< "normal"; its channels are "normal.X" and so on
  std::string unit;                   ///< "m"; empty: a pure number
  std::vector<std::string> channels;  ///< "X", "Y", "Z"; none: one channel, called `name`
  std::vector<float> values;          ///< width * height * channels, row-major, top row first
};

struct RenderOptions {
  int width = 512;  ///< 1 to 16384
  int height = 512;
  int samples = 4;          ///< anti-aliasing: samples x samples a pixel, 1 to 16
  bool smooth = true;       ///< interpolate over vertices; false: constant patches
  double crease = 30;       ///< degrees; values are not shared across sharper edges
  bool show_backs = false;  ///< one-sided patches seen from behind: true black, false transparent
  /// Radiance where nothing is hit, opaque: a sky of three bands or one. Empty: transparent.
  Background background;
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "width",
          .value = "PIXELS",
          .unit = "pixels",
          .help =
              "Width of the picture; from the height and the camera's aspect ratio if that alone "
              "is given"},
         o.width, {.from = 1, .to = 16384});
    list({.name = "height",
          .value = "PIXELS",
          .unit = "pixels",
          .help = "Default: from the width and the camera's aspect ratio; the width, where it has "
                  "none"},
         o.height, {.from = 1, .to = 16384});
    list({.name = "samples", .help = "N x N samples a pixel"}, o.samples, {.from = 1, .to = 16});
    list({.name = "crease",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "Interpolate across edges that bend less"},
         o.crease, {.from = 0, .to = 180});
    list({.name = "smooth"}, o.smooth);
    list({.name = "show_backs",
          .option = "backs",
          .value = "hide|show",
          .help = "hide: look through the backs of one-sided surfaces (default); show: they are "
                  "black",
          .on = "show",
          .off = "hide"},
         o.show_backs);
  }
};

/// A camera for a scene without one. It shows much of the scene, and lit parts of it: from inside a
/// room, open or closed, at eye height; else from outside, on the side from which most can be seen.
/// It is inside a room if nearly all directions end on fronts: a window may be open, a wall may not
/// be missing. Its name says which: "framed from inside", "framed from outside". `light`: N
/// values >= 0, the light that each patch reflects; empty: all are lit alike. `up`: of the scene.
/// `mesh`: with its planar polygons, as meshScene() makes it. Errors: InputError if sizes differ or
/// the aspect ratio is no positive number.
Camera framingCamera(const PatchMesh& mesh, bool closed, double aspect,
                     std::span<const double> light = {}, Up up = Up::y);

/// The typical brightness of lit patches, sum a v^2 / sum a v over areas a and values v; 0 if all
/// values are 0. N values.
double typicalLight(const PatchMesh& mesh, std::span<const double> light);

/// "eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEGREES" (up and fov may be left out) -> Camera. `up`: of
/// the scene. InputError says which part is wrong.
Camera parseCamera(const std::string& text, Up up = Up::y);

/// The camera as text that parseCamera() reads, with every digit.
std::string cameraText(const Camera& camera);

/// Corner values for Gouraud interpolation: for every entry of mesh.corners, `bands` values, the
/// area-weighted mean of `values` over the patches of its group (cornerGroups()): a lamp does not
/// bleed into its ceiling, a red wall not into a white one. A constant field stays that constant to
/// the bit. values: N * bands; result: mesh.corners.size() * bands, row-major.
std::vector<double> cornerValues(const PatchMesh& mesh, std::span<const double> values, int bands,
                                 double crease);

/// Colours to draw from values of `bands` bands each, row-major: three are red, green and blue as
/// they are, one is grey (three times the same). Errors: InputError for other numbers of bands,
/// which have no colours of their own, with the cure.
std::vector<double> rgbOf(std::span<const double> values, int bands);

/// The picture of a field over the patches (N * 3, row-major, finite): linear values, no tone
/// mapping. Colour is the mean over the samples that hit, alpha their share. Pixels are square. If
/// the picture is narrower than the camera's own aspect, the vertical field grows until the picture
/// shows the camera's whole view. Errors: InputError naming the option, camera or patch.
Image render(const PatchMesh& mesh, std::span<const double> values, const Camera& camera,
             const RenderOptions& options, Progress& progress);

/// The same from values at the corners (mesh.corners.size() * 3, like cornerValues()), if they are
/// known better than from the patches around them. Constant patches (not `smooth`) show `values`.
Image render(const PatchMesh& mesh, std::span<const double> values, std::span<const double> corners,
             const Camera& camera, const RenderOptions& options, Progress& progress);

/// The picture of the light that leaves the patches: radiance B / pi, W/m^2/sr. `radiosity`: N * 3,
/// W/m^2; `corners`: the same at the corners of patches (mesh.corners.size() * 3), or empty.
Image renderRadiance(const PatchMesh& mesh, std::span<const double> radiosity,
                     std::span<const double> corners, const Camera& camera,
                     const RenderOptions& options, Progress& progress);

/// Light on the patches, as pictures show it.
struct SurfaceLight {
  std::vector<double> patches;  ///< N * 3: radiosity B, W/m^2
  /// mesh.corners.size() * 3: B if it is known better than from the patches around; or empty.
  std::vector<double> corners;
  std::vector<double> reflected;  ///< N: as reflectedLight()
  Background sky;                 ///< what is seen where nothing is hit
  /// Light at the vertices of elements, drawn instead of the above wherever an element was
  /// evaluated; or null.
  std::shared_ptr<const Elements> elements;
  std::shared_ptr<const LightAtPoints> points;  ///< for gatherRadiance(); or null
  std::vector<double> reflectance;              ///< N * bands, with either of these two
  std::vector<double> emission;                 ///< likewise, W/m^2
  /// With three bands and either of these two: what replaces reflectance and emission where they
  /// vary over a patch; or null: means over patches are drawn.
  std::shared_ptr<const PointMaterials> materials;
};

/// N: how bright the reflected light B - E is, at least 0, W/m^2: its luminance, or the sum of
/// bands that are not three. `radiosity`: B, N * materials.bands, W/m^2.
std::vector<double> reflectedLight(std::span<const double> radiosity,
                                   const PatchMaterials& materials);

/// The light of radiosities B (N * materials.bands, W/m^2) on patches of these materials. Errors:
/// as rgbOf().
SurfaceLight surfaceLight(std::span<const double> radiosity, const PatchMaterials& materials);

/// What a picture's radiance is made of, a row a pixel: direct + indirect is its colour times its
/// alpha, as an .exr has it.
struct PictureParts {
  /// W/m^2/sr, red, green and blue: own emission, and the reflection of what emitters and lamps
  /// send straight; of the sky behind, all.
  std::vector<float> direct;
  std::vector<float> indirect;  ///< likewise, all else
  std::vector<float> albedo;    ///< reflectance, the mean over the samples that hit: likewise
  /// Standard error of the pixel's light by rays, over that light; empty: not known pixel by pixel.
  std::vector<float> error;
};

/// The same with the sky, if it shines, behind everything. `parts`, if not null, is filled: errors
/// as well InputError for light that has neither elements nor points, where direct and indirect
/// light are not told apart.
Image renderRadiance(const PatchMesh& mesh, const SurfaceLight& light, const Camera& camera,
                     const RenderOptions& options, Progress& progress,
                     PictureParts* parts = nullptr);

/// The same light as it falls: on white surfaces that do not shine, B is the irradiance, and the
/// picture's radiance irradiance / pi; there is no sky behind. `irradiance`: of the solution,
/// N * bands, W/m^2. Errors: as rgbOf().
SurfaceLight fallingLight(SurfaceLight light, std::span<const double> irradiance, int bands);

/// The layers of a picture. Of the patch in the middle of each pixel: depth (m, along the view
/// direction; infinite where nothing is), normal (unit, in the scene's axes; 0 where nothing is),
/// patch and surface (their numbers from 0, exact below 2^24; -1 where nothing is). Then those of
/// `parts`: albedo, direct, indirect and, where it is known, error.
std::vector<ImageLayer> pictureLayers(const PatchMesh& mesh, const Camera& camera,
                                      const RenderOptions& options, PictureParts parts);

/// Light that is gathered for every pixel.
struct PixelGatherOptions {
  /// Rays of indirect light, which the pixel's samples share; each sample has a power
  /// of two, 16 to 4096.
  int rays = 1024;
  /// Of the picture. At this limit pixels have fewer rays, but at least 64.
  double most_rays = 2e9;
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "rays"}, o.rays, {.from = 64, .to = 65536});
    list({.name = "most_rays"}, o.most_rays, {.from = 1});
  }
};

struct PixelGatherReport {
  std::size_t points = 0;  ///< at which light was evaluated
  double rays = 0;         ///< of indirect light
  int rays_a_pixel = 0;    ///< at most
  /// Of the rays: root mean square of the pixels' standard errors, over that of their light.
  double ray_error = 0;
  double seconds = 0;  ///< by the clock
};

struct PixelGather {
  Image radiance;
  PixelGatherReport report;
};

/// The picture of `light.points`, evaluated where samples of pixels see a patch: at four samples of
/// a pixel that sees one patch alone, at all samples of others. renderRadiance() interpolates the
/// same light between elements' vertices. The same bits for any number of threads. `parts`, if not
/// null, is filled. Errors: as render(), and InputError for options out of range. Throws Cancelled.
PixelGather gatherRadiance(const PatchMesh& mesh, const SurfaceLight& light, const Camera& camera,
                           const RenderOptions& options, const PixelGatherOptions& gather,
                           Progress& progress, PictureParts* parts = nullptr);

/// Estimates the points, rays and seconds of gatherRadiance() from one pixel in each 16 x 16.
PixelGatherReport foreseeGather(const PatchMesh& mesh, const SurfaceLight& light,
                                const Camera& camera, const RenderOptions& options,
                                const PixelGatherOptions& gather, Progress& progress);

/// N, 1: the picture shows the patch.
std::vector<std::uint8_t> visiblePatches(const PatchMesh& mesh, const Camera& camera,
                                         const RenderOptions& options, Progress& progress);

/// A lit scene of which a picture shows next to nothing.
struct UnlitView {
  double seen = 0;      ///< 99th percentile of radiance over the picture, W/m^2/sr
  double lit = 0;       ///< typical radiance of lit patches, W/m^2/sr
  Index brightest = 0;  ///< the patch that reflects most
};

/// Not empty if the scene is lit but the view is not: `radiance`, as renderRadiance() drew it,
/// stays ten stops below typical. Automatic exposure makes a picture even of that.
std::optional<UnlitView> unlitView(const PatchMesh& mesh, const SurfaceLight& light,
                                   const Image& radiance);

/// Exposure value: the picture is multiplied by 2^ev before the sRGB curve. Automatic: the 99th
/// percentile of luminance over hit pixels maps to 0.8 (emitters clip), unless the median over the
/// lit ones would fall below 0.1: a large lamp in view then clips too. 0 if nothing is lit.
/// `lamps`: width * height as lampPixels() finds them, or empty; these pixels do not count unless
/// nothing else is lit: the light of a room is that of what its lamps shine on.
double autoExposure(const Image& image, std::span<const std::uint8_t> lamps = {});

/// width * height, 1: the pixel's middle shows a patch that sends out more light of its own than it
/// reflects. Errors: as render().
std::vector<std::uint8_t> lampPixels(const PatchMesh& mesh, const SurfaceLight& light,
                                     const Camera& camera, const RenderOptions& options);

/// Multiplies by 2^ev; colours only.
Image exposed(const Image& image, double ev);

/// A scalar field in false colour (viridis, perceptually ordered). The result is display-referred:
/// ready for an sRGB file, opaque everywhere. Misses are a mid grey, backs (with show_backs) a dark
/// one. The legend, a strip at the bottom of the picture under the camera's view, holds title,
/// unit, colour bar and numbers; pictures narrower than 96 pixels or too low for it have none.
/// values: N. Range: [low, high], or the range of the values in view if low >= high; if the highest
/// is then more than twice the 99th percentile (a lamp), up to that percentile. An end is marked
/// "<=" or ">=" if values in view lie beyond it.
struct FalseColour {
  std::string title;
  std::string unit;
  double low = 0;
  double high = 0;
};
Image renderFalseColour(const PatchMesh& mesh, std::span<const double> values,
                        const FalseColour& legend, const Camera& camera,
                        const RenderOptions& options, Progress& progress);

/// The same for a value a pixel (width * height, top row first; NaN: a miss); the legend goes below
/// the picture, which grows by it.
Image falseColourPixels(int width, int height, std::span<const double> values,
                        const FalseColour& legend);

/// The same for the values of a picture of the mesh, with isolines at round numbers, which the
/// legend tells; they end where surfaces or sharp edges (options.crease) do.
Image falseColourPicture(const PatchMesh& mesh, std::span<const double> values,
                         const FalseColour& legend, const Camera& camera,
                         const RenderOptions& options);

/// What the light of a picture may be shown in.
struct ShownLight {
  const char* name;  ///< "luminance"
  const char* unit;  ///< "cd/m^2"
  bool photometric;  ///< of colours by luminance, at kLumensPerWatt
  bool falling;      ///< as it falls on surfaces (fallingLight()), not as it leaves them
};
/// radiance, luminance and illuminance.
std::span<const ShownLight> shownLights();

/// Title and unit for a picture of so many bands; its range is automatic.
FalseColour legendOf(const ShownLight& shown, int bands);

/// A value a pixel of a picture's radiance, W/m^2/sr (of illuminance, of the picture of
/// fallingLight()); NaN where nothing was hit.
std::vector<double> shownValues(const Image& radiance, const ShownLight& shown);

}  // namespace radiosity
