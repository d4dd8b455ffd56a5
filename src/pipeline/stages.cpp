// The stages: reused where the key fits, else made.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/made.h"
#include "base/process_memory.h"
#include "base/processes.h"
#include "base/processor_clock.h"
#include "formfactor/shared_factors.h"
#include "pipeline/journal_file.h"
#include "pipeline/shared_journal.h"
#include "pipeline/stage_key.h"
#include "radiosity/names.h"
#include "radiosity/pipeline.h"
#include "solve/linear_solve.h"

namespace radiosity {

namespace {

/// The memory that the process takes besides while it computes and writes: newly called code and
/// thread stacks. (Without it the estimate was 3 to 9 MiB short in 15 of 17 runs.)
constexpr std::size_t kLoadedLater = std::size_t(5) << 20;

/// Turns an InputError of `compute` into a RunError: the scene was read without a fault, so the
/// input is not to blame.
template <class Compute>
auto computedStage(const char* name, const Compute& compute) {
  try {
    return compute();
  } catch (const InputError& error) {
    throw RunError(
        fmt::format("{} failed on a scene that was read without a fault: {}", name, error.what()));
  }
}

/// Moves a stage out of `from`; its key stays there.
template <class Value>
std::optional<Value> taken(std::optional<Value>& from) {
  return std::exchange(from, std::nullopt);
}

}  // namespace

/// The reason why a stored stage has to be computed again; empty if none was stored.
std::string Pipeline::why(const std::string& stored_key, const StageKey& key) const {
  if (stored_key.empty()) return {};
  const std::string difference = StageKey::difference(StageKey(stored_key), key);
  return difference.empty() ? "its key is not readable" : difference;
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

/// Discards a stage and the stages that depend on it. Their keys stay, to say what changed.
void Pipeline::discardFrom(Stage first) {
  const auto discard = [this](auto& stage, std::string& key, std::string& stored_key) {
    if (!stage) return;
    stage.reset();
    stored_key = std::exchange(key, {});
    changed_ = true;
  };
  const bool all = first == Stage::mesh;
  if (all) {
    discard(results_.mesh, results_.mesh_key, stored_.mesh_key);
    results_.materials.reset();
  }
  if (all || first == Stage::form_factors) {
    discard(results_.factors, results_.factors_key, stored_.factors_key);
  }
  if (all || first == Stage::form_factors || first == Stage::heat) {
    discard(results_.heat, results_.heat_key, stored_.heat_key);
  }
  if (all || first == Stage::form_factors || first == Stage::basis) {
    discard(results_.basis, results_.basis_key, stored_.basis_key);
  }
  if (all || first == Stage::gather) {
    discard(results_.gathered, results_.gather_key, stored_.gather_key);
  }
  if (first == Stage::gather || first == Stage::heat || first == Stage::basis) return;
  discard(results_.elements, results_.elements_key, stored_.elements_key);
  if (first != Stage::elements) {
    discard(results_.solution, results_.solution_key, stored_.solution_key);
  }
}

const MeshResult& Pipeline::mesh() {
  options_.mesh.validate();
  const StageKey key = meshKey(options_.mesh, scene());
  if (results_.mesh && results_.mesh_key == key.text()) return made(results_.mesh);
  const bool reused = stored_.mesh && stored_.mesh_key == key.text();
  requireOwnMesh(reused);
  discardFrom(Stage::mesh);
  mesh_reused_ = reused;
  replaces_ = replaces_ || stored_.factors || (stored_.mesh && !mesh_reused_);
  if (mesh_reused_) {
    results_.mesh = taken(stored_.mesh);
    results_.mesh_key = key.text();
    if (hasOwnMaterials()) results_.materials = taken(stored_.materials);
    tell(Stage::mesh, StageAction::reused, source_);
    return made(results_.mesh);
  }
  const std::string reason = why(stored_.mesh_key, key);
  const Stopwatch watch;
  std::optional<SharedStep> step;
  if (processes_ != nullptr) {
    // The others will need the mesh, too: they make it now, not after this process has planned.
    SharedTask task = SharedTask::mesh;
    processes_->broadcastValue(task);
    step.emplace(*processes_);
  }
  results_.mesh = meshScene(scene(), options_.mesh, progress_);
  step.reset();
  results_.mesh_key = key.text();
  stored_.mesh.reset();
  computed(Stage::mesh, reason, watch.seconds());
  return made(results_.mesh);
}

/// Whether form factors are as asked for; options that their method does not use may differ. Sets
/// `plan` if a plan is needed to decide.
bool Pipeline::factorsFit(const FormFactors& factors, const std::string& factors_key,
                          const StageKey& key, std::optional<FormFactorPlan>& plan) const {
  if (factors_key == key.text()) return true;
  const std::string method = nameOf(kFactorsFromNames, factors.method);
  const StageKey made_with = usedKey(StageKey(factors_key), method);
  if (made_with.text() != usedKey(key, method).text()) return false;
  if (options_.factors.method != FormFactorMethod::automatic) {
    return options_.factors.method == factors.method;
  }
  // What is there is as good as all that `auto` might pick.
  if (factors.method == kAutomaticChoices.front()) return true;
  plan = planFactors();
  return plan->method == factors.method;
}

FormFactorPlan Pipeline::planFactors() const {
  FormFactorOptions options = options_.factors;
  returnFreedMemory();
  if (options.memory_held == 0) options.memory_held = residentBytes() + kLoadedLater;
  const PatchMesh& patches = made(results_.mesh).mesh;
  options.exact_rows = emittingUnknowns(
      patches, results_.materials ? *results_.materials : patchMaterials(scene(), patches));
  std::optional<FormFactorMethod> kept = methodOfKeptRows(factorsKey(options, patches));
  const bool only_rays =
      processes_ != nullptr && patches.clusters && options.method == FormFactorMethod::automatic;
  if (only_rays) kept = FormFactorMethod::rays;
  if (kept) options.method = *kept;
  FormFactorPlan plan = planFormFactors(patches, options, progress_);
  if (kept) plan.reason = "rows of an earlier run are there";
  if (only_rays) plan.reason = "processes share them where patches share unknowns";
  // Planning may have tried the exact method, which takes more memory than hemicubes do afterwards.
  plan.bytes = std::max(plan.bytes, peakBytes());
  return plan;
}

FormFactors Pipeline::computeFactors(std::optional<FormFactorPlan> plan, const StageKey& key) {
  if (processes_ != nullptr) requireShareable(made(results_.mesh).mesh, options_.factors);
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
      JournalTold told;
      if (journal_) {
        told = {journal_->path(), journal_->key(), options_.journal.resume};
        shared = std::make_unique<SharedJournal>(*journal_, told.path, told.resume);
      }
      told.broadcast(*processes_);
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
  const std::string asked = key.text();
  if (results_.factors && factors_asked_ == asked) return made(results_.factors);
  std::optional<FormFactorPlan> plan;
  if (results_.factors && factorsFit(*results_.factors, results_.factors_key, key, plan)) {
    factors_asked_ = asked;
    return made(results_.factors);
  }
  discardFrom(Stage::form_factors);
  if (stored_.factors && factorsFit(*stored_.factors, stored_.factors_key, key, plan)) {
    results_.factors = taken(stored_.factors);
    results_.factors_key = stored_.factors_key;
    factors_asked_ = asked;
    discardKeptRows();
    tell(Stage::form_factors, StageAction::reused, source_);
    return made(results_.factors);
  }
  const std::string reason = why(stored_.factors_key, key);
  const Stopwatch watch;
  results_.factors = computeFactors(std::move(plan), key);
  results_.factors_key = asked;
  factors_asked_ = asked;
  stored_.factors.reset();
  factors_computed_ = true;
  computed(Stage::form_factors, reason, watch.seconds());
  return made(results_.factors);
}

const ExchangeMatrix& Pipeline::matrix() {
  factors();
  loadMatrix();
  return made(results_.factors).matrix;
}

StageKey Pipeline::usedFactorsKey() const {
  if (!results_.factors) return {};
  return usedKey(StageKey(results_.factors_key),
                 nameOf(kFactorsFromNames, results_.factors->method));
}

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
  if (results_.solution && results_.solution_key == key.text()) return made(results_.solution);
  discardFrom(Stage::solution);
  if (stored_.solution && stored_.solution_key == key.text()) {
    results_.solution = taken(stored_.solution);
    results_.solution_key = key.text();
    tell(Stage::solution, StageAction::reused, source_);
    return made(results_.solution);
  }
  const std::string reason = why(stored_.solution_key, key);
  loadMatrix();
  requireSolver(options_.solve.solver, made(results_.factors).matrix);
  const Stopwatch watch;
  results_.solution = computedStage("solution", [&] {
    return solve(made(results_.factors), made(results_.materials), made(results_.mesh).mesh,
                 options_.solve, progress_);
  });
  results_.solution_key = key.text();
  stored_.solution.reset();
  computed(Stage::solution, reason, watch.seconds());
  return made(results_.solution);
}

/// The key that elements must have now. Call it after solution().
StageKey Pipeline::elementsKeyNow() const {
  options_.elements.validate();
  return elementsKey(options_.elements, results_.solution_key);
}

/// Computes elements of some patches; they are not kept. If the file has elements, their key does
/// not fit: the observer is told why.
Elements Pipeline::elementsOf(std::span<const std::uint8_t> wanted, const StageKey& key) {
  const Stopwatch watch;
  Elements some =
      computeElements(made(results_.mesh).mesh, made(results_.materials),
                      made(results_.solution).irradiance, options_.elements, wanted, progress_);
  if (!stored_.elements_key.empty()) {
    observer_.stage(*this, {Stage::elements, StageAction::recomputed,
                            why(stored_.elements_key, key), watch.seconds()});
  }
  return some;
}

const Elements& Pipeline::elements() {
  solution();
  const StageKey key = elementsKeyNow();
  if (results_.elements && results_.elements_key == key.text()) return made(results_.elements);
  discardFrom(Stage::elements);
  if (stored_.elements && stored_.elements_key == key.text()) {
    results_.elements = taken(stored_.elements);
    results_.elements_key = key.text();
    tell(Stage::elements, StageAction::reused, source_);
    return made(results_.elements);
  }
  const std::string reason = why(stored_.elements_key, key);
  const Stopwatch watch;
  results_.elements = computedStage("elements", [&] {
    return computeElements(made(results_.mesh).mesh, made(results_.materials),
                           made(results_.solution).irradiance, options_.elements, {}, progress_);
  });
  results_.elements_key = key.text();
  stored_.elements.reset();
  computed(Stage::elements, reason, watch.seconds());
  return made(results_.elements);
}

const Gathered& Pipeline::gathered() {
  const PatchMesh& patches = mesh().mesh;
  options_.gather.validate();
  const StageKey key = gatherKey(options_.gather, materialsOfMesh(), patches);
  if (results_.gathered && results_.gather_key == key.text()) return made(results_.gathered);
  discardFrom(Stage::gather);
  if (stored_.gathered && stored_.gather_key == key.text()) {
    results_.gathered = taken(stored_.gathered);
    results_.gather_key = key.text();
    tell(Stage::gather, StageAction::reused, source_);
    return made(results_.gathered);
  }
  const std::string reason = why(stored_.gather_key, key);
  const Stopwatch watch;
  results_.gathered = computedStage("gathering", [&] {
    return gather(patches, made(results_.materials), options_.gather, progress_);
  });
  results_.gather_key = key.text();
  stored_.gathered.reset();
  computed(Stage::gather, reason, watch.seconds());
  return made(results_.gathered);
}

/// Throws an InputError unchanged: the fault is in the conditions.
const HeatSolution& Pipeline::heat() {
  factors();
  options_.heat.validate();
  const StageKey key = heatKey(options_.heat, options_.heat_conditions, usedFactorsKey());
  if (results_.heat && results_.heat_key == key.text()) return made(results_.heat);
  discardFrom(Stage::heat);
  if (stored_.heat && stored_.heat_key == key.text()) {
    results_.heat = taken(stored_.heat);
    results_.heat_key = key.text();
    tell(Stage::heat, StageAction::reused, source_);
    return made(results_.heat);
  }
  const std::string reason = why(stored_.heat_key, key);
  loadMatrix();
  const Stopwatch watch;
  results_.heat = solveHeat(made(results_.factors), options_.heat_conditions,
                            made(results_.mesh).mesh, options_.heat, progress_);
  results_.heat_key = key.text();
  stored_.heat.reset();
  computed(Stage::heat, reason, watch.seconds());
  return made(results_.heat);
}

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
  if (results_.basis && results_.basis_key == key.text()) return made(results_.basis);
  discardFrom(Stage::basis);
  if (stored_.basis && stored_.basis_key == key.text()) return takeStoredBasis();
  const std::string reason = why(stored_.basis_key, key);
  loadMatrix();
  requireSolver(options_.solve.solver, made(results_.factors).matrix);
  const Stopwatch watch;
  LightBasis light =
      solveBasis(made(results_.factors), materials, patches, sources, options_.solve, progress_);
  if (!light.solution.summary.usable()) {
    throw RunError("light of single lamps: " + light.solution.summary.message);
  }
  results_.basis = std::move(light);
  results_.basis_key = key.text();
  stored_.basis.reset();
  computed(Stage::basis, reason, watch.seconds());
  return made(results_.basis);
}

const LightBasis& Pipeline::takeStoredBasis() {
  results_.basis = taken(stored_.basis);
  results_.basis_key = stored_.basis_key;
  tell(Stage::basis, StageAction::reused, source_);
  return made(results_.basis);
}

const LightBasis* Pipeline::basisAtHand() {
  factors();
  const auto fits = [this](const std::string& key) {
    return isBasisOf(StageKey(key), materialsOfMesh(), usedFactorsKey());
  };
  if (results_.basis && fits(results_.basis_key)) return &made(results_.basis);
  if (!results_.basis && stored_.basis && fits(stored_.basis_key)) return &takeStoredBasis();
  return nullptr;
}

}  // namespace radiosity
