// Subcommands on form-factor matrices from files, without a scene.
#pragma once

#include "cli/commands.h"
#include "radiosity/matrix_files.h"

namespace radiosity::cli {

/// Whether a file holds form factors alone, or ought to by its name (.mtx, .vf).
bool isMatrixInput(const std::string& path);

/// Whether the input is a matrix from elsewhere. InputError for its options with a scene.
bool takesMatrixFile(const Request& request);
/// InputError for options that are about a scene.
void refuseSceneOptions(const Request& request);

/// Reads the matrix, with the areas of --areas.
MatrixFile readMatrixInput(Session& session);
/// Its form factors, after saying how many rows there are and what is wrong with them.
FormFactors reportedFactors(Session& session, const MatrixFile& file);

/// Whether `compare` is asked about form factors: of files that hold nothing else, or by
/// --form-factors.
bool comparesMatrices(const Request& request);
int compareMatrixFiles(Session& session, OutputSet& files);

int solveMatrixFile(Session& session, OutputSet& files);
int heatMatrixFile(Session& session, OutputSet& files);
/// What `info` says of a matrix.
int describeMatrixFile(Session& session);

}  // namespace radiosity::cli
