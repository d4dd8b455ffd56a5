// Radiative heat exchange: from form factors and the conditions of surfaces.
#include "base/hash.h"
#include "pipeline/stages/get_or_make.h"

namespace radiosity {

namespace {

/// Hashes a value such that a missing one differs from every number.
void addOptional(const std::optional<double>& value, Hash& hash) {
  hash.array(value ? std::vector<double>{*value} : std::vector<double>{});
}

std::string conditionsHash(const HeatConditions& conditions) {
  Hash hash;
  hash.array(conditions.of_surface);
  for (const std::string& group : conditions.text.groups) hash.text(group);
  for (const HeatCondition& c : conditions.conditions) {
    for (const Emissivity& e : c.emissivity) {
      hash.array(e.temperatures);
      hash.array(e.values);
    }
    addOptional(c.temperature, hash);
    addOptional(c.flux, hash);
    addOptional(c.power, hash);
    hash.array(std::vector<double>{c.convection, c.ambient});
    hash.text(onOff(c.isothermal));
  }
  return hash.hex();
}

StageKey heatKey(const HeatOptions& options, const HeatConditions& conditions,
                 const StageKey& factors_key) {
  StageKey key(keyText(options));
  key.add("conditions", conditionsHash(conditions));
  key.add("factors", keyHash(factors_key.text()));
  return key;
}

}  // namespace

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

std::string keyOfHeat(const HeatOptions& options, const HeatConditions& conditions,
                      const std::string& factors_key, const std::string& method) {
  return heatKey(options, conditions, usedKey(StageKey(factors_key), method)).text();
}

}  // namespace radiosity
