// Subcommands on form-factor matrices from files, without a scene.
#pragma once

#include "cli/commands.h"

namespace radiosity::cli {

/// Whether `compare` is asked about form factors: of files that hold nothing else, or by
/// --form-factors.
bool comparesMatrices(const Request& request);
int compareMatrixFiles(Session& session, OutputSet& files);

/// Whether `solve` is given a matrix from elsewhere. InputError for its options with a scene.
bool solvesMatrixFile(const Request& request);
int solveMatrixFile(Session& session, OutputSet& files);

}  // namespace radiosity::cli
