// The methods that the benchmark compares, each with the one setting that trades time for error.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity::bench {

inline constexpr const char* kRays = "rays";
inline constexpr const char* kRaysBothEnds = "rays both ends";

struct Method {
  std::string name;  ///< of the curve: "exact", "hemicube", "hemicube + near", kRays, kRaysBothEnds
  std::string setting;  ///< what `value` is: "pixels", "tolerance", "rays a patch"
  double value = 0;
  std::function<FormFactors(const PatchMesh&)> compute;
};

Method exact(double tolerance);
Method hemicube(int resolution, bool near_exact);

/// From the loosest setting to the tightest.
std::vector<Method> exactMethods();

/// The others, for a mesh of that many patches. Ray counts go up by factors of four from 256 a
/// patch, as far as `quick` or full running times bear.
std::vector<Method> otherMethods(std::size_t patches, bool quick);

}  // namespace radiosity::bench
