// Error figures against truth, on scenes that no constant was fitted to.
#pragma once

#include <string>

namespace radiosity::bench {

/// Prints, for every scene and tolerance, which share of rows is below its figure, the median of
/// figure over error, the worst row, and how far rows are from the sums of truth, beside what their
/// figures would have them. Scenes are made here: nested and touching boxes, slivers, and meshes of
/// the Cornell box other than those of the curves. `scene`: those whose name begins so; empty: all.
void benchFigures(const std::string& scene, const std::string& truth_folder);

}  // namespace radiosity::bench
