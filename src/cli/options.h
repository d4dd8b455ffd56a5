// The options of the command line, in groups; their values go into the request.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/request.h"

namespace radiosity::cli {

// Each helper names the value in the help, and lets the option take one argument at a time, so that
// "-o a.png scene.obj" does not take the scene for an output.
template <class Value>
CLI::Option* add(CLI::App& app, const char* group, const std::string& names, Value& value,
                 const char* placeholder, const std::string& description) {
  CLI::Option* option = app.add_option(names, value, description);
  option->group(group)->option_text(placeholder)->allow_extra_args(false);
  return option;
}

/// Adds the options of a struct, as its list has them, but for those of another struct that are
/// there already: --crease serves pictures and elements. (described_options.cpp)
void addOptions(CLI::App& app, Request& r, const char* group, const std::vector<Option>& options);
template <class Options>
void addOptionsOf(CLI::App& app, Request& r, const char* group) {
  addOptions(app, r, group, optionLines(Options()));
}

// stage_options.cpp
void addSceneOptions(CLI::App& app, Request& r);
void addMeshOptions(CLI::App& app, Request& r);
void addFactorOptions(CLI::App& app, Request& r);
/// Areas of the rows of a matrix from a file.
void addAreasOption(CLI::App& app, Request& r, const char* group);
/// Options for solving with a matrix from a file.
void addMatrixOptions(CLI::App& app, Request& r);
void addTableOptions(CLI::App& app, Request& r);
/// Options for light of single lamps, of `solve` only.
void addBasisOption(CLI::App& app, Request& r);
void addMixOption(CLI::App& app, Request& r);

// point_options.cpp
void addPointOptions(CLI::App& app, Request& r);

// heat_options.cpp
void addHeatOptions(CLI::App& app, Request& r);

// picture_options.cpp
void addCameraOption(CLI::App& app, Request& r);
/// The camera and the picture's size.
void addCameraOptions(CLI::App& app, Request& r);
/// `shown_in`: the beginning of a sentence, "The page first shows".
void addExposureOption(CLI::App& app, Request& r, const char* shown_in);
void addRenderOptions(CLI::App& app, Request& r);
void addLightmapOptions(CLI::App& app, Request& r);
void addElementOptions(CLI::App& app, Request& r);
void addFinalGatherOption(CLI::App& app, Request& r);
void addVisibleOnlyOption(CLI::App& app, Request& r);
/// The ends of false colours.
void addRangeOption(CLI::App& app, Request& r, const char* group);
/// Options for the quantity to draw, of the stages with a matrix, and its colours.
void addShowOptions(CLI::App& app, Request& r);

}  // namespace radiosity::cli
