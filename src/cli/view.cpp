#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/commands.h"
#include "cli/desktop.h"
#include "cli/element_use.h"
#include "cli/gallery.h"
#include "cli/picture.h"
#include "cli/stored_conditions.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/page.h"

namespace radiosity::cli {

namespace fs = std::filesystem;

namespace {

void requirePages() {
  if (canWritePages()) return;
  throw InputError(
      "view: this program was built without node and npm, which make pages; install both "
      "(tools/setup does), then configure and build again");
}

/// The default page, in the current folder. Nobody named it, so it may only replace another page.
std::string defaultPage(const std::string& input) {
  std::string name = fs::path(input).stem().string() + ".html";
  std::error_code ignored;
  if (fs::exists(name, ignored) && !isPage(name)) {
    throw InputError(
        fmt::format("{}: is there and is no page of this program; name the page with -o", name));
  }
  return name;
}

/// Refuses a method with two estimates for each pair, before any work is done.
void requireOneEstimate(const Request& request, const FormFactorOptions& options) {
  if (options.givesSymmetric() || !traitsOf(options.method).stores_pairs) return;
  const MethodTraits& method = traitsOf(options.method);
  throw InputError(fmt::format(
      "{}: a page keeps one form factor a pair, and the method {} gives two estimates of each; "
      "{}--method exact or rays",
      request.input, method.word, method.uses("symmetrize") ? "add --symmetrize, or " : "give "));
}

void summarizePage(Report& report, const Picture& picture, double ev, const PageReport& page) {
  const FactorQuantisation& q = page.quantisation;
  report.section("page", "Page");
  report.text("camera", "camera", picture.camera_from);
  report.number("exposure_ev", "exposure", ev, "EV");
  if (page.nodes > 0) report.count("nodes", "nodes that patches are summed to", page.nodes);
  report.count("form_factors", "form factors, one a pair", page.pairs);
  report.number("largest_relative_error", "their error by 16 bits, at most",
                q.largest_relative_error);
  report.number("largest_row_error", "  of a row, summed, at most", q.largest_row_error);
  report.count("left_out", "  pairs too small to be kept", q.left_out);
  report.count("element_triangles", "triangles of elements", page.element_triangles);
  if (page.textures > 0) {
    report.count("textures", "textures", page.textures);
    report.count("texels", "  texels of all", page.texels);
    report.count("halved_textures", "  that were halved to be so few", page.halved_textures);
  }
  report.bytes("data_bytes", "data, unpacked", page.bytes);
  report.bytes("packed_bytes", "data in the file", page.packed_bytes);
}

/// What chooses the scene and its light, as a shell reads it: the results file if one is written,
/// else the arguments without those of the run and of the picture, which a page changes.
std::string sceneArguments(const Request& request, const OutputSet& files) {
  if (files.has(Format::results)) return shellWord(files.path(Format::results));
  constexpr const char* kOwn[] = {"-o",        "--output",   "--report",  "--time-limit",
                                  "--threads", "--camera",   "--gallery", "--width",
                                  "--height",  "--exposure", "--elements"};
  std::string text;
  for (std::size_t k = 2; k < request.arguments.size(); ++k) {
    const std::string& word = request.arguments[k];
    if (std::ranges::find(kOwn, word) != std::end(kOwn)) {
      ++k;
      continue;
    }
    const auto holds = [&](const std::string& name) {
      return word.starts_with(name.starts_with("--") ? name + "=" : name);
    };
    if (word == "--quiet" || std::ranges::any_of(kOwn, holds)) continue;
    text += (text.empty() ? "" : " ") + shellWord(word);
  }
  return text;
}

/// The page's first picture, small: temperatures where there is heat, which need no light.
Image thumbnail(Session& session, Pipeline& pipeline, const SurfaceLight& light,
                const ExposedPicture& shown, bool heat) {
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const Camera& camera = shown.picture.camera;
  RenderOptions small = shown.picture.options;
  small.width = 480;
  small.height = 360;
  if (!heat) {
    return exposed(renderRadiance(mesh, light, camera, small, session.progress), shown.ev);
  }
  const ScalarField field = pipeline.field(Quantity::temperature);
  small.smooth = field.smooth;
  return renderFalseColour(mesh, field.values, field.legend, camera, small, session.progress);
}

void writePages(Session& session, Pipeline& pipeline, bool elements, bool heat, OutputSet& files) {
  SurfaceLight light = elements ? pipeline.elementLight() : pipeline.solvedLight();
  if (elements) light.materials = pipeline.pointMaterials();
  const ExposedPicture shown = exposePicture(session, pipeline, light);
  const PageOptions options{fs::path(session.request.input).stem().string(),
                            shown.picture.camera,
                            shown.ev,
                            shown.picture.options.crease,
                            sceneArguments(session.request, files),
                            heat};
  PageReport page;
  files.write(Format::page, "page, opens in a browser", [&](const std::string& temporary) {
    page = writePage(temporary, pipeline, light, options, session.progress);
  });
  if (!session.request.gallery.empty()) {
    files.write(Format::png, "thumbnail", [&](const std::string& temporary) {
      writeImage(temporary, thumbnail(session, pipeline, light, shown, heat), heat, {});
    });
  }
  summarizePage(session.report, shown.picture, shown.ev, page);
  for (const Light& sky : unevenSkies(pipeline.scene().lights)) {
    const Note note{
        Severity::info,
        fmt::format("{}: a page has what it lights, by form factors; it shows no sky of "
                    "its own behind the scene, nor to its hemicubes",
                    sky.name)};
    session.report.notes({&note, 1});
  }
}

}  // namespace

int runView(Session& session) {
  const Request& request = session.request;
  requirePages();
  OutputSet files = claimOutputs(session);
  const bool is_named = files.has(Format::page);
  if (!request.gallery.empty()) {
    const GalleryFiles in_gallery =
        galleryFiles(request.gallery, fs::path(request.input).stem().string());
    files.add({in_gallery.page, Format::page});
    files.add({in_gallery.thumbnail, Format::png});
  } else if (!is_named) {
    files.add({defaultPage(request.input), Format::page});
  }
  const ElementUse elements = elementUse(request, files);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  requireColours(pipeline, request, files);
  requireOneEstimate(request, pipeline.options().factors);
  const bool heat = hasHeat(session, pipeline);
  if (!heat) requireLight(session, pipeline);
  requirePageFits(request.input, pipeline.mesh().mesh);
  if (!files.has(Format::results) && pipeline.onlyAdds()) {
    files.add({request.input, Format::results});
  }
  pipeline.factors();
  if (heat) pipeline.heat();
  keepFactors(session, pipeline, files);
  const int code = judgeSolution(session, pipeline);
  if (pipeline.solution().summary.status == SolveStatus::singular) {
    throw RunError("no page: the system is singular");
  }
  keepSolution(session, pipeline, files);
  if (elements.all) summarizeElements(session.report, pipeline.elements(), pipeline.factors());
  writePages(session, pipeline, elements.shown, heat, files);
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  if (!request.gallery.empty()) {
    const std::size_t pages = writeGalleryIndex(request.gallery);
    session.report.line("gallery",
                        fmt::format("{} with {}", request.gallery, plural(pages, "page", "pages")));
  } else if (!is_named && openInDesktop(files.path(Format::page))) {
    session.report.line("page", "opens in the browser");
  }
  return code;
}

}  // namespace radiosity::cli
