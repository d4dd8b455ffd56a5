// The methods that the benchmark compares, each with the one setting that trades time for error.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity::bench {

inline constexpr const char* kRays = "rays";

struct Method {
  std::string name;     ///< of the curve: "exact", "hemicube", "hemicube + near", kRays
  std::string setting;  ///< what `value` is: "pixels", "tolerance"
  double value = 0;
  std::function<FormFactors(const PatchMesh&)> compute;
};

Method exact(double tolerance);
Method rays(double tolerance);
Method hemicube(int resolution, bool near_exact);

/// From the loosest setting to the tightest.
std::vector<Method> exactMethods();

/// The others; `quick`: without what takes minutes.
std::vector<Method> otherMethods(bool quick);

}  // namespace radiosity::bench
