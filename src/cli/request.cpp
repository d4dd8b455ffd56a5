#include "cli/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parse.h"
#include "cli/words.h"
#include "radiosity/names.h"

namespace radiosity::cli {

const char* commandName(Command command) {
  switch (command) {
    case Command::info:
      return "info";
    case Command::mesh:
      return "mesh";
    case Command::factors:
      return "factors";
    case Command::solve:
      return "solve";
    case Command::gather:
      return "gather";
    case Command::heat:
      return "heat";
    case Command::compare:
      return "compare";
    case Command::render:
      return "render";
    case Command::view:
      break;
  }
  return "view";
}

namespace {

/// Sets a field if the option was given; an error names the option.
template <class Options, class Value, class Given>
void set(Options& options, Value Options::*field, const std::optional<Given>& given,
         const char* name) {
  if (!given) return;
  options.*field = Value(*given);
  nameOption(name, [&] { options.validate(); });
}

/// Sets a field to the value of a word that the command line has accepted.
template <class Table, class Enum>
void setNamed(Enum& value, const Table& table, const std::optional<std::string>& word) {
  if (word) value = named(table, *word).value_or(value);
}

}  // namespace

MeshOptions Request::apply(MeshOptions options) const {
  // Only one of the three sets the resolution; the new one replaces the earlier one.
  if (patches) options.max_edge = 0;
  if (patches || max_edge) options.faces_as_patches = false;
  set(options, &MeshOptions::patches, patches, "--patches");
  set(options, &MeshOptions::max_edge, max_edge, "--max-edge");
  set(options, &MeshOptions::weld, weld, "--weld");
  set(options, &MeshOptions::faces_as_patches, faces_as_patches, "--faces-as-patches");
  options.validate();
  return options;
}

FormFactorOptions Request::apply(FormFactorOptions options) const {
  setNamed(options.method, kMethodNames, method);
  set(options, &FormFactorOptions::tolerance, tolerance, "--tolerance");
  setNamed(options.closure, kClosureNames, closure);
  if (near_pairs) options.near_exact = *near_pairs == "exact";
  if (emitters) options.exact_emitters = *emitters == "exact";
  set(options, &FormFactorOptions::resolution, resolution, "--resolution");
  set(options, &FormFactorOptions::seed, seed, "--seed");
  setNamed(options.eye, kEyeNames, eye);
  set(options, &FormFactorOptions::symmetrize, symmetrize, "--symmetrize");
  if (precision) options.precision = named(kPrecisionNames, *precision);
  if (!memory_limit.empty()) options.memory_limit = parseBytes("--memory-limit", memory_limit);
  options.validate();
  return options;
}

SolveOptions Request::apply(SolveOptions options) const {
  setNamed(options.solver, kSolverNames, solver);
  set(options, &SolveOptions::tolerance, solve_tolerance, "--solve-tolerance");
  set(options, &SolveOptions::max_iterations, max_iterations, "--max-iterations");
  options.validate();
  return options;
}

GatherOptions Request::apply(GatherOptions options) const {
  setNamed(options.at, kGatherAtNames, gather_at);
  set(options, &GatherOptions::passes, passes, "--passes");
  set(options, &GatherOptions::tolerance, gather_tolerance, "--gather-tolerance");
  set(options, &GatherOptions::resolution, resolution, "--resolution");
  set(options, &GatherOptions::seed, seed, "--seed");
  setNamed(options.eye, kEyeNames, eye);
  set(options, &GatherOptions::crease, crease, "--crease");
  options.validate();
  return options;
}

LightmapOptions Request::lightmapOptions() const {
  LightmapOptions options;
  set(options, &LightmapOptions::size, lightmap_size, "--lightmap-size");
  set(options, &LightmapOptions::crease, crease, "--crease");
  setNamed(options.shows, kLightmapShowsNames, lightmap_shows);
  return options;
}

JournalOptions Request::journal(const std::string& results_output) const {
  JournalOptions options;
  if (!results_output.empty()) options.path = results_output + ".rows";
  options.resume = resume.value_or(true);
  if (resume == true) options.from_seconds = 0;  // asked for, so also in a short run
  return options;
}

CompareOptions Request::compareOptions() const {
  CompareOptions options;
  options.fit_scale = fit_scale;
  options.partial = partial;
  set(options, &CompareOptions::match, match, "--match");
  options.validate();
  return options;
}

ElementOptions Request::apply(ElementOptions options) const {
  set(options, &ElementOptions::tolerance, element_tolerance, "--element-tolerance");
  set(options, &ElementOptions::crease, crease, "--crease");
  options.validate();
  return options;
}

namespace {

std::vector<double> numbersIn(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view word : splitAt(text, ',')) {
    const std::optional<double> number = parseNumber(word);
    if (!number) {
      throw InputError(fmt::format("{} {}: `{}` is not a number; separate them by commas alone",
                                   option, text, word));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace

HeatOptions Request::apply(HeatOptions options) const {
  set(options, &HeatOptions::sky_temperature, sky_temperature, "--sky-temperature");
  set(options, &HeatOptions::tolerance, heat_tolerance, "--heat-tolerance");
  set(options, &HeatOptions::max_iterations, heat_iterations, "--heat-iterations");
  if (!band_edges.empty()) {
    options.bands = {numbersIn("--band-edges", band_edges), {}};
    nameOption("--band-edges", [&] { options.validate(); });
  }
  if (!band_fractions.empty()) {
    options.bands = {{}, numbersIn("--band-fractions", band_fractions)};
    nameOption("--band-fractions", [&] { options.validate(); });
  }
  options.validate();
  return options;
}

RenderOptions Request::renderOptions() const {
  RenderOptions options;
  set(options, &RenderOptions::width, width, "--width");
  set(options, &RenderOptions::height, height, "--height");
  set(options, &RenderOptions::samples, samples, "--samples");
  set(options, &RenderOptions::crease, crease, "--crease");
  options.smooth = !flat;
  options.show_backs = backs == "show";
  return options;
}

std::optional<double> Request::exposureStops() const {
  if (exposure == "auto") return std::nullopt;
  const std::optional<double> ev = parseNumber(exposure);
  constexpr double kLargest = 100;  // 2^100 is beyond any lamp
  if (!ev || std::abs(*ev) > kLargest) {
    throw InputError(
        fmt::format("--exposure: '{}' is neither auto nor a number of stops from -100 "
                    "to 100, e.g. --exposure 2.5",
                    exposure));
  }
  return ev;
}

namespace {

/// Checks a camera in numbers; other words are names of the scene's cameras. Which axis points up
/// is not known yet, so a camera is wrong if it is for both.
void checkCamera(const std::string& text) {
  constexpr std::array kKeys = {"eye=", "target=", "up=", "fov="};
  const auto begins = [&text](const char* key) { return text.starts_with(key); };
  if (std::none_of(kKeys.begin(), kKeys.end(), begins)) return;
  try {
    parseCamera(text, Up::y);
  } catch (const InputError&) {
    nameOption("--camera", [&text] { parseCamera(text, Up::z); });
  }
}

}  // namespace

void Request::validate() const {
  apply(MeshOptions());
  apply(FormFactorOptions());
  apply(SolveOptions());
  apply(GatherOptions());
  apply(ElementOptions());
  apply(HeatOptions());
  nameOption("--max-image", [this] { scene.validate(); });
  renderOptions();
  exposureStops();
  compareOptions();
  lightmapOptions();
  checkCamera(camera);
}

}  // namespace radiosity::cli
