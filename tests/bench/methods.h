// The methods that the benchmark compares, each with the one setting that trades time for error.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity::bench {

struct Method {
  std::string name;     ///< of the curve: "hemicube", "hemicube + near", "exact", "rays"
  std::string setting;  ///< what `value` is: "pixels", "tolerance", "rays a patch"
  double value = 0;
  std::function<FormFactors(const PatchMesh&)> compute;
};

Method hemicube(int resolution, bool near_exact);
Method exact(double tolerance);
Method rays(std::uint32_t count);

/// All of them for a mesh of that many patches. Ray counts go up by factors of four from 256 a
/// patch, as far as `quick` or full running times bear.
std::vector<Method> methods(std::size_t patches, bool quick);

}  // namespace radiosity::bench
