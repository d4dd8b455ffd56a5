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
  const std::size_t limit = request.apply(FormFactorOptions()).memory_limit;
  if (limit == 0 || options.bytes() <= limit) return;
  throw InputError(
      fmt::format("--lightmap-size {}: the map takes {}, --memory-limit allows {}; "
                  "make it smaller or allow more",
                  options.size, bytesText(options.bytes()), bytesText(limit)));
}

/// Whether faces were turned over or left out.
bool hasOtherFaces(const Request& request) {
  return !request.scene.flip.empty() || !request.scene.without.empty();
}

bool isGltf(const std::string& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".gltf" || extension == ".glb";
}

/// The glTF file whose mesh is kept; empty if there is none. For a results file it is the file that
/// the scene was read from, where it still is: as it was named then, or beside the results.
std::string meshSource(const Request& request, const Scene& scene) {
  namespace fs = std::filesystem;
  const std::string& input = request.input;
  if (hasOtherFaces(request)) return {};
  if (!isResultsFile(input)) return isGltf(input) ? input : std::string();
  if (!isGltf(scene.file)) return {};
  const fs::path beside = fs::path(input).parent_path() / fs::path(scene.file).filename();
  for (const fs::path& place : {fs::path(scene.file), beside}) {
    std::error_code ignored;
    if (fs::is_regular_file(place, ignored)) return place.string();
  }
  return {};
}

/// Notes what the scene's file has and a mesh of flat faces lacks. `why`: the file cannot be used;
/// or empty.
void noteLoss(Session& session, const Scene& scene, const std::string& mesh,
              const std::string& why) {
  const std::string& input = session.request.input;
  std::vector<Note> notes;
  if (hasOtherFaces(session.request)) {
    notes.push_back({Severity::warning,
                     fmt::format("{}: flat faces with base colours: with --flip or --without the "
                                 "file's own mesh is not kept",
                                 mesh)});
  } else if (isResultsFile(input) && isGltf(scene.file)) {
    notes.push_back({Severity::warning,
                     fmt::format("{}: flat faces with base colours, without the textures, normals "
                                 "and cameras of {}, which {}; put it beside {}",
                                 mesh, scene.file, why.empty() ? "is not there" : why, input)});
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
    const char* alone = request.given.has("lightmap-size")    ? "--lightmap-size"
                        : request.given.has("lightmap-shows") ? "--lightmap-shows"
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
  requireMemory(request, request.apply(LightmapOptions()));
}

void writeLightmap(Session& session, const Scene& scene, const PatchMesh& mesh,
                   const SurfaceLight& light, double ev, OutputSet& files) {
  const Request& request = session.request;
  const Lightmap map =
      makeLightmap(scene, mesh, light, request.apply(LightmapOptions()), session.progress);
  const std::string shows = nameOf(kLightmapShowsNames, map.shows);
  files.write(Format::lightmap, "lightmap, " + shows + ", W/m^2, linear",
              [&](const std::string& temporary) {
                writeImage(temporary, map.image, false,
                           {{{"Software", "radiosity " RADIOSITY_VERSION},
                             {"quantity", shows},
                             {"unit", "W/m^2"},
                             {"exposure_ev", fmt::format("{}", ev)}}});
              });
  LightmapFile file{std::filesystem::path(request.lightmap).filename().string(), ev,
                    meshSource(request, scene)};
  int set = 0;
  std::string why;
  files.write(Format::glb, "mesh with the lightmap's coordinates",
              [&](const std::string& temporary) {
                try {
                  set = writeLightmapGlb(temporary, scene, map, file);
                } catch (const InputError& error) {
                  if (file.source.empty() || !isResultsFile(request.input)) throw;
                  why = fmt::format("cannot be used ({})", error.what());
                  file.source.clear();
                  set = writeLightmapGlb(temporary, scene, map, file);
                }
              });
  if (file.source.empty()) noteLoss(session, scene, files.path(Format::glb), why);
  summarize(session.report, map, set);
}

}  // namespace radiosity::cli
