// Light of single lamps: from form factors and reflectance.
#include "base/hash.h"
#include "pipeline/stages/get_or_make.h"
#include "scene/lights/light_text.h"
#include "solve/linear_solve.h"

namespace radiosity {

namespace {

std::string sourcesHash(std::span<const LightSource> sources) {
  Hash hash;
  for (const LightSource& source : sources) {
    hash.text(source.name);
    hash.array(source.emission);
    hash.array(skyRadiance(source.lights));
    for (const std::string& light : otherLights(source.lights)) hash.text(light);
  }
  return hash.hex();
}

}  // namespace

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
  StageKey key(keyText(options_.solve));
  key.add("reflectance", reflectanceHash(materials));
  key.add("sources", sourcesHash(sources));  // with the emission
  key.add("factors", keyHash(usedFactorsKey().text()));
  return getOrMake(kStage<Stage::basis>, key, [&] {
    const FormFactors& factors = made(results_.factors);
    requireSolver(options_.solve.solver, *factors.matrix);
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
