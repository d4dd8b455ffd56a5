// Options of cameras, pictures, elements and lightmaps.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "base/luminance.h"
#include "cli/options.h"
#include "radiosity/light.h"

namespace radiosity::cli {

void addCameraOption(CLI::App& app, Request& r) {
  add(app, "Picture", "--camera", r.camera, "CAMERA",
      "Name of a camera in the scene, or eye=X,Y,Z;target=X,Y,Z[;up=X,Y,Z][;fov=DEGREES], metres "
      "(default: the scene's first, else one in a room at eye height, or from outside where there "
      "is none, aimed at lit surfaces)");
}

void addCameraOptions(CLI::App& app, Request& r) {
  addCameraOption(app, r);
  addOptionsOf<RenderOptions>(app, r, "Picture");
}

void addExposureOption(CLI::App& app, Request& r, const char* shown_in) {
  add(app, "Picture", "--exposure", r.exposure, "auto|EV",
      fmt::format("{} radiance times 2^EV (default auto; the EV is printed)", shown_in));
}

void addRenderOptions(CLI::App& app, Request& r) {
  addExposureOption(app, r, "The .png and .glb show");
  app.add_flag("--flat", r.flat, "One colour a patch, not interpolated")->group("Picture");
}

void addLightmapOptions(CLI::App& app, Request& r) {
  add(app, "Lightmap", "--lightmap", r.lightmap, "FILE.exr",
      "Write light as an image, and the scene's own mesh, with coordinates for it, as the .glb of "
      "-o "
      "(of a glTF file with its nodes, names, materials, textures and normals)");
  addOptionsOf<LightmapOptions>(app, r, "Lightmap");
}

void addElementOptions(CLI::App& app, Request& r) {
  app.add_option_function<std::string>(
         "--elements", [&r](const std::string& text) { r.elements = text == "on"; },
         "on: light is evaluated anew at the vertices of elements, finer than patches where light "
         "changes (default of pictures and lit meshes); a results file keeps those of a lit mesh, "
         "and others where on is given; off: what the patches have, smoothed")
      ->group("Elements")
      ->option_text("on|off")
      ->check(CLI::IsMember({"on", "off"}));
  addOptionsOf<ElementOptions>(app, r, "Elements");
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

void addRangeOption(CLI::App& app, Request& r, const char* group) {
  add(app, group, "--range", r.range, "LOW,HIGH",
      "Ends of the false colours, in the unit shown (default: of the values in view)");
}

void addShowOptions(CLI::App& app, Request& r) {
  add(app, "Picture", "--show", r.show, "QUANTITY",
      fmt::format(
          "False colours with a legend. Of the picture's light, with lines at round numbers: "
          "luminance (cd/m^2), illuminance (lx, on surfaces as they face) or radiance (W/m^2/sr). "
          "Of patches, as solved: radiosity or irradiance (W/m^2), form-factor:PATCH (F from patch "
          "number PATCH, from 0, to each patch), row-sum (how much of each patch's view ends on "
          "fronts); of a results file with heat: temperature (K), net-flux (given off, W/m^2) or "
          "heat-irradiance (W/m^2). Colours count by luminance, {} R + {} G + {} B (Rec. 709), "
          "{:g} lm/W",
          kLuminanceOfRed, kLuminanceOfGreen, kLuminanceOfBlue, kLumensPerWatt));
  addRangeOption(app, r, "Picture");
  app.add_flag("--layers", r.layers,
               "The .exr has more channels: depth, normal, patch, surface, albedo, direct and "
               "indirect light, with --final-gather also its error")
      ->group("Picture");
}

}  // namespace radiosity::cli
