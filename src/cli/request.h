// The parsed command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/given_options.h"
#include "cli/measuring_points.h"
#include "cli/time_limit.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/lightmap.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/pipeline.h"
#include "radiosity/render.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace radiosity::cli {

enum class Command { info, mesh, factors, solve, gather, heat, compare, render, illuminance, view };

struct Request {
  Command command = Command::info;
  std::vector<std::string> arguments;  ///< as typed, for the report
  std::string input;
  std::string second;  ///< the second file of `compare`
  std::vector<std::string> outputs;

  bool devices = false;  ///< of `info`: list devices for hemicubes, instead of a scene

  SceneOptions scene;
  std::vector<std::string> light_lists;  ///< files of --lights, whose lights are in `scene`

  /// Of the scene, the stages, pictures and comparisons.
  GivenOptions given;

  std::string between;              ///< surfaces, groups or patches; empty: the output's default
  std::vector<std::string> groups;  ///< "NAME=PATTERN"
  std::string layout;               ///< wide or long; empty: wide
  std::string sky_name = "sky";
  std::string zone;  ///< of EnergyPlus; empty: the input's name

  std::string basis;  ///< surfaces, or a table of sets; empty: none
  std::string mix;    ///< "NAME=WEIGHT,..."; empty: none

  std::string thermal;  ///< a table of conditions
  std::vector<std::string> conditions;
  std::string patch_table;  ///< the .csv; empty: none
  std::string point_table;  ///< likewise

  std::string a_is;  ///< radiosity, radiance or srgb8; empty: that of the file
  std::string b_is;
  bool with_gather = false;
  std::optional<double> compare_tolerance;
  bool compare_factors = false;
  std::string areas;  ///< a file with areas of the rows of a matrix
  std::string rows;   ///< a file with their reflectance and emission

  std::vector<PointsAsked> points;  ///< of `illuminance` and `heat`

  std::string camera;
  std::string exposure = "auto";
  std::string gallery;  ///< the folder of `view`; empty: none
  std::optional<bool> elements;
  std::string lightmap;  ///< the .exr; empty: none
  bool final_gather = false;
  bool visible_only = false;
  bool flat = false;
  std::string show;
  std::string range;  ///< of false colours, "LOW,HIGH"; empty: automatic
  bool layers = false;

  int threads = 0;
  double time_limit = kNoTimeLimit;  ///< seconds
  std::string report;
  bool quiet = false;

  /// `options` with the given values; validated.
  template <class Options>
  Options apply(Options options) const {
    given.applyTo(options);
    options.validate();
    return options;
  }
  /// `results_output`: the .h5 that is written; empty: none.
  JournalOptions journal(const std::string& results_output) const;
  /// The given options of the picture, without a size if none was given; validated.
  RenderOptions renderOptions() const;
  /// The stops of --exposure; nothing for auto.
  std::optional<double> exposureStops() const;

  /// Checks all that needs no scene, so that no scene is read in vain. Errors: InputError.
  void validate() const;
};

/// Only one of the number of patches, their longest edge and faces as patches sets the resolution:
/// a new one replaces an earlier one.
template <>
MeshOptions Request::apply(MeshOptions options) const;
/// Bands by edges replace bands by fractions, and the other way round.
template <>
HeatOptions Request::apply(HeatOptions options) const;

const char* commandName(Command command);

/// Parses and checks the arguments. Help and version are printed, and their exit code is returned.
/// Errors: InputError, with the nearest word for a typo.
std::optional<int> parseCommandLine(int argc, char** argv, Request& request);

}  // namespace radiosity::cli
