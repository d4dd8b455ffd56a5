// Output of the benchmark.
#pragma once

#include <string>
#include <vector>

#include "error_curves.h"
#include "summary.h"

namespace radiosity::bench {

/// The table of one scene, as it is measured.
void printCurveHead(const SceneCurves& curves);
void printMeasurement(const Measurement& measurement);
/// A line that names the exact settings that were not run; none where all were.
void printLeftOut(const SceneCurves& curves);

/// Summary of the curves.
void printSummary(const Summary& summary);

/// Every figure of every measurement, one line each, with a head line of names.
void writeCsv(const std::string& path, const std::vector<SceneCurves>& curves);

/// The comparisons with the ray-cast curve, one line a scene; the plot draws them.
void writeComparisonsCsv(const std::string& path, const std::vector<RayComparison>& comparisons);

}  // namespace radiosity::bench
