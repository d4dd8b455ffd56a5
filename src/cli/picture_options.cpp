// Options of cameras, pictures, elements and lightmaps.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "base/luminance.h"
#include "cli/options.h"
#include "radiosity/lightmap.h"
#include "radiosity/names.h"

namespace radiosity::cli {

void addCameraOption(CLI::App& app, Request& r) {
  add(app, "Picture", "--camera", r.camera, "CAMERA",
      "Name of a camera in the scene, or eye=X,Y,Z;target=X,Y,Z[;up=X,Y,Z][;fov=DEGREES], metres "
      "(default: the scene's first, else one in a room at eye height, or from outside where there "
      "is none, aimed at lit surfaces)");
}

void addCameraOptions(CLI::App& app, Request& r) {
  addCameraOption(app, r);
  const RenderOptions defaults;
  add(app, "Picture", "--width", r.width, "PIXELS", fmt::format("Default {}", defaults.width));
  add(app, "Picture", "--height", r.height, "PIXELS",
      "Default: from the width and the camera's aspect ratio; the width, where it has none");
}

void addExposureOption(CLI::App& app, Request& r, const char* shown_in) {
  add(app, "Picture", "--exposure", r.exposure, "auto|EV",
      fmt::format("{} radiance times 2^EV (default auto; the EV is printed)", shown_in));
}

void addCreaseOption(CLI::App& app, Request& r) {
  add(app, "Picture", "--crease", r.crease, "DEGREES",
      fmt::format("Interpolate across edges that bend less (default {})", RenderOptions().crease));
}

void addRenderOptions(CLI::App& app, Request& r) {
  const RenderOptions defaults;
  addExposureOption(app, r, "The .png and .glb show");
  add(app, "Picture", "--samples", r.samples, "N",
      fmt::format("N x N samples a pixel, 1 to 16 (default {})", defaults.samples));
  app.add_flag("--flat", r.flat, "One colour a patch, not interpolated")->group("Picture");
  add(app, "Picture", "--backs", r.backs, "hide|show",
      "hide: look through the backs of one-sided surfaces (default); show: they are black")
      ->check(CLI::IsMember({"hide", "show"}));
}

void addLightmapOptions(CLI::App& app, Request& r) {
  const LightmapOptions defaults;
  add(app, "Lightmap", "--lightmap", r.lightmap, "FILE.exr",
      "Write light as an image, and the scene's own mesh, with coordinates for it, as the .glb of "
      "-o "
      "(of a glTF file with its nodes, names, materials, textures and normals)");
  add(app, "Lightmap", "--lightmap-size", r.lightmap_size, "TEXELS",
      fmt::format("Width and height, {} to {} (default {})", LightmapOptions::kSmallest,
                  LightmapOptions::kLargest, defaults.size));
  add(app, "Lightmap", "--lightmap-shows", r.lightmap_shows, "QUANTITY",
      "irradiance (default): what arrives, for viewers that multiply it by material and texture; "
      "radiosity: what leaves, textures averaged over patches; W/m^2")
      ->check(CLI::IsMember(namesIn(kLightmapShowsNames)));
}

void addElementOptions(CLI::App& app, Request& r) {
  const ElementOptions defaults;
  app.add_option_function<std::string>(
         "--elements", [&r](const std::string& text) { r.elements = text == "on"; },
         "on: light is evaluated anew at the vertices of elements, finer than patches where light "
         "changes (default of pictures and lit meshes); a results file keeps those of a lit mesh, "
         "and others where on is given; off: what the patches have, smoothed")
      ->group("Elements")
      ->option_text("on|off")
      ->check(CLI::IsMember({"on", "off"}));
  add(app, "Elements", "--element-tolerance", r.element_tolerance, "SHARE",
      fmt::format(
          "Elements are cut where interpolation misses by more than this share of the light "
          "there, and have more rays where those of indirect light are spread by seven times that; "
          "1e-4 to 0.5 (default {})",
          defaults.tolerance));
}

void addFinalGatherOption(CLI::App& app, Request& r) {
  app.add_flag(
         "--final-gather", r.final_gather,
         fmt::format("Evaluate light at every pixel, not at the vertices of elements: {} rays "
                     "a pixel, many times slower, without interpolation",
                     PixelGatherOptions().rays))
      ->group("Picture");
}

void addVisibleOnlyOption(CLI::App& app, Request& r) {
  app.add_flag("--visible-only", r.visible_only,
               "A lit mesh has elements where the camera sees it; elsewhere what the patches have")
      ->group("Elements");
}

void addShowOptions(CLI::App& app, Request& r) {
  addCreaseOption(app, r);
  add(app, "Picture", "--show", r.show, "QUANTITY",
      fmt::format(
          "False colour with a legend: radiosity or irradiance (W/m^2, Rec. 709 luminance weights "
          "{} R + {} G + {} B), form-factor:PATCH (F from patch number PATCH, from 0, to each "
          "patch), row-sum (how much of each patch's view ends on fronts)",
          kLuminanceOfRed, kLuminanceOfGreen, kLuminanceOfBlue));
}

}  // namespace radiosity::cli
