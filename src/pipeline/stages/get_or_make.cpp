#include "pipeline/stages/get_or_make.h"

#include <array>

namespace radiosity {

namespace {

constexpr const char* kUnreadable = "its key is not readable";

}  // namespace

/// The reason why a stored stage has to be computed again; empty if none was stored.
std::string Pipeline::why(const std::string& stored_key, const StageKey& key) const {
  if (stored_key.empty()) return {};
  const std::string difference = StageKey::difference(StageKey(stored_key), key);
  return difference.empty() ? kUnreadable : difference;
}

/// What keys say of the input `name` if they are made now. None: it is no input at hand, but an
/// option, or comes with the options.
std::optional<std::string> Pipeline::inputNow(std::string_view name) {
  if (name == "mesh") return geometryHash(made(results_.mesh).mesh);
  if (name == "materials") return materialsHash(materialsOfMesh());
  if (name == "reflectance") return reflectanceHash(materialsOfMesh());
  if (name == "sky") return lightsText(materialsOfMesh().lights);
  if (name == "factors") return keyHash(usedFactorsKey().text());
  if (name == "solution") return keyHash(results_.solution.key);
  return std::nullopt;
}

/// How the inputs have changed since a stage of that key was made; empty: they have not.
std::string Pipeline::changedInputs(const StageKey& key) {
  StageKey before;
  StageKey now;
  for (const auto& [name, value] : key.pairs()) {
    const std::optional<std::string> input = inputNow(name);
    if (!input) continue;
    before.add(name, value);
    now.add(name, *input);
  }
  return now.pairs().empty() ? kUnreadable : StageKey::difference(before, now);
}

void Pipeline::tell(Stage stage, StageAction action, const std::string& detail) const {
  observer_.stage(*this, {stage, action, detail, std::nullopt});
}

void Pipeline::computed(Stage stage, const std::string& reason, double seconds) {
  changed_ = true;
  const StageAction action = reason.empty() ? StageAction::computed : StageAction::recomputed;
  observer_.stage(*this, {stage, action, reason, seconds});
  progress_.check();
}

/// Discards a stage and those that are made from it. Their keys stay, to say what changed.
void Pipeline::discardFrom(Stage first) {
  if (first == Stage::mesh) results_.materials.reset();
  std::array<bool, std::tuple_size_v<decltype(kStages)>> discarded{};
  forEachStage([&](const auto& stage) {
    const bool from_one = stage.from && discarded[std::size_t(*stage.from)];
    if (stage.stage != first && !from_one) return;
    discarded[std::size_t(stage.stage)] = true;
    auto& value = results_.*stage.value;
    if (!value) return;
    (stored_.*stage.value).key = std::move(value.key);
    value = {};
    changed_ = true;
  });
}

}  // namespace radiosity
