#include "cli/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parse.h"
#include "cli/words.h"
#include "radiosity/compare.h"

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
    case Command::illuminance:
      return "illuminance";
    case Command::view:
      break;
  }
  return "view";
}

template <>
MeshOptions Request::apply(MeshOptions options) const {
  const bool by_edge = given.has("max-edge");
  if (given.has("patches")) options.max_edge = 0;
  if (given.has("patches") || by_edge) options.faces_as_patches = false;
  given.applyTo(options);
  options.validate();
  return options;
}

template <>
HeatOptions Request::apply(HeatOptions options) const {
  const char* bands = nullptr;
  for (const char* name : {"band-edges", "band-fractions"}) {
    if (given.has(name)) bands = name;
  }
  if (bands != nullptr) options.bands = {};
  given.applyTo(options);
  if (bands != nullptr) nameOption(given.spelled(bands), [&] { options.bands.validate(); });
  options.validate();
  return options;
}

JournalOptions Request::journal(const std::string& results_output) const {
  JournalOptions options;
  if (!results_output.empty()) options.path = results_output + ".rows";
  given.applyTo(options);
  // Asked for, so also in a short run.
  if (given.has("resume") && options.resume) options.from_seconds = 0;
  return options;
}

RenderOptions Request::renderOptions() const {
  RenderOptions options = apply(RenderOptions());
  options.smooth = !flat;
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
  apply(LightmapOptions());
  apply(CompareOptions());
  apply(IlluminanceOptions());
  renderOptions();
  exposureStops();
  checkCamera(camera);
}

}  // namespace radiosity::cli
