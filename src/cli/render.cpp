#include "radiosity/render.h"

#include <fmt/format.h>

#include <optional>

#include "base/figure_text.h"
#include "cli/commands.h"
#include "cli/element_use.h"
#include "cli/foreign_scene.h"
#include "cli/light_mix.h"
#include "cli/lightmap.h"
#include "cli/picture.h"
#include "cli/show.h"
#include "cli/stored_conditions.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/pipeline.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

/// The light that the picture shows: of elements or at points, unless patches were asked for.
/// `mix`: none, the solution.
SurfaceLight litSurfaces(Session& session, Pipeline& pipeline, const Picture& picture,
                         const ElementUse& elements, const std::optional<MixedLight>& mix) {
  std::vector<std::uint8_t> wanted;  // all
  if (elements.shown && !elements.all) {
    wanted =
        visiblePatches(pipeline.mesh().mesh, picture.camera, picture.options, session.progress);
  }
  if (mix) return mixedSurfaces(session, pipeline, *mix, elements.shown, wanted);
  if (!elements.shown) return pipeline.solvedLight();
  SurfaceLight light =
      session.request.final_gather ? pipeline.pointLight(wanted) : pipeline.elementLight(wanted);
  if (light.elements) {
    summarizeElements(session.report, *light.elements, pipeline.factors());
  }
  light.materials = pipeline.pointMaterials(wanted);
  return light;
}

/// Whether form factors are only needed for elements, and are not kept.
bool onlySources(const Pipeline& pipeline, const ElementUse& elements, const OutputSet& files) {
  return elements.shown && !pipeline.fromResultsFile() && !files.has(Format::results) &&
         !files.has(Format::matrix_market);
}

/// Announces a long final gather before it starts.
void announceGather(Session& session, const PatchMesh& mesh, const SurfaceLight& light,
                    const Picture& picture) {
  constexpr double kWorthSaying = 60;  // seconds
  const PixelGatherReport foreseen =
      foreseeGather(mesh, light, picture.camera, picture.options, {}, session.progress);
  if (foreseen.seconds < kWorthSaying) return;
  const Note note{
      Severity::info,
      fmt::format("--final-gather: light at {} points by {:.2g} rays: about {}; "
                  "elements, without it, take a fraction of that",
                  countText(foreseen.points), foreseen.rays, durationText(foreseen.seconds))};
  session.report.notes({&note, 1});
}

/// `parts`: is filled unless it is null.
Image radianceOfPicture(Session& session, Pipeline& pipeline, const SurfaceLight& light,
                        const Picture& picture, PictureParts* parts) {
  const PatchMesh& mesh = pipeline.mesh().mesh;
  if (!light.points) {
    return renderRadiance(mesh, light, picture.camera, picture.options, session.progress, parts);
  }
  announceGather(session, mesh, light, picture);
  PixelGather gathered =
      gatherRadiance(mesh, light, picture.camera, picture.options, {}, session.progress, parts);
  summarizeFinalGather(session.report, light.points->report(), gathered.report, pipeline.factors());
  return std::move(gathered.radiance);
}

/// Refuses options that contradict each other before the work is done.
void checkFinalGather(const Request& request, const Show& show, const OutputSet& files) {
  if (!request.final_gather) return;
  if (files.has(Format::glb)) {
    throw InputError(files.path(Format::glb) +
                     ": a lit mesh has no pixels; write it without --final-gather");
  }
  if (request.elements.value_or(false)) {
    throw InputError("--final-gather: it takes the place of elements; leave out --elements on");
  }
  const char* other = request.elements ? "--elements off"
                      : request.flat   ? "--flat"
                      : show.quantity  ? "--show"
                                       : nullptr;
  if (other == nullptr) return;
  throw InputError(
      fmt::format("--final-gather: {} shows what the patches have; leave one of them out", other));
}

/// Refuses impossible outputs before the work is done.
void checkOutputs(const OutputSet& files, const Show& show) {
  const bool lit = files.has(Format::glb);
  if (!lit && !hasPicture(files) && !hasForeignScene(files)) {
    throw InputError(
        "render: name the picture with -o, e.g. -o picture.png (or .exr, .hdr, .glb, .xml, .pbrt)");
  }
  if (files.has(Format::hdr) && (show.quantity || show.light)) {
    throw InputError(files.path(Format::hdr) +
                     ": holds the picture's radiance; use .png or .exr with --show");
  }
  if (lit && (show.quantity || show.light)) {
    throw InputError(files.path(Format::glb) +
                     ": a lit mesh holds the radiosity only; use .png or .exr with --show");
  }
}

