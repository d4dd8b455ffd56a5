// Keys: a text of the options that made a stage and of what it was made from. A stage is reused
// only where its key is the same.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/light_basis.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace radiosity {

/// "name=value name=value ...": readable in the results file, and options can be had back.
class StageKey {
 public:
  StageKey() = default;
  explicit StageKey(std::string_view text);
  void add(std::string name, std::string value);
  std::optional<std::string> get(std::string_view name) const;
  std::string text() const;
  /// What changed, in words: "resolution 256 -> 512, form factors changed". Empty where nothing
  /// did.
  static std::string difference(const StageKey& before, const StageKey& after);

 private:
  std::vector<std::pair<std::string, std::string>> pairs_;
};

/// `scene` enters with all that meshing looks at: vertices, faces, surfaces with their sides, and
/// which surfaces emit (an emitter wins a coplanar overlap).
StageKey meshKey(const MeshOptions& options, const Scene& scene);
StageKey factorsKey(const FormFactorOptions& options, const PatchMesh& mesh);
/// What of a key of form factors made them, where the method used, "exact" or "hemicube", is known:
/// `auto` was asked for with the options of both.
StageKey usedKey(const StageKey& factors_key, std::string_view method);
/// `factors_key`: as used.
StageKey solutionKey(const SolveOptions& options, const PatchMaterials& materials,
                     const StageKey& factors_key);

/// `solution_key`: of the solution that they refine.
StageKey elementsKey(const ElementOptions& options, const std::string& solution_key);

StageKey gatherKey(const GatherOptions& options, const PatchMaterials& materials,
                   const PatchMesh& mesh);

/// `factors_key`: as used.
StageKey heatKey(const HeatOptions& options, const HeatConditions& conditions,
                 const StageKey& factors_key);
/// Whether heat with that key was exchanged by these form factors, as used.
bool isHeatOf(const StageKey& heat_key, const StageKey& factors_key);

/// `materials`: their reflectance alone counts, what shines is in `sources`.
StageKey basisKey(const SolveOptions& options, const PatchMaterials& materials,
                  std::span<const LightSource> sources, const StageKey& factors_key);
/// Whether light with that key is of these form factors, as used, and this reflectance.
bool isBasisOf(const StageKey& basis_key, const PatchMaterials& materials,
               const StageKey& factors_key);

/// The options in a key; defaults where it says nothing.
MeshOptions meshOptionsOf(const StageKey& key);
FormFactorOptions factorOptionsOf(const StageKey& key);
SolveOptions solveOptionsOf(const StageKey& key);
ElementOptions elementOptionsOf(const StageKey& key);
GatherOptions gatherOptionsOf(const StageKey& key);
HeatOptions heatOptionsOf(const StageKey& key);

}  // namespace radiosity
