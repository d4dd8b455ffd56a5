// Checks that the data of a file is consistent: every index is valid, every length fits.
#pragma once

#include "radiosity/results.h"

namespace radiosity {

/// Throws InputError naming the file, the dataset and its error. Checksums detect damage; this
/// detects wrong edits by other programs.
void checkResults(const std::string& path, const Results& results);

}  // namespace radiosity
