#include "radiosity/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <variant>

#include "base/file_name.h"
#include "base/input_file.h"
#include "base/luminance.h"
#include "cli/commands.h"
#include "cli/matrix_commands.h"
#include "cli/picture.h"
#include "cli/words.h"
#include "radiosity/names.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

/// One side of the comparison.
struct Side {
  std::string label;  ///< "A" or "B"
  std::string path;
  std::string light;  ///< in words: the quantity compared
  LightUnit unit = LightUnit::radiosity;
  std::variant<LightField, ImageFile> content;
  bool isImage() const { return std::holds_alternative<ImageFile>(content); }
  const LightField& field() const { return std::get<LightField>(content); }
  const ImageFile& image() const { return std::get<ImageFile>(content); }
};

std::string optionOf(const Side& side) { return side.label == "A" ? "--a-is" : "--b-is"; }

/// The unit given, or else that of the file. Errors: InputError if there is neither.
LightUnit decideUnit(const Side& side, const std::string& said, std::optional<LightUnit> of_file,
                     const std::string& what) {
  const std::optional<LightUnit> word = named(kLightUnitNames, said);
  if (word && of_file == LightUnit::radiosity && *word != LightUnit::radiosity) {
    throw InputError(
        fmt::format("{}: {} says {}, but the file holds radiosity in W/m^2; leave {} "
                    "out",
                    side.path, optionOf(side), said, optionOf(side)));
  }
  if (word) return *word;
  if (of_file) return *of_file;
  throw InputError(fmt::format(
      "{}: nothing says what its {} mean; add {} radiosity (W/m^2), radiance (W/m^2/sr) or srgb8 "
      "(coded for a screen)",
      side.path, what, optionOf(side)));
}

/// The emission; empty if it is not known. Materials of another number of bands did not make this
/// light.
std::span<const double> emissionOf(const Results& results, int bands) {
  if (!results.materials || results.materials->bands != bands) return {};
  return results.materials->emission;
}

void readResultsSide(Side& side, const std::string& said) {
  const Results results = readResults(side.path, false);
  side.unit = decideUnit(side, said, LightUnit::radiosity, "values");
  if (results.mesh && results.solution && !results.solution->radiosity.empty()) {
    side.light = "matrix solution";
    side.content = lightOf(results.mesh->mesh, results.solution->radiosity, results.solution->bands,
                           side.path, emissionOf(results, results.solution->bands));
  } else if (results.mesh && results.gathered) {
    side.light = "gathered light";
    side.content =
        lightOf(results.mesh->mesh, patchRadiosity(results.mesh->mesh, *results.gathered),
                results.gathered->bands, side.path, emissionOf(results, results.gathered->bands));
  } else {
    throw InputError(side.path +
                     ": holds no light yet; run radiosity solve or radiosity gather on it, or "
                     "compare its --form-factors");
  }
}

bool isPictureName(const std::string& path) {
  const std::string extension = lowerExtension(path);
  const std::string meshes[] = {".glb", ".gltf", ".ply", ".obj"};
  return std::find(std::begin(meshes), std::end(meshes), extension) == std::end(meshes);
}

ImageFile readPicture(const std::string& path, double max_image) {
  try {
    return readImageFile(path, max_image);
  } catch (const InputError& error) {
    throw InputError(fmt::format(
        "{}; what can be compared: results (.h5), lit meshes (.glb, .gltf, .ply, .obj), pictures",
        error.what()));
  }
}

Side readSide(const std::string& label, const std::string& path, const std::string& said,
              double max_image) {
  requireFile(path);
  Side side;
  side.label = label;
  side.path = path;
  if (isResultsFile(path) || lowerExtension(path) == ".h5") {
    readResultsSide(side, said);
  } else if (isPictureName(path)) {
    ImageFile file = readPicture(path, max_image);
    std::optional<LightUnit> of_file;
    if (file.bytes) of_file = LightUnit::srgb8;
    if (!file.bytes && file.quantity == "radiance") of_file = LightUnit::radiance;
    side.unit = decideUnit(side, said, of_file, "pixels");
    side.light = fmt::format("picture, {}", nameOf(kLightUnitNames, side.unit));
    side.content = std::move(file);
  } else {
    const LitMesh mesh = readLitMesh(path);
    std::optional<LightUnit> of_file;
    if (mesh.radiosity) of_file = LightUnit::radiosity;
    side.unit = decideUnit(side, said, of_file, "vertex colours");
    side.light = fmt::format("vertex colours, {}", nameOf(kLightUnitNames, side.unit));
    side.content = lightOf(mesh, side.unit);
  }
  return side;
}

