// Radiative heat exchange: from form factors and the conditions of surfaces.
#include "pipeline/stages/get_or_make.h"

namespace radiosity {

/// Throws an InputError unchanged: the fault is in the conditions.
const HeatSolution& Pipeline::heat() {
  factors();
  options_.heat.validate();
  const StageKey key = heatKey(options_.heat, options_.heat_conditions, usedFactorsKey());
  return getOrMake(kStage<Stage::heat>, key, [this] {
    return solveHeat(made(results_.factors), options_.heat_conditions, made(results_.mesh).mesh,
                     options_.heat, progress_);
  });
}

}  // namespace radiosity