/// Refuses options of pictures in false colours, and of layers, that have nothing to do.
void checkShown(const Request& request, const Show& show, const ElementUse& elements,
                const OutputSet& files) {
  parseRange(request.range);
  const bool shows = show.quantity || show.light;
  if (!request.range.empty() && !(shows && files.has(Format::png))) {
    throw InputError(
        "--range: is of false colours; add --show QUANTITY and a .png, or leave it out");
  }
  if (!request.layers) return;
  if (!files.has(Format::exr)) {
    throw InputError("--layers: are channels of an .exr; name one with -o FILE.exr");
  }
  if (shows) throw InputError("--layers: are of the lit picture; leave out --show");
  if (!elements.shown) {
    throw InputError(fmt::format(
        "--layers: patches do not tell direct from indirect light, elements do; leave out {}",
        request.flat ? "--flat" : "--elements off"));
  }
}

/// Draws the light as it leaves surfaces or falls on them, and writes it.
void drawPicture(Session& session, Pipeline& pipeline, const SurfaceLight& light,
                 const Picture& picture, const Show& show, OutputSet& files) {
  const PatchMesh& mesh = pipeline.mesh().mesh;
  PictureParts parts;
  PictureParts* wanted = session.request.layers ? &parts : nullptr;
  const Image radiance = radianceOfPicture(session, pipeline, light, picture, wanted);
  if (show.light) {
    drawLight(session, mesh, radiance, pipeline.bands(), picture, *show.light, files);
    return;
  }
  std::vector<ImageLayer> layers;
  if (wanted != nullptr) {
    layers = pictureLayers(mesh, picture.camera, picture.options, std::move(parts));
  }
  const double ev = writeLight(session, mesh, light, radiance, picture, files, layers);
  if (!session.request.lightmap.empty()) {
    writeLightmap(session, pipeline.scene(), mesh, light, ev, files);
  }
}

}  // namespace

int runRender(Session& session) {
  const Request& request = session.request;
  OutputSet files = claimOutputs(session);
  const Show show = parseShow(request.show);
  checkOutputs(files, show);
  checkFinalGather(request, show, files);
  const ElementUse elements = elementUse(request, files);
  checkShown(request, show, elements, files);
  checkLightmap(request, elements, files);
  checkMix(request, files);
  checkForeignScene(request, files);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  pipeline.options().factors.sources_only |= onlySources(pipeline, elements, files);
  chooseSources(request, pipeline);
  Picture picture = choosePicture(request, pipeline.scene());
  const bool draws = hasPicture(files) || files.has(Format::glb);
  if (onlyForeignScenes(files) && !picture.camera_from.empty()) {
    return writeForeignScenesAlone(session, pipeline.scene(), picture, files);
  }
  if (!show.quantity) requireColours(pipeline, request, files);
  if (show.needsLight() && request.mix.empty()) requireLight(session, pipeline);
  if (show.needsHeat()) requireHeat(session, pipeline);
  const PatchMesh& mesh = pipeline.mesh().mesh;
  requirePatch(show, mesh);
  if (!files.has(Format::results) && pipeline.onlyAdds()) {
    files.add({request.input, Format::results});
  }
  const FormFactors& factors = pipeline.factors();
  keepFactors(session, pipeline, files);
  int code = 0;
  if (show.needsHeat()) {
    const HeatSummary& heat = pipeline.heat().summary;
    code = exitCode(session, heat.usable(), heat.message);
  }
  std::vector<double> reflected;
  const std::optional<MixedLight> mix = mixOf(session, pipeline);
  if (mix) {
    reflected = reflectedLight(mix->solution.radiosity, mix->materials);
  } else if (show.needsLight()) {
    code = judgeSolution(session, pipeline);
    if (pipeline.solution().summary.status == SolveStatus::singular) {
      throw RunError("no picture: the system is singular");
    }
    keepSolution(session, pipeline, files);
    reflected = reflectedLight(pipeline.solution().radiosity, pipeline.materials());
  }
  framePicture(picture, mesh, factors.report.closed, reflected);
  writeForeignScenes(session, pipeline.scene(), picture, files);
  SurfaceLight light;
  if (draws && !show.quantity) light = litSurfaces(session, pipeline, picture, elements, mix);
  if (show.light && show.light->falling) {
    const Solution& solution = mix ? mix->solution : pipeline.solution();
    light = fallingLight(std::move(light), solution.irradiance, solution.bands);
  }
  reportPicture(session.report, picture);
  if (show.quantity) {
    drawQuantity(session, pipeline, picture, *show.quantity, show.patch, files);
  } else if (draws) {
    drawPicture(session, pipeline, light, picture, show, files);
  }
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  return code;
}

}  // namespace radiosity::cli
