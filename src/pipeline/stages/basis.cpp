// Light of single lamps: from form factors and reflectance.
#include "pipeline/stages/get_or_make.h"
#include "solve/linear_solve.h"

namespace radiosity {

/// Throws an InputError unchanged: the fault is in the sources.
const LightBasis& Pipeline::basis() {
  factors();
  options_.solve.validate();
  if (options_.sources.empty()) {
    if (const LightBasis* at_hand = basisAtHand()) return *at_hand;
  }
  const PatchMaterials& materials = materialsOfMesh();
  const PatchMesh& patches = made(results_.mesh).mesh;
  const std::vector<LightSource> sources =
      options_.sources.empty() ? lightSources(materials, patches) : options_.sources;
  const StageKey key = basisKey(options_.solve, materials, sources, usedFactorsKey());
  return getOrMake(kStage<Stage::basis>, key, [&] {
    const FormFactors& factors = made(results_.factors);
    requireSolver(options_.solve.solver, factors.matrix);
    LightBasis light = solveBasis(factors, materials, patches, sources, options_.solve, progress_);
    const SolveSummary& summary = light.solution.summary;
    if (!summary.usable()) throw RunError("light of single lamps: " + summary.message);
    return light;
  });
}

const LightBasis* Pipeline::basisAtHand() {
  factors();
  const auto fits = [this](const Keyed<LightBasis>& basis) {
    return basis && changedInputs(StageKey(basis.key)).empty();
  };
  if (results_.basis) return fits(results_.basis) ? &made(results_.basis) : nullptr;
  return fits(stored_.basis) ? &takeStored(kStage<Stage::basis>) : nullptr;
}

}  // namespace radiosity
