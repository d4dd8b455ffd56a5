// Subcommands on form-factor matrices from files, without a scene.
#pragma once

#include "cli/commands.h"
#include "radiosity/matrix_files.h"

namespace radiosity::cli {

/// Whether a file has only form factors, or should have by its name (.mtx, .vf).
bool isMatrixInput(const std::string& path);

/// Whether the input is a matrix from a file. Throws InputError if a scene is given with its
/// options.
bool takesMatrixFile(const Request& request);
/// Throws InputError for options that apply to scenes.
void refuseSceneOptions(const Request& request);

/// Reads the matrix, with the areas of --areas.
MatrixFile readMatrixInput(Session& session);
/// Reports the number of rows and their faults, and returns the form factors.
FormFactors reportedFactors(Session& session, const MatrixFile& file);

/// Whether `compare` compares form factors: the files have nothing else, or --form-factors is
/// given.
bool comparesMatrices(const Request& request);
int compareMatrixFiles(Session& session, OutputSet& files);

int solveMatrixFile(Session& session, OutputSet& files);
int heatMatrixFile(Session& session, OutputSet& files);
/// Runs `info` for a matrix.
int describeMatrixFile(Session& session);

}  // namespace radiosity::cli
