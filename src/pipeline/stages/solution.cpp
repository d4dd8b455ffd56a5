// The solution: from form factors and materials.
#include "pipeline/stages/get_or_make.h"
#include "solve/linear_solve.h"

namespace radiosity {

namespace {

/// `factors_key`: a key that usedKey() returned.
StageKey solutionKey(const SolveOptions& options, const PatchMaterials& materials,
                     const StageKey& factors_key) {
  StageKey key(keyText(options));
  key.add("materials", materialsHash(materials));
  key.add("sky", lightsText(materials.lights));
  key.add("factors", keyHash(factors_key.text()));
  return key;
}

}  // namespace

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
    requireSolver(options_.solve.solver, *factors.matrix);
    return computedStage("solution", [&] {
      return solve(factors, made(results_.materials), made(results_.mesh).mesh, options_.solve,
                   progress_);
    });
  });
}

std::string keyOfSolution(const SolveOptions& options, const PatchMaterials& materials,
                          const std::string& factors_key, const std::string& method) {
  return solutionKey(options, materials, usedKey(StageKey(factors_key), method)).text();
}

}  // namespace radiosity