std::string percent(double part, double whole) {
  return fmt::format("{:.2f}%", whole > 0 ? 100 * part / whole : 0.0);
}

/// The key of a band's column: "l2_r_percent", "l2_band_1_percent".
std::string columnKey(std::string band) {
  for (char& c : band) c = c == ' ' ? '_' : char(std::tolower(static_cast<unsigned char>(c)));
  return fmt::format("l2_{}_percent", band);
}

/// A difference relative to A, times `scale`; in words where A is 0 and B is not.
std::string relativeText(double value, double scale = 1, int digits = 6) {
  return std::isfinite(value) ? numberText(scale * value, digits) : "A is 0";
}

void reportRelative(Report& report, const std::string& key, const std::string& label, double value,
                    const std::string& beside = {}) {
  if (std::isfinite(value)) {
    report.number(key, label, value, beside);
  } else {
    report.text(key, label, relativeText(value) + (beside.empty() ? "" : " " + beside));
  }
}

/// `unit`: of the means.
void reportSurfaces(Report& report, const Comparison& c, const std::string& unit) {
  const int bands = int(c.sums.a.size());
  std::vector<std::vector<std::string>> rows;
  for (const SurfaceDifference& s : c.surfaces) {
    if (!(s.given > 0)) continue;
    const BandSums& sums = s.sums;
    const auto mean = [&](const std::vector<double>& of) {
      const double total = std::accumulate(of.begin(), of.end(), 0.0);
      return sums.area > 0 ? numberText(total / (bands * sums.area), 4) : "none";
    };
    std::vector<std::string> row = {s.name.empty() ? "(unnamed)" : s.name, numberText(s.given, 4),
                                    percent(sums.area, s.given), mean(sums.a), mean(sums.b)};
    for (int b = -1; b < bands; ++b) {
      row.push_back(relativeText(sums.relativeL2(b), 100, 3));
    }
    rows.push_back(std::move(row));
  }
  std::vector<Report::Column> columns = {
      {"name", "surface", false},   {"area_m2", "area m^2"},      {"compared", "compared", false},
      {"mean_a", "mean A " + unit}, {"mean_b", "mean B " + unit}, {"l2_percent", "L2 %"}};
  for (const std::string& band : bandNames(bands)) {
    columns.push_back({columnKey(band), band + " %"});
  }
  report.table("surfaces", columns, rows);
}

/// Reports the difference without lamps and the largest difference in one line, since each can hide
/// the other.
void reportHeadline(Report& report, const Comparison& c) {
  std::string beside;
  if (c.without_emitters) {
    beside = fmt::format("without emitters {}", relativeText(c.without_emitters->relativeL2()));
  }
  const SurfaceDifference* worst = nullptr;
  for (const SurfaceDifference& s : c.surfaces) {
    // Where A is 0 no difference is relative to it: the largest one says how far B is off.
    if (!(s.sums.area > 0) || !std::isfinite(s.sums.relativeL2())) continue;
    if (worst == nullptr || s.sums.relativeL2() > worst->sums.relativeL2()) worst = &s;
  }
  if (worst != nullptr) {
    beside += fmt::format("{}worst surface {}: {}", beside.empty() ? "" : "; ",
                          worst->name.empty() ? "(unnamed)" : worst->name,
                          numberText(worst->sums.relativeL2()));
  }
  reportRelative(report, "relative_l2", "relative L2 difference", c.relativeL2(),
                 beside.empty() ? beside : "(" + beside + ")");
  report.mute(true);
  if (c.without_emitters) {
    reportRelative(report, "relative_l2_without_emitters", "", c.without_emitters->relativeL2());
  }
  if (worst != nullptr) {
    report.text("worst_surface", "", worst->name);
    report.number("worst_surface_l2", "", worst->sums.relativeL2());
  }
  report.mute(false);
}

void reportPerceived(Report& report, const PerceivedDifference& seen) {
  report.number("flip", seen.exposure_ev ? "FLIP, of light (HDR)" : "FLIP, on a screen (LDR)",
                seen.flip);
  if (!seen.ssim) return;
  report.number("ssim", "SSIM", *seen.ssim);
  if (seen.exposure_ev) report.number("ssim_ev", "  at an exposure of", *seen.exposure_ev, "EV");
}

