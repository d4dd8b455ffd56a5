// The table of methods.
#include <array>
#include <stdexcept>

#include "formfactor/exact/assembly/exact_factors.h"
#include "formfactor/hemicube/hemicube_factors.h"
#include "formfactor/method.h"
#include "formfactor/rays/ray_factors.h"

namespace radiosity {

const MethodEntry& entryOf(FormFactorMethod method) {
  static constexpr std::array kEntries{
      MethodEntry{FormFactorMethod::exact, &prepareExact, &exactRowsForOthers},
      MethodEntry{FormFactorMethod::rays, &prepareRays, &rayRowsForOthers},
      MethodEntry{FormFactorMethod::hemicube, &prepareHemicubes, &hemicubeRowsForOthers}};
  for (const MethodEntry& entry : kEntries) {
    if (entry.method == method) return entry;
  }
  throw std::logic_error("no method that computes form factors");
}

}  // namespace radiosity
