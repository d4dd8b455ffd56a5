#include "radiosity/render.h"

#include <fmt/format.h>

#include <charconv>

#include "base/luminance.h"
#include "cli/commands.h"
#include "cli/picture.h"
#include "cli/words.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

/// What --show names; `none`: the lit scene itself.
struct Show {
  enum Quantity { none, radiosity, irradiance, form_factor, row_sum } quantity = none;
  std::size_t patch = 0;

  bool needsLight() const {
    return quantity == none || quantity == radiosity || quantity == irradiance;
  }
};

Show parseShow(const std::string& text) {
  if (text.empty()) return {Show::none, 0};
  if (text == "radiosity") return {Show::radiosity, 0};
  if (text == "irradiance") return {Show::irradiance, 0};
  if (text == "row-sum") return {Show::row_sum, 0};
  const std::string prefix = "form-factor:";
  if (text.starts_with(prefix)) {
    std::size_t patch = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + prefix.size(), last, patch);
    if (error == std::errc() && end == last) return {Show::form_factor, patch};
    throw InputError(
        fmt::format("--show: '{}' needs a patch number from 0, e.g. form-factor:12", text));
  }
  const std::string known[] = {"radiosity", "irradiance", "form-factor:PATCH", "row-sum"};
  throw InputError(
      fmt::format("--show: '{}' is not one of radiosity, irradiance, form-factor:PATCH, row-sum{}",
                  text, suggestion(text, known)));
}

void requirePatch(const Show& show, const PatchMesh& mesh) {
  if (show.quantity != Show::form_factor || show.patch < mesh.size()) return;
  throw InputError(fmt::format("--show: there is no patch {}; the mesh has patches 0 to {}",
                               show.patch, mesh.size() - 1));
}

/// One number a patch for a field of any bands.
std::vector<double> brightness(std::span<const double> values, int bands) {
  const auto width = std::size_t(bands);
  std::vector<double> out(values.size() / width);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = brightnessOf(values.subspan(width * i, width));
  }
  return out;
}

std::vector<double> rowOf(Pipeline& pipeline, std::size_t patch) {
  pipeline.loadMatrix();
  std::vector<double> row(pipeline.patches().size(), 0.0);
  pipeline.formFactors().matrix.forRow(patch, [&](Index j, double f) { row[j] = f; });
  return row;
}

std::vector<double> quantityOf(const Show& show, Pipeline& pipeline, FalseColour& legend) {
  switch (show.quantity) {
    case Show::radiosity:
      legend = {"radiosity B" + brightnessText(pipeline.bands()), "W/m^2"};
      return brightness(pipeline.solved().radiosity, pipeline.bands());
    case Show::irradiance:
      legend = {"irradiance H" + brightnessText(pipeline.bands()), "W/m^2"};
      return brightness(pipeline.solved().irradiance, pipeline.bands());
    case Show::form_factor:
      legend = {fmt::format("form factor from patch {}", show.patch), ""};
      return rowOf(pipeline, show.patch);
    case Show::row_sum:
    case Show::none:
      break;
  }
  legend = {"row sum: fronts seen", ""};
  return pipeline.formFactors().fronts;
}

/// Where the patch is whose form factors are drawn.
void describePatch(Report& report, const PatchMesh& mesh, const Show& show) {
  const Vec3 c = mesh.centroid[show.patch];
  const double centroid[] = {c.x, c.y, c.z};
  report.text("patch_surface", "patch lies on", mesh.surface_names[mesh.surface[show.patch]]);
  report.bands("patch_centroid_m", "patch centroid", centroid, "m");
}

void drawQuantity(Session& session, Pipeline& pipeline, const Picture& picture, const Show& show,
                  OutputSet& files) {
  FalseColour legend;
  const std::vector<double> values = quantityOf(show, pipeline, legend);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  session.report.text("quantity", "shown",
                      legend.unit.empty() ? legend.title : legend.title + ", " + legend.unit);
  if (show.quantity == Show::form_factor) describePatch(session.report, pipeline.patches(), show);
  session.report.number("lowest", "lowest of all patches", *low, legend.unit);
  session.report.number("highest", "highest of all patches", *high, legend.unit);
  files.write(Format::png, legend.title, [&](const std::string& temporary) {
    writeImage(temporary,
               renderFalseColour(pipeline.patches(), values, legend, picture.camera,
                                 picture.options, session.progress),
               true, metadataOf(picture, legend.title, legend.unit));
  });
  files.write(Format::exr, legend.title + " in each channel", [&](const std::string& temporary) {
    std::vector<double> grey;
    grey.reserve(3 * values.size());
    for (const double value : values) grey.insert(grey.end(), 3, value);
    writeImage(temporary,
               render(pipeline.patches(), grey, picture.camera, picture.options, session.progress),
               false, metadataOf(picture, legend.title, legend.unit));
  });
}

/// What can be refused before the work is done.
void checkOutputs(const OutputSet& files, const Show& show) {
  const bool lit = files.has(Format::glb);
  if (!lit && !files.has(Format::png) && !files.has(Format::exr)) {
    throw InputError("render: name the picture with -o, e.g. -o picture.png (or .exr, .glb)");
  }
  if (lit && show.quantity != Show::none) {
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
  Pipeline pipeline(request, session.report, session.progress);
  pipeline.open(files.path(Format::results));
  Picture picture = choosePicture(request, pipeline.scene());
  if (show.quantity == Show::none) requireColours(pipeline, request, files);
  if (show.needsLight()) pipeline.requireLight();
  pipeline.mesh();
  requirePatch(show, pipeline.patches());
  if (!files.has(Format::results) && pipeline.onlyAdds()) {
    files.add({request.input, Format::results});
  }
  pipeline.factors();
  keepFactors(session, pipeline, files);
  int code = 0;
  std::vector<double> reflected;
  if (show.needsLight()) {
    pipeline.solution();
    code = judgeSolution(session, pipeline);
    if (!pipeline.results().solution) throw RunError("no picture: the system is singular");
    keepSolution(session, pipeline, files);
    reflected = reflectedLight(pipeline, pipeline.solved().radiosity);
  }
  framePicture(picture, pipeline.patches(), pipeline.formFactors().report.closed, reflected);
  reportPicture(session.report, picture);
  if (show.quantity == Show::none) {
    drawLight(session, pipeline.patches(), solvedLight(pipeline), picture, files);
  } else {
    drawQuantity(session, pipeline, picture, show, files);
  }
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  return code;
}

}  // namespace radiosity::cli
