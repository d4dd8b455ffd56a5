#include "cli/lightmap.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/figure_text.h"
#include "base/file_name.h"
#include "cli/words.h"
#include "radiosity/lightmap.h"
#include "radiosity/names.h"
#include "radiosity/results.h"
#include "radiosity/version.h"

namespace radiosity::cli {

namespace {

void requireMemory(const Request& request, const LightmapOptions& options) {
  if (request.memory_limit.empty()) return;
  const std::size_t limit = parseBytes("--memory-limit", request.memory_limit);
  if (options.bytes() <= limit) return;
  throw InputError(
      fmt::format("--lightmap-size {}: the map takes {}, --memory-limit allows {}; "
                  "make it smaller or allow more",
                  options.size, bytesText(options.bytes()), bytesText(limit)));
}

/// The file whose mesh is kept; empty if there is none.
std::string meshSource(const std::string& input) {
  const std::string extension = lowerExtension(input);
  return extension == ".gltf" || extension == ".glb" ? input : std::string();
}

/// Notes properties of the scene's file that the mesh lacks.
void noteLoss(Session& session, const Scene& scene, const std::string& mesh) {
  std::vector<Note> notes;
  const std::string& input = session.request.input;
  if (isResultsFile(input)) {
    notes.push_back(
        {Severity::info, fmt::format("{}: flat faces with base colours, as {} has them; for a glTF "
                                     "file's own mesh give that file, with -o {}",
                                     mesh, input, input)});
  } else if (!scene.textures.empty()) {
    notes.push_back({Severity::warning,
                     fmt::format("{}: has base colours and no textures; those of a glTF file are "
                                 "kept, export the scene as one",
                                 mesh)});
  }
  session.report.notes(notes);
}

void summarize(Report& report, const Lightmap& map, int set) {
  const LightmapReport& r = map.report;
  const double texels = double(map.image.width) * double(map.image.height);
  report.section("lightmap", "Lightmap");
  report.text("size", "size", fmt::format("{} x {} texels", map.image.width, map.image.height));
  report.text("shows", "shows", nameOf(kLightmapShowsNames, map.shows) + ", W/m^2");
  report.text("texcoords", "texture coordinates", fmt::format("TEXCOORD_{}", set));
  report.count("charts", "charts", r.charts);
  report.count("triangles", "triangles", r.triangles);
  report.number("texels_per_metre", "texels a metre", r.texels_per_metre);
  report.number("least_density", "  at least, where faces curve, times", r.least_density);
  report.number("inside", "texels in charts, share", double(r.inside) / texels);
  report.number("padding", "texels of padding, share", double(r.padding) / texels);
  report.number("unused", "texels not used, share", double(r.unused) / texels);
  report.count("dark_texels", "texels without a patch", r.dark);
  report.number("seconds", "time", r.seconds, "s");
}

}  // namespace

void checkLightmap(const Request& request, const ElementUse& elements, const OutputSet& files) {
  if (request.lightmap.empty()) {
    const char* alone = request.lightmap_size    ? "--lightmap-size"
                        : request.lightmap_shows ? "--lightmap-shows"
                                                 : nullptr;
    if (alone == nullptr) return;
    throw InputError(fmt::format("{}: there is no lightmap; add --lightmap FILE.exr", alone));
  }
  if (!files.has(Format::glb)) {
    throw InputError(
        fmt::format("--lightmap {}: the mesh that it is laid over is missing; add -o "
                    "FILE.glb",
                    request.lightmap));
  }
  if (!elements.shown) {
    throw InputError(fmt::format("--lightmap {}: shows light at elements; leave out {}",
                                 request.lightmap, request.flat ? "--flat" : "--elements off"));
  }
  requireMemory(request, request.lightmapOptions());
}

void writeLightmap(Session& session, const Scene& scene, const PatchMesh& mesh,
                   const SurfaceLight& light, double ev, OutputSet& files) {
  const Request& request = session.request;
  const Lightmap map =
      makeLightmap(scene, mesh, light, request.lightmapOptions(), session.progress);
  const std::string shows = nameOf(kLightmapShowsNames, map.shows);
  files.write(Format::lightmap, "lightmap, " + shows + ", W/m^2, linear",
              [&](const std::string& temporary) {
                writeImage(temporary, map.image, false,
                           {{{"Software", "radiosity " RADIOSITY_VERSION},
                             {"quantity", shows},
                             {"unit", "W/m^2"},
                             {"exposure_ev", fmt::format("{}", ev)}}});
              });
  const LightmapFile file{std::filesystem::path(request.lightmap).filename().string(), ev,
                          meshSource(request.input)};
  int set = 0;
  files.write(
      Format::glb, "mesh with the lightmap's coordinates",
      [&](const std::string& temporary) { set = writeLightmapGlb(temporary, scene, map, file); });
  if (file.source.empty()) noteLoss(session, scene, files.path(Format::glb));
  summarize(session.report, map, set);
}

}  // namespace radiosity::cli
