#include "cli/show.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/luminance.h"
#include "base/parse.h"
#include "cli/words.h"
#include "radiosity/light.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

struct PatchWord {
  const char* word;
  Quantity quantity;
};
constexpr PatchWord kOfPatches[] = {
    {"radiosity", Quantity::radiosity}, {"irradiance", Quantity::irradiance},
    {"row-sum", Quantity::row_sum},     {"temperature", Quantity::temperature},
    {"net-flux", Quantity::net_flux},   {"heat-irradiance", Quantity::heat_irradiance}};
constexpr const char* kFormFactor = "form-factor:";

/// The same with the ends of --range.
FalseColour inRange(const Session& session, FalseColour legend) {
  const ShownRange range = parseRange(session.request.range);
  legend.low = range.low;
  legend.high = range.high;
  return legend;
}

/// Of the .exr: the values of a grey picture in a channel of their own name.
std::vector<ImageLayer> channelOf(const std::string& name, const std::string& unit,
                                  const Image& grey) {
  ImageLayer layer{name, unit, {}, {}};
  for (std::size_t k = 0; k < grey.rgba.size(); k += 4) layer.values.push_back(grey.rgba[k]);
  return {std::move(layer)};
}

/// Reports the place of the patch whose form factors are drawn.
void describePatch(Report& report, const PatchMesh& mesh, std::size_t patch) {
  const Vec3 c = mesh.centroid[patch];
  const double centroid[] = {c.x, c.y, c.z};
  report.text("patch_surface", "patch lies on", mesh.surface_names[mesh.surface[patch]]);
  report.bands("patch_centroid_m", "patch centroid", centroid, "m");
}

std::string withUnit(const FalseColour& legend) {
  return legend.unit.empty() ? legend.title : legend.title + ", " + legend.unit;
}

}  // namespace

Show parseShow(const std::string& text) {
  if (text.empty()) return {};
  std::vector<std::string> known;
  for (const ShownLight& light : shownLights()) {
    if (text == light.name) return {.quantity = {}, .light = light};
    known.emplace_back(light.name);
  }
  for (const auto& [word, quantity] : kOfPatches) {
    if (text == word) return {.quantity = quantity, .light = {}};
    known.emplace_back(word);
  }
  const std::string prefix = kFormFactor;
  if (text.starts_with(prefix)) {
    std::size_t patch = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + prefix.size(), last, patch);
    if (error == std::errc() && end == last) {
      return {.quantity = Quantity::form_factor, .patch = patch, .light = {}};
    }
    throw InputError(
        fmt::format("--show: '{}' needs a patch number from 0, e.g. form-factor:12", text));
  }
  known.push_back(prefix + "PATCH");
  throw InputError(fmt::format("--show: '{}' is not one of {}{}", text, fmt::join(known, ", "),
                               suggestion(text, known)));
}

ShownRange parseRange(const std::string& text) {
  if (text.empty()) return {};
  const std::vector<std::string_view> parts = splitAt(text, ',');
  if (parts.size() == 2) {
    const std::optional<double> low = parseNumber(parts[0]);
    const std::optional<double> high = parseNumber(parts[1]);
    if (low && high && *low < *high) return {*low, *high};
  }
  throw InputError(fmt::format(
      "--range: '{}' is not two rising numbers with a comma, e.g. --range 0,500", text));
}

void requirePatch(const Show& show, const PatchMesh& mesh) {
  if (show.quantity != Quantity::form_factor || show.patch < mesh.size()) return;
  throw InputError(fmt::format("--show: there is no patch {}; the mesh has patches 0 to {}",
                               show.patch, mesh.size() - 1));
}

void drawQuantity(Session& session, Pipeline& pipeline, const Picture& picture, Quantity quantity,
                  std::size_t patch, OutputSet& files) {
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const ScalarField field = pipeline.field(quantity, patch);
  const FalseColour legend = inRange(session, field.legend);
  RenderOptions options = picture.options;
  options.smooth = options.smooth && field.smooth;
  std::vector<double> known;  // a temperature may be undetermined
  std::ranges::copy_if(field.values, std::back_inserter(known),
                       [](double value) { return !std::isnan(value); });
  session.report.text("quantity", "shown", withUnit(legend));
  if (quantity == Quantity::form_factor) describePatch(session.report, mesh, patch);
  if (!known.empty()) {
    const auto [low, high] = std::ranges::minmax(known);
    session.report.number("lowest", "lowest of all patches", low, legend.unit);
    session.report.number("highest", "highest of all patches", high, legend.unit);
  }
  files.write(Format::png, withUnit(legend), [&](const std::string& temporary) {
    writeImage(
        temporary,
        renderFalseColour(mesh, field.values, legend, picture.camera, options, session.progress),
        true, metadataOf(picture, legend.title, legend.unit));
  });
  files.write(Format::exr, withUnit(legend), [&](const std::string& temporary) {
    std::vector<double> values;
    values.reserve(3 * field.values.size());
    for (const double value : field.values) values.insert(values.end(), 3, value);
    const Image grey = render(mesh, values, picture.camera, options, session.progress);
    const std::string word = session.request.show.substr(0, session.request.show.find(':'));
    writeImage(temporary, grey, false, metadataOf(picture, legend.title, legend.unit),
               channelOf(word, legend.unit, grey));
  });
}

void drawLight(Session& session, const PatchMesh& mesh, const Image& radiance, int bands,
               const Picture& picture, const ShownLight& unit, OutputSet& files) {
  const std::vector<double> values = shownValues(radiance, unit);
  Image grey = radiance;
  std::vector<double> shown;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const bool hit = !std::isnan(values[k]);
    std::fill_n(&grey.rgba[4 * k], 3, hit ? float(values[k]) : 0.f);
    if (hit) shown.push_back(values[k]);
  }
  const FalseColour legend = inRange(session, legendOf(unit, bands));
  Report& report = session.report;
  report.section("shown", "Shown in false colours");
  report.text("quantity", "shown", withUnit(legend));
  if (unit.photometric) report.text("lumens", "lumens", photometricText(bands));
  if (!shown.empty()) {
    const auto [low, high] = std::ranges::minmax(shown);
    report.number("lowest", "lowest of all pixels", low, unit.unit);
    report.number("highest", "highest of all pixels", high, unit.unit);
  }
  files.write(Format::png, withUnit(legend), [&](const std::string& temporary) {
    writeImage(temporary, falseColourPicture(mesh, values, legend, picture.camera, picture.options),
               true, metadataOf(picture, legend.title, legend.unit));
  });
  files.write(Format::exr, withUnit(legend), [&](const std::string& temporary) {
    writeImage(temporary, grey, false, metadataOf(picture, legend.title, legend.unit),
               channelOf(unit.name, unit.unit, grey));
  });
}

}  // namespace radiosity::cli
