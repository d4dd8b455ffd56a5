// Keys: the options that made a stage and hashes of its inputs, as text. A stage is reused only if
// its key is the same.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/option_list.h"
#include "radiosity/elements.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/light_basis.h"
#include "radiosity/names.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace radiosity {

/// "name=value name=value ...": people can read it in the results file, and the options can be read
/// back from it.
class StageKey {
 public:
  StageKey() = default;
  explicit StageKey(std::string_view text);
  void add(std::string name, std::string value);
  std::optional<std::string> get(std::string_view name) const;
  const std::vector<std::pair<std::string, std::string>>& pairs() const { return pairs_; }
  std::string text() const;
  /// The changes in words: "resolution 256 -> 512, form factors changed". Empty if nothing changed.
  static std::string difference(const StageKey& before, const StageKey& after);

 private:
  std::vector<std::pair<std::string, std::string>> pairs_;
};

/// The key has all properties of the scene that meshing uses: vertices, faces, surfaces with their
/// sides, and which surfaces emit (an emitter wins a coplanar overlap).
StageKey meshKey(const MeshOptions& options, const Scene& scene);
StageKey factorsKey(const FormFactorOptions& options, const PatchMesh& mesh);
/// The part of a key that the method used depends on: `auto` has the options of all methods.
/// Method: a word of kFactorsFromNames.
StageKey usedKey(const StageKey& factors_key, std::string_view method);
/// `factors_key`: a key that usedKey() returned; so, too, below.
StageKey solutionKey(const SolveOptions& options, const PatchMaterials& materials,
                     const StageKey& factors_key);

/// `solution_key`: that of the solution that the elements refine.
StageKey elementsKey(const ElementOptions& options, const std::string& solution_key);

StageKey gatherKey(const GatherOptions& options, const PatchMaterials& materials,
                   const PatchMesh& mesh);

StageKey heatKey(const HeatOptions& options, const HeatConditions& conditions,
                 const StageKey& factors_key);

/// Of `materials` only the reflectance is in the key; `sources` have the emission.
StageKey basisKey(const SolveOptions& options, const PatchMaterials& materials,
                  std::span<const LightSource> sources, const StageKey& factors_key);

/// What keys say of the inputs of stages: "materials", "reflectance", "sky"; of a key that
/// usedKey() returned, "factors"; of that of a solution, "solution".
std::string materialsHash(const PatchMaterials& materials);
std::string reflectanceHash(const PatchMaterials& materials);
std::string skyText(const std::vector<double>& sky);
std::string keyHash(const std::string& key);

/// The options in a key; defaults for those that it does not have.
template <class Options>
Options optionsOf(const StageKey& key) {
  return optionsIn<Options>(key.text());
}
/// With `sources_only`.
template <>
FormFactorOptions optionsOf(const StageKey& key);

}  // namespace radiosity