void reportComparison(Report& report, const Comparison& c, bool pictures, bool relative) {
  const std::size_t count = c.sums.a.size();
  const std::string unit = relative ? "of full scale" : pictures ? "W/m^2/sr" : "W/m^2";
  const std::string area = pictures ? "pixels" : "m^2";
  reportHeadline(report, c);
  report.number("area_a", pictures ? "shown by A" : "area of A", c.area_a, area);
  report.number("area_b", pictures ? "shown by B" : "area of B", c.area_b, area);
  report.text("matched_a", "matched of A", percent(c.matched_a, c.area_a));
  report.text("matched_b", "matched of B", percent(c.matched_b, c.area_b));
  if (c.clipped > 0) report.number("clipped", "left out: clipped at the top", c.clipped, area);
  report.count("cells", pictures ? "pixels compared" : "cells compared", c.cells);
  if (!pictures) report.text("cells_of", "means over cells of", c.cells_of_b ? "B" : "A");
  report.number("scale", "B was multiplied by", c.scale);
  std::vector<double> by_band;
  for (std::size_t b = 0; b < count; ++b) by_band.push_back(c.relativeL2(int(b)));
  const std::string label = fmt::format("relative L2 by band ({})", bandsText(int(count)));
  if (std::ranges::all_of(by_band, [](double value) { return std::isfinite(value); })) {
    report.bands("relative_l2_bands", label, by_band, "");
  } else {
    std::string words;
    for (const double value : by_band) words += (words.empty() ? "" : ", ") + relativeText(value);
    report.text("relative_l2_bands", label, words);
  }
  report.number("fitted_scale", "best factor for B", c.fitted_scale);
  report.number("fitted_l2", "  would leave", c.fitted_l2);
  if (c.perceived) reportPerceived(report, *c.perceived);
  report.number("largest", "largest difference", std::abs(c.largest.b - c.largest.a), unit);
  const double place[] = {c.largest.place.x, c.largest.place.y, c.largest.place.z};
  report.bands("largest_at", "  at", std::span(place).first(pictures ? 2 : 3),
               pictures ? "pixel" : "m");
  if (!pictures) report.text("largest_on", "  on", c.largest.surface);
  report.text("largest_band", "  band", bandNames(int(count))[std::size_t(c.largest.band)]);
  report.number("largest_a", "  A there", c.largest.a, unit);
  report.number("largest_b", "  B there", c.largest.b, unit);
  const std::string total = pictures || relative ? "" : "W";
  report.bands("energy_a", pictures ? "sum of A" : "leaves A", c.sums.a, total);
  report.bands("energy_b", pictures ? "sum of B" : "leaves B", c.sums.b, total);
  std::vector<double> difference;
  for (std::size_t b = 0; b < count; ++b) difference.push_back(c.sums.b[b] - c.sums.a[b]);
  report.bands("energy_difference", "  B - A", difference, total);
  reportSurfaces(report, c, unit);
  report.notes(c.notes);
}

int judge(Session& session, const Comparison& c) {
  if (!session.request.compare_tolerance) return 0;
  const double tolerance = *session.request.compare_tolerance;
  const bool within = c.relativeL2() <= tolerance;
  session.report.text(
      "verdict", "verdict",
      fmt::format("{} the tolerance of {}", within ? "within" : "above", numberText(tolerance)));
  return within ? 0 : 1;
}

/// The legend of false colours, with a scale from 0.
FalseColour legendOf(int bands, bool pictures, bool relative) {
  return {"|B - A|" + brightnessText(bands), relative ? "" : pictures ? "W/m^2/sr" : "W/m^2"};
}

void drawField(Session& session, const LightField& side, const Comparison& c, Picture picture,
               OutputSet& files) {
  const PatchMesh mesh = cellMesh(side);
  picture.options.smooth = false;
  framePicture(picture, mesh, false);
  files.write(Format::png, "difference, false colour", [&](const std::string& temporary) {
    writeImage(temporary,
               renderFalseColour(mesh, differenceOnTriangles(side, c),
                                 legendOf(side.bands, false, side.relative), picture.camera,
                                 picture.options, session.progress),
               true);
  });
}

/// Refuses options that do not apply to pictures, which are compared pixel by pixel.
void requirePixelOptions(const Request& request) {
  const std::string of_surfaces =
      request.camera.empty()
          ? request.given.firstOf({"width", "height", "samples", "backs", "match", "partial"})
          : "--camera";
  if (of_surfaces.empty()) return;
  throw InputError(of_surfaces +
                   ": is about surfaces, and A and B are pictures, compared pixel by pixel; leave "
                   "it out");
}

void requirePicture(const OutputSet& files, const Request& request) {
  if (files.has(Format::results) && !request.with_gather) {
    throw InputError(files.path(Format::results) +
                     ": compare writes results with --gather only; name a .png for the difference");
  }
}

