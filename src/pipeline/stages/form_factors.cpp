// Form factors: from the mesh. By which method, a plan decides; earlier runs may have left rows.
#include <algorithm>

#include "base/process_memory.h"
#include "base/processes.h"
#include "formfactor/shared_factors.h"
#include "pipeline/journal_file.h"
#include "pipeline/shared_journal.h"
#include "pipeline/stages/get_or_make.h"
#include "radiosity/names.h"

namespace radiosity {

namespace {

/// The memory that the process takes besides while it computes and writes: newly called code and
/// thread stacks. (Without it the estimate was 3 to 9 MiB short in 15 of 17 runs.)
constexpr std::size_t kLoadedLater = std::size_t(5) << 20;

// The key has every option that the result may depend on, with its value as asked for: on another
// mesh `auto` may pick another method.
StageKey factorsKeyOf(FormFactorOptions options, const std::string& mesh_hash) {
  options.precision = options.storedPrecision();
  StageKey key(keyText(options));
  key.add("mesh", mesh_hash);
  return key;
}

}  // namespace

StageKey factorsKey(const FormFactorOptions& options, const PatchMesh& mesh) {
  return factorsKeyOf(options, geometryHash(mesh));
}

StageKey usedKey(const StageKey& factors_key, std::string_view method) {
  auto options = optionsOf<FormFactorOptions>(factors_key);
  options.method = named(kMethodNames, method).value_or(options.method);
  return factorsKeyOf(options, factors_key.get("mesh").value_or(""));
}

template <>
FormFactorOptions optionsOf(const StageKey& key) {
  auto options = optionsIn<FormFactorOptions>(key.text());
  options.sources_only = key.get("tolerance") == "sources";
  return options;
}

/// Whether form factors are there as asked for; options that their method does not use may differ.
/// Sets `plan` if a plan is needed to decide.
bool Pipeline::factorsFit(const Keyed<FormFactors>& factors, const StageKey& key,
                          std::optional<FormFactorPlan>& plan) const {
  if (!factors) return false;
  if (options_.factors.needs_pairs && !traitsOf(factors->method).stores_pairs) return false;
  if (factors.key == key.text()) return true;
  const std::string method = nameOf(kFactorsFromNames, factors->method);
  const StageKey made_with = usedKey(StageKey(factors.key), method);
  if (made_with.text() != usedKey(key, method).text()) return false;
  if (options_.factors.method != FormFactorMethod::automatic) {
    return options_.factors.method == factors->method;
  }
  // What is there is as good as all that `auto` might pick.
  if (factors->method == kAutomaticChoices.front()) return true;
  plan = planFactors();
  return plan->method == factors->method;
}

FormFactorPlan Pipeline::planFactors() const {
  FormFactorOptions options = options_.factors;
  returnFreedMemory();
  if (options.memory_held == 0) options.memory_held = residentBytes() + kLoadedLater;
  const PatchMesh& patches = made(results_.mesh).mesh;
  options.exact_rows = emittingPatches(
      patches, results_.materials ? *results_.materials : patchMaterials(scene(), patches));
  const std::optional<FormFactorMethod> kept = methodOfKeptRows(factorsKey(options, patches));
  if (kept) options.method = *kept;
  FormFactorPlan plan = planFormFactors(patches, options, progress_);
  if (kept) plan.reason = "rows of an earlier run are there";
  // Planning may have tried the exact method, which takes more memory than hemicubes do afterwards.
  plan.bytes = std::max(plan.bytes, peakBytes());
  return plan;
}

FormFactors Pipeline::computeFactors(std::optional<FormFactorPlan> plan, const StageKey& key) {
  if (processes_ != nullptr) requireShareable(options_.factors);
  return computedStage("form factors", [&] {
    if (!plan) plan = planFactors();
    observer_.planned(*this, *plan);
    openJournal(*plan, key);
    std::optional<SharedStep> step;
    std::unique_ptr<SharedJournal> shared;
    if (processes_ != nullptr) {
      SharedTask task = SharedTask::form_factors;
      processes_->broadcastValue(task);
      step.emplace(*processes_);
      FirstJournal first;
      if (journal_) {
        first = {journal_->path(), journal_->key(), options_.journal.resume};
        shared = std::make_unique<SharedJournal>(*journal_, first.path, first.resume);
      }
      first.broadcast(*processes_);
    }
    RowJournal* const journal = shared ? shared.get() : static_cast<RowJournal*>(journal_.get());
    FormFactors factors = computeFormFactors(*plan, progress_, journal, processes_);
    step.reset();
    if (journal_ && !journal_->failure().empty()) {
      observer_.rows(*this, fmt::format("not all rows were kept: {}: {}", journal_->path(),
                                        journal_->failure()));
    }
    factors.report.estimated_bytes = plan->bytes;
    plan.reset();
    returnFreedMemory();
    return factors;
  });
}

const FormFactors& Pipeline::factors() {
  const PatchMesh& patches = mesh().mesh;
  options_.factors.validate();
  const StageKey key = factorsKey(options_.factors, patches);
  std::optional<FormFactorPlan> plan;
  const bool at_hand =
      (results_.factors && factors_asked_ == key.text()) || factorsFit(results_.factors, key, plan);
  if (!at_hand) discardFrom(Stage::form_factors);
  factors_asked_ = key.text();
  if (at_hand) return made(results_.factors);
  if (factorsFit(stored_.factors, key, plan)) {
    takeStored(kStage<Stage::form_factors>);
    discardKeptRows();
    return made(results_.factors);
  }
  return makeAnew(kStage<Stage::form_factors>, key, [&] {
    FormFactors factors = computeFactors(std::move(plan), key);
    factors_computed_ = true;
    return factors;
  });
}

const ExchangeOperator& Pipeline::matrix() {
  factors();
  loadMatrix();
  return *made(results_.factors).matrix;
}

StageKey Pipeline::usedFactorsKey() const {
  if (!results_.factors) return {};
  return usedKey(StageKey(results_.factors.key),
                 nameOf(kFactorsFromNames, results_.factors->method));
}

std::string keyOfFactors(const FormFactorOptions& options, const PatchMesh& mesh) {
  return factorsKey(options, mesh).text();
}

}  // namespace radiosity
