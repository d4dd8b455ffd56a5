// Keys: the options that made a stage and hashes of its inputs, as text. A stage is reused only if
// its key is the same.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/option_list.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/names.h"
#include "radiosity/patch_mesh.h"

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

StageKey factorsKey(const FormFactorOptions& options, const PatchMesh& mesh);
/// The part of a key that the method used depends on: `auto` has the options of all methods.
/// Method: a word of kFactorsFromNames.
StageKey usedKey(const StageKey& factors_key, std::string_view method);

/// What keys say of the inputs of stages: "materials", "reflectance", "sky"; of a key that
/// usedKey() returned, "factors"; of that of a solution, "solution".
std::string materialsHash(const PatchMaterials& materials);
std::string reflectanceHash(const PatchMaterials& materials);
std::string lightsText(std::span<const Light> lights);
std::string keyHash(const std::string& key);
/// A switch, as hashes take it.
inline std::string onOff(bool value) { return value ? "on" : "off"; }

/// The options in a key; defaults for those that it does not have.
template <class Options>
Options optionsOf(const StageKey& key) {
  return optionsIn<Options>(key.text());
}
/// With `sources_only`.
template <>
FormFactorOptions optionsOf(const StageKey& key);

}  // namespace radiosity
