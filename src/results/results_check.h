// Whether what a file says hangs together: every index points at something, every length fits.
#pragma once

#include "radiosity/results.h"

namespace radiosity {

/// Throws InputError naming file, dataset and what is wrong with it. Checksums catch damage; this
/// catches files that another program has edited.
void checkResults(const std::string& path, const Results& results);

/// As PatchMesh::unknowns(), of a mesh of whose clusters of_patch alone is filled in.
std::size_t unknownsOf(const PatchMesh& mesh);

}  // namespace radiosity
