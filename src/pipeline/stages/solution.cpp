// The solution: from form factors and materials.
#include "pipeline/stages/get_or_make.h"
#include "solve/linear_solve.h"

namespace radiosity {

const PatchMaterials& Pipeline::materialsOfMesh() {
  if (!results_.materials) results_.materials = patchMaterials(scene(), made(results_.mesh).mesh);
  return made(results_.materials);
}

const PatchMaterials& Pipeline::materials() {
  mesh();
  return materialsOfMesh();
}

const Solution& Pipeline::solution() {
  factors();
  options_.solve.validate();
  const StageKey key = solutionKey(options_.solve, materialsOfMesh(), usedFactorsKey());
  return getOrMake(kStage<Stage::solution>, key, [this] {
    const FormFactors& factors = made(results_.factors);
    requireSolver(options_.solve.solver, factors.matrix);
    return computedStage("solution", [&] {
      return solve(factors, made(results_.materials), made(results_.mesh).mesh, options_.solve,
                   progress_);
    });
  });
}

}  // namespace radiosity