/// Compares two files.
int compareFiles(Session& session, OutputSet& files) {
  const Request& request = session.request;
  if (request.second.empty()) {
    throw InputError(
        "compare: B is missing: radiosity compare A B, or radiosity compare A --gather");
  }
  const CompareOptions options = request.apply(CompareOptions());
  const Side a = readSide("A", request.input, request.a_is, request.scene.max_image);
  const Side b = readSide("B", request.second, request.b_is, request.scene.max_image);
  if (a.isImage() != b.isImage()) {
    const Side& image = a.isImage() ? a : b;
    throw InputError(
        fmt::format("{}: is a picture, {} holds surfaces; render that first, from the "
                    "same camera: radiosity render {} -o picture.exr",
                    image.path, (a.isImage() ? b : a).path, (a.isImage() ? b : a).path));
  }
  session.report.line("A", fmt::format("{}: {}", a.path, a.light));
  session.report.line("B", fmt::format("{}: {}", b.path, b.light));
  const bool pictures = a.isImage();
  if (pictures) {
    requirePixelOptions(request);
  } else if (options.perceived) {
    throw InputError("--perceived: is of pictures, and A and B hold surfaces; leave it out");
  }
  const Comparison c = pictures ? compare(a.image(), a.unit, b.image(), b.unit, options)
                                : compare(a.field(), b.field(), options);
  const bool relative = a.unit == LightUnit::srgb8;
  session.report.section("comparison", "Comparison");
  reportComparison(session.report, c, pictures, relative);
  const int code = judge(session, c);
  if (pictures) {
    // The size of the smaller picture, in which both are compared.
    const auto [width, height] = std::min(std::pair(a.image().image.width, a.image().image.height),
                                          std::pair(b.image().image.width, b.image().image.height));
    files.write(Format::png, "difference, false colour", [&](const std::string& temporary) {
      writeImage(temporary,
                 falseColourPixels(width, height, c.difference, legendOf(3, true, relative)), true);
    });
  } else if (files.has(Format::png)) {
    Scene scene;
    if (isResultsFile(request.input))
      scene = readResults(request.input, false).scene.value_or(Scene());
    drawField(session, c.cells_of_b ? b.field() : a.field(), c, choosePicture(request, scene),
              files);
  }
  files.commit(session.report, session.progress);
  return code;
}

/// The causes of the gap in words, the largest first.
std::string gapCause(const Gathered& gathered) {
  std::string cause;
  if (gathered.summary.status == GatherStatus::pass_limit) {
    cause =
        fmt::format("light is missing that goes on after pass {}: allow more --passes; beside it, ",
                    gathered.summary.passes.size());
  }
  if (gathered.at == GatherAt::vertices) {
    return cause +
           "eyes see from points what form factors average over areas; radiosity is linear between "
           "vertices, not constant on patches: both fall with smaller patches; pixels: falls with "
           "--resolution";
  }
  return cause +
         "none but rounding where the form factors are the same hemicubes; else eyes see from one "
         "point what form factors average over a patch, and pixels";
}

/// Compares the matrix solution with the gather method; makes both if necessary.
int compareWithGather(Session& session, OutputSet& files) {
  const Request& request = session.request;
  if (!request.second.empty()) {
    throw InputError(fmt::format("compare: --gather compares {} with itself, so {} is one too many",
                                 request.input, request.second));
  }
  const CompareOptions options = request.apply(CompareOptions());
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  requireLight(session, pipeline);
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const FormFactors& factors = pipeline.factors();
  keepFactors(session, pipeline, files);
  if (const int code = judgeSolution(session, pipeline); code != 0) return code;
  const Gathered& gathered = pipeline.gathered();
  const PatchMaterials& materials = pipeline.materials();
  const LightField a = lightOf(mesh, pipeline.solution().radiosity, materials.bands,
                               "the matrix solution", materials.emission);
  const LightField b = lightOf(mesh, patchRadiosity(mesh, gathered), materials.bands,
                               "the gathered light", materials.emission);
  const Comparison c = compare(a, b, options);
  session.report.section("comparison", "Comparison: A the matrix solution, B the gathered light");
  reportComparison(session.report, c, false, false);
  session.report.text("gap", "where the gap comes from", gapCause(gathered));
  const int code = judge(session, c);
  if (files.has(Format::png)) {
    Picture picture = choosePicture(request, pipeline.scene());
    framePicture(picture, mesh, factors.report.closed,
                 reflectedLight(pipeline.solution().radiosity, materials));
    drawField(session, a, c, picture, files);
  }
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  return code;
}

}  // namespace

int runCompare(Session& session) {
  OutputSet files = claimOutputs(session);
  if (comparesMatrices(session.request)) return compareMatrixFiles(session, files);
  requirePicture(files, session.request);
  return session.request.with_gather ? compareWithGather(session, files)
                                     : compareFiles(session, files);
}

}  // namespace radiosity::cli
