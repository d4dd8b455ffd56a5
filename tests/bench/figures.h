// Error figures against truth, on scenes that no constant was fitted to.
#pragma once

#include <string>

namespace radiosity::bench {

/// Prints, for every scene and tolerance, how many rows are above their figure, the median of
/// figure over error, the worst row's error over figure, and how far rows are from the sums of
/// truth. Scenes: nested and touching boxes, slivers, and meshes of the Cornell box other than
/// those of the curves. `scene`: those whose name begins so; empty: all. Truth is kept in
/// `truth_folder`.
void benchFigures(const std::string& scene, const std::string& truth_folder);

}  // namespace radiosity::bench
