#include "radiosity/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "cli/commands.h"
#include "cli/element_use.h"
#include "cli/picture.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/pipeline.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

/// The quantity that --show names; none: the lit scene itself.
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

/// Where the patch is whose form factors are drawn.
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

/// The light that the picture shows: of elements, unless patches were asked for.
SurfaceLight litSurfaces(Session& session, Pipeline& pipeline, const Picture& picture,
                         const ElementUse& elements) {
  if (!elements.shown) return pipeline.solvedLight();
  SurfaceLight light =
      elements.all ? pipeline.elementLight()
                   : pipeline.elementLight(visiblePatches(pipeline.mesh().mesh, picture.camera,
                                                          picture.options, session.progress));
  summarizeElements(session.report, *light.elements, pipeline.factors());
  return light;
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
  const ElementUse elements = elementUse(request, files);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  Picture picture = choosePicture(request, pipeline.scene());
  if (!show.quantity) requireColours(pipeline, request, files);
  if (show.needsLight()) requireLight(session, pipeline);
  const PatchMesh& mesh = pipeline.mesh().mesh;
  requirePatch(show, mesh);
  if (!files.has(Format::results) && pipeline.onlyAdds()) {
    files.add({request.input, Format::results});
  }
  const FormFactors& factors = pipeline.factors();
  keepFactors(session, pipeline, files);
  int code = 0;
  std::vector<double> reflected;
  if (show.needsLight()) {
    code = judgeSolution(session, pipeline);
    if (pipeline.solution().summary.status == SolveStatus::singular) {
      throw RunError("no picture: the system is singular");
    }
    keepSolution(session, pipeline, files);
    reflected = reflectedLight(pipeline.solution().radiosity, pipeline.materials());
  }
  framePicture(picture, mesh, factors.report.closed, reflected);
  SurfaceLight light;
  if (!show.quantity) light = litSurfaces(session, pipeline, picture, elements);
  reportPicture(session.report, picture);
  if (show.quantity) {
    drawQuantity(session, pipeline, picture, show, *show.quantity, files);
  } else {
    drawLight(session, mesh, light, picture, files);
  }
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  return code;
}

}  // namespace radiosity::cli
