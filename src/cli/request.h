// The parsed command line. An option that was not given is empty, so that an existing stage keeps
// its value.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/time_limit.h"
#include "radiosity/compare.h"
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

enum class Command { info, mesh, factors, solve, gather, heat, compare, render, view };

struct Request {
  Command command = Command::info;
  std::vector<std::string> arguments;  ///< as typed, for the report
  std::string input;
  std::string second;  ///< the second file of `compare`
  std::vector<std::string> outputs;

  bool devices = false;  ///< of `info`: list devices for hemicubes, instead of a scene

  SceneOptions scene;
  /// The given options that only apply to reading a scene file ("--unit").
  std::vector<std::string> reading_options;

  std::optional<std::size_t> patches;
  std::optional<double> max_edge;
  std::optional<double> weld;
  std::optional<bool> faces_as_patches;

  std::optional<std::string> method;
  std::optional<double> tolerance;
  std::optional<std::string> closure;
  std::optional<std::string> near_pairs;
  std::optional<std::string> emitters;
  std::optional<int> resolution;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> eye;
  std::optional<bool> symmetrize;
  std::optional<std::string> precision;
  std::string memory_limit;
  std::optional<bool> resume;

  std::string between;              ///< surfaces, groups or patches; empty: the output's default
  std::vector<std::string> groups;  ///< "NAME=PATTERN"
  std::string layout;               ///< wide or long; empty: wide
  std::string sky_name = "sky";
  std::string zone;  ///< of EnergyPlus; empty: the input's name

  std::optional<std::string> solver;
  std::optional<double> solve_tolerance;
  std::optional<int> max_iterations;

  std::string basis;  ///< surfaces, or a table of sets; empty: none
  std::string mix;    ///< "NAME=WEIGHT,..."; empty: none

  std::optional<std::string> gather_at;
  std::optional<int> passes;
  std::optional<double> gather_tolerance;

  std::string thermal;  ///< a table of conditions
  std::vector<std::string> conditions;
  std::optional<double> sky_temperature;
  std::string band_edges;
  std::string band_fractions;
  std::optional<double> heat_tolerance;
  std::optional<int> heat_iterations;
  std::string patch_table;  ///< the .csv; empty: none

  std::string a_is;  ///< radiosity, radiance or srgb8; empty: that of the file
  std::string b_is;
  bool with_gather = false;
  bool fit_scale = false;
  bool partial = false;
  std::optional<double> match;
  std::optional<double> compare_tolerance;
  bool compare_factors = false;
  std::string areas;  ///< a file with areas of the rows of a matrix
  std::string rows;   ///< a file with their reflectance and emission

  std::string camera;
  std::optional<int> width;
  std::optional<int> height;
  std::string exposure = "auto";
  std::optional<int> samples;
  std::optional<double> crease;
  std::optional<bool> elements;
  std::optional<double> element_tolerance;
  std::string lightmap;  ///< the .exr; empty: none
  std::optional<int> lightmap_size;
  std::optional<std::string> lightmap_shows;
  bool final_gather = false;
  bool visible_only = false;
  bool flat = false;
  std::string backs = "hide";
  std::string show;

  int threads = 0;
  double time_limit = kNoTimeLimit;  ///< seconds
  std::string report;
  bool quiet = false;

  /// `options` with the given values; validated.
  MeshOptions apply(MeshOptions options) const;
  FormFactorOptions apply(FormFactorOptions options) const;
  SolveOptions apply(SolveOptions options) const;
  GatherOptions apply(GatherOptions options) const;
  ElementOptions apply(ElementOptions options) const;
  HeatOptions apply(HeatOptions options) const;
  LightmapOptions lightmapOptions() const;
  /// `results_output`: the .h5 that is written; empty: none.
  JournalOptions journal(const std::string& results_output) const;
  CompareOptions compareOptions() const;
  /// The given options of the picture, without a size if none was given; validated.
  RenderOptions renderOptions() const;
  /// The stops of --exposure; nothing for auto.
  std::optional<double> exposureStops() const;

  /// Checks all that needs no scene, so that no scene is read in vain. Errors: InputError.
  void validate() const;
};

/// Calls check() and prefixes the option's name to an InputError that it throws.
template <class Check>
void nameOption(const std::string& option, const Check& check) {
  try {
    check();
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what());
  }
}

const char* commandName(Command command);

/// Parses and checks the arguments. Help and version are printed, and their exit code is returned.
/// Errors: InputError, with the nearest word for a typo.
std::optional<int> parseCommandLine(int argc, char** argv, Request& request);

}  // namespace radiosity::cli
