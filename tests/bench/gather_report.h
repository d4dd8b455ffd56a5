// Output of the benchmark of the gather method.
#pragma once

#include <string>
#include <vector>

#include "gather_costs.h"

namespace radiosity::bench {

inline constexpr const char* kExactSolved = "exact matrix";
inline constexpr const char* kHemicubeSolved = "hemicube matrix";
inline constexpr const char* kGatherAtPatches = "gather at patches";
inline constexpr const char* kGatherAtVertices = "gather at vertices";

/// The table of one scene, as it is measured.
void printGatherHead(const GatherCosts& costs);
void printGatherCost(const GatherCost& cost);

/// At how many passes gathering takes as long as each matrix with its solution, by the straight
/// line through its least and most passes; and at how many patches a matrix takes as much memory as
/// gathering, by straight lines in logarithms between the sizes measured (beyond them: the nearest
/// two).
void printCrossings(const std::vector<GatherCosts>& all);

/// Every figure, a line a method and number of passes, with a head line of names.
void writeGatherCsv(const std::string& path, const std::vector<GatherCosts>& all);

}  // namespace radiosity::bench
