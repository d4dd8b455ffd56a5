#include "radiosity/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/figure_text.h"
#include "cli/commands.h"
#include "cli/element_use.h"
#include "cli/light_mix.h"
#include "cli/lightmap.h"
#include "cli/picture.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/pipeline.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

/// The quantity of --show; empty: the lit scene itself.
struct Show {
  std::optional<Quantity> quantity;
  std::size_t patch = 0;

  bool needsLight() const {
    return !quantity || *quantity == Quantity::radiosity || *quantity == Quantity::irradiance;
  }
};

Show parseShow(const std::string& text) {
  if (text.empty()) return {};
  if (text == "radiosity") return {Quantity::radiosity};
  if (text == "irradiance") return {Quantity::irradiance};
  if (text == "row-sum") return {Quantity::row_sum};
  const std::string prefix = "form-factor:";
  if (text.starts_with(prefix)) {
    std::size_t patch = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + prefix.size(), last, patch);
    if (error == std::errc() && end == last) return {Quantity::form_factor, patch};
    throw InputError(
        fmt::format("--show: '{}' needs a patch number from 0, e.g. form-factor:12", text));
  }
  const std::string known[] = {"radiosity", "irradiance", "form-factor:PATCH", "row-sum"};
  throw InputError(
      fmt::format("--show: '{}' is not one of radiosity, irradiance, form-factor:PATCH, row-sum{}",
                  text, suggestion(text, known)));
}

void requirePatch(const Show& show, const PatchMesh& mesh) {
  if (show.quantity != Quantity::form_factor || show.patch < mesh.size()) return;
  throw InputError(fmt::format("--show: there is no patch {}; the mesh has patches 0 to {}",
                               show.patch, mesh.size() - 1));
}

/// Reports the place of the patch whose form factors are drawn.
void describePatch(Report& report, const PatchMesh& mesh, const Show& show) {
  const Vec3 c = mesh.centroid[show.patch];
  const double centroid[] = {c.x, c.y, c.z};
  report.text("patch_surface", "patch lies on", mesh.surface_names[mesh.surface[show.patch]]);
  report.bands("patch_centroid_m", "patch centroid", centroid, "m");
}

void drawQuantity(Session& session, Pipeline& pipeline, const Picture& picture, const Show& show,
                  Quantity quantity, OutputSet& files) {
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const ScalarField field = pipeline.field(quantity, show.patch);
  const FalseColour& legend = field.legend;
  const auto [low, high] = std::minmax_element(field.values.begin(), field.values.end());
  session.report.text("quantity", "shown",
                      legend.unit.empty() ? legend.title : legend.title + ", " + legend.unit);
  if (quantity == Quantity::form_factor) describePatch(session.report, mesh, show);
  session.report.number("lowest", "lowest of all patches", *low, legend.unit);
  session.report.number("highest", "highest of all patches", *high, legend.unit);
  files.write(Format::png, legend.title, [&](const std::string& temporary) {
    writeImage(temporary,
               renderFalseColour(mesh, field.values, legend, picture.camera, picture.options,
                                 session.progress),
               true, metadataOf(picture, legend.title, legend.unit));
  });
  files.write(Format::exr, legend.title + " in each channel", [&](const std::string& temporary) {
    std::vector<double> grey;
    grey.reserve(3 * field.values.size());
    for (const double value : field.values) grey.insert(grey.end(), 3, value);
    writeImage(temporary, render(mesh, grey, picture.camera, picture.options, session.progress),
               false, metadataOf(picture, legend.title, legend.unit));
  });
}

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

Image radianceOfPicture(Session& session, Pipeline& pipeline, const SurfaceLight& light,
                        const Picture& picture) {
  const PatchMesh& mesh = pipeline.mesh().mesh;
  if (!light.points) {
    return renderRadiance(mesh, light, picture.camera, picture.options, session.progress);
  }
  announceGather(session, mesh, light, picture);
  PixelGather gathered =
      gatherRadiance(mesh, light, picture.camera, picture.options, {}, session.progress);
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
  if (!lit && !files.has(Format::png) && !files.has(Format::exr)) {
    throw InputError("render: name the picture with -o, e.g. -o picture.png (or .exr, .glb)");
  }
  if (lit && show.quantity) {
    throw InputError(files.path(Format::glb) +
                     ": a lit mesh holds the radiosity only; use .png or .exr with --show");
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
  checkLightmap(request, elements, files);
  checkMix(request, files);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  pipeline.options().factors.sources_only |= onlySources(pipeline, elements, files);
  chooseSources(request, pipeline);
  Picture picture = choosePicture(request, pipeline.scene());
  if (!show.quantity) requireColours(pipeline, request, files);
  if (show.needsLight() && request.mix.empty()) requireLight(session, pipeline);
  const PatchMesh& mesh = pipeline.mesh().mesh;
  requirePatch(show, mesh);
  if (!files.has(Format::results) && pipeline.onlyAdds()) {
    files.add({request.input, Format::results});
  }
  const FormFactors& factors = pipeline.factors();
  keepFactors(session, pipeline, files);
  int code = 0;
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
  SurfaceLight light;
  if (!show.quantity) light = litSurfaces(session, pipeline, picture, elements, mix);
  reportPicture(session.report, picture);
  if (show.quantity) {
    drawQuantity(session, pipeline, picture, show, *show.quantity, files);
  } else {
    const Image radiance = radianceOfPicture(session, pipeline, light, picture);
    const double ev = writeLight(session, mesh, light, radiance, picture, files);
    if (!request.lightmap.empty()) {
      writeLightmap(session, pipeline.scene(), mesh, light, ev, files);
    }
  }
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  return code;
}

}  // namespace radiosity::cli
