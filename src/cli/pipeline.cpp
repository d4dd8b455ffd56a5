#include "cli/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/input_file.h"
#include "cli/light_cure.h"
#include "cli/option_names.h"
#include "cli/process_memory.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/version.h"

namespace radiosity::cli {

namespace {

/// Who waits longer is told what would shorten it.
constexpr double kLongWait = 60;
/// Red, green and blue: all that scene files say.
constexpr int kSceneBands = 3;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What shortens a wait, and to what, as far as that is known.
std::string cures(const FormFactorPlan& plan, const FormFactorOptions& options) {
  constexpr double kLoosest = 0.1;
  if (plan.method == FormFactorMethod::hemicube) {
    return "for less: fewer --patches, a lower --resolution";
  }
  std::string text = "for less:";
  const double looser = std::min(kLoosest, 10 * options.tolerance);
  if (looser > options.tolerance) {
    const double left = plan.seconds * (1 - plan.refining * (1 - options.tolerance / looser));
    text += fmt::format(" --tolerance {} (about {}),", numberText(looser), durationText(left));
  }
  return text + fmt::format(" fewer --patches, --method hemicube (about {}; less accurate)",
                            durationText(plan.hemicube_seconds));
}

/// The input was good: what a later stage refuses then is no fault of it. Exit code 1, not 2.
template <class Stage>
auto computedStage(const char* name, const Stage& compute) {
  try {
    return compute();
  } catch (const InputError& error) {
    throw RunError(
        fmt::format("{} failed on a scene that was read without a fault: {}", name, error.what()));
  }
}

}  // namespace

Pipeline::Pipeline(const Request& request, Report& report, Progress& progress)
    : request_(request), report_(report), progress_(progress) {
  results_.version = RADIOSITY_VERSION;
}

void Pipeline::open(const std::string& results_output) {
  requireFile(request_.input);
  request_.scene.validate();
  writes_results_ = !results_output.empty();
  from_results_ = isResultsFile(request_.input);
  if (from_results_) {
    openResults();
  } else {
    openScene(results_output);
  }
  chooseOptions();
  progress_.check();
}

void Pipeline::chooseOptions() {
  if (from_results_) {
    mesh_options_ = meshOptionsOf(StageKey(previous_.mesh_key));
    factor_options_ = factorOptionsOf(StageKey(previous_.factors_key));
    solve_options_ = solveOptionsOf(StageKey(previous_.solution_key));
    gather_options_ = gatherOptionsOf(StageKey(previous_.gather_key));
  }
  mesh_options_ = request_.apply(mesh_options_);
  factor_options_ = request_.apply(factor_options_);
  solve_options_ = request_.apply(solve_options_);
  gather_options_ = request_.apply(gather_options_);
}

void Pipeline::openSource(const std::string& path) {
  source_ = path;
  source_state_ = fileState(path);
  previous_ = readResults(path, false);
}

void Pipeline::openResults() {
  if (!request_.reading_options.empty()) {
    throw InputError(fmt::format(
        "{}: {} says how a scene file is read, and this is a results file; give the scene file",
        request_.input, request_.reading_options.front()));
  }
  openSource(request_.input);
  if (!previous_.scene) {
    throw InputError(request_.input + ": holds no scene; make it anew from the scene file");
  }
  results_.scene = std::move(previous_.scene);
  summarizeScene(report_, scene(), request_.input);
  if (!request_.overridesScene()) return;
  if (bands() != kSceneBands) {
    throw InputError(fmt::format(
        "{}: holds materials of {} bands, which options that change the scene's colours do not "
        "reach; leave those out and change reflectance, emission and sky in /solution",
        request_.input, bands()));
  }
  std::vector<Note>& notes = made(results_.scene).notes;
  const std::size_t known = notes.size();
  applyOverrides(made(results_.scene), request_.scene);
  changed_ = true;
  report_.notes(std::span(notes).subspan(std::min(known, notes.size())));
}

void Pipeline::openScene(const std::string& results_output) {
  progress_.begin("reading", 1);
  results_.scene = loadScene(request_.input, request_.scene);
  progress_.end();
  changed_ = true;
  summarizeScene(report_, scene(), request_.input);
  if (request_.command != Command::info) report_.notes(scene().notes);  // they stand at its end
  std::error_code ignored;
  if (results_output.empty() || !std::filesystem::exists(results_output, ignored)) return;
  try {
    if (isResultsFile(results_output)) openSource(results_output);
  } catch (const InputError& error) {
    // It is about to be replaced anyway: no stages to reuse, and no reason to fail.
    report_.line("note", fmt::format("nothing is reused from {}: {}", results_output,
                                     oneLine(error.what())));
    previous_ = Results();
  }
}

void Pipeline::requireLight() const {
  if (bands() != kSceneBands) return;  // the solver says where all is dark
  if (scene().sky != Vec3(0.0)) return;
  for (const Surface& surface : scene().surfaces) {
    if (scene().materials[surface.material].emission != Vec3(0.0)) return;
  }
  throw InputError(
      fmt::format("{}: nothing in the scene emits light, so the picture would be black; {}",
                  request_.input, lightCure(request_, scene())));
}

/// Why a stage has to be computed although the source may hold one.
std::string Pipeline::why(const std::string& stored_key, const StageKey& key, bool present) const {
  if (!present) return {};
  const std::string difference = StageKey::difference(StageKey(stored_key), key);
  return difference.empty() ? "its key is not readable" : difference;
}

void Pipeline::computed(const std::string& stage, const std::string& label,
                        const std::string& reason, double seconds) {
  changed_ = true;
  report_.stage(stage, label, reason.empty() ? "computed" : "recomputed", reason, seconds);
  progress_.check();
}

void Pipeline::mesh() {
  const StageKey key = meshKey(mesh_options_, scene());
  const bool own = request_.command == Command::mesh;
  mesh_reused_ = previous_.mesh && previous_.mesh_key == key.text();
  replaces_ = previous_.factors || (previous_.mesh && !mesh_reused_);
  if (bands() != kSceneBands) takeOwnMaterials();
  if (mesh_reused_) {
    results_.mesh = std::move(previous_.mesh);
    report_.stage("mesh", "mesh", "reused", source_);
    summarizeMesh(report_, made(results_.mesh), own ? Detail::full : Detail::none);
  } else {
    const std::string reason = why(previous_.mesh_key, key, previous_.mesh.has_value());
    const Stopwatch watch;
    results_.mesh = meshScene(scene(), mesh_options_, progress_);
    computed("mesh", "mesh", reason, watch.seconds());
    summarizeMesh(report_, made(results_.mesh), own ? Detail::full : Detail::brief);
  }
  results_.mesh_key = key.text();
  previous_.mesh.reset();
}

void Pipeline::announceFactors(const FormFactorPlan& plan) {
  const FormFactorOptions& options = factor_options_;
  const bool exact = plan.method == FormFactorMethod::exact;
  // On disk every entry has a column number of 4 bytes. In memory a dense row has none, and a
  // symmetric matrix has half of the entries.
  const std::size_t value = options.storedPrecision() == Precision::real ? 8 : 4;
  const std::size_t disk = plan.matrix_bytes * (exact ? 2 : 1) * (value + 4) / value;
  const std::string what =
      exact ? fmt::format("exact between {} to {}", plural(patches().size(), "patch", "patches"),
                          numberText(options.tolerance))
            : fmt::format("{} of {} pixels", plural(patches().size(), "hemicube", "hemicubes"),
                          options.resolution);
  report_.line("form factors",
               fmt::format("{}: about {}, memory about {}{}", what, durationText(plan.seconds),
                           bytesText(plan.bytes),
                           writes_results_ ? ", disk at most about " + bytesText(disk) : ""));
  if (!plan.reason.empty()) report_.line("", "method: " + plan.reason);
  if (plan.seconds > kLongWait) report_.line("", cures(plan, options));
}

bool Pipeline::factorsFit(const StageKey& key, std::optional<FormFactorPlan>& plan) const {
  if (!previous_.factors) return false;
  if (previous_.factors_key == key.text()) return true;
  const std::string& method = previous_.factors->method;
  const StageKey stored = usedKey(StageKey(previous_.factors_key), method);
  if (stored.text() != usedKey(key, method).text()) return false;
  const FormFactorMethod made_by =
      named(kMethodNames, method).value_or(FormFactorMethod::automatic);
  if (factor_options_.method != FormFactorMethod::automatic) {
    return factor_options_.method == made_by;
  }
  // Once they are there, exact ones are better whatever would be picked.
  if (made_by == FormFactorMethod::exact) return true;
  plan = planFactors();
  return plan->method == made_by;
}

FormFactorPlan Pipeline::planFactors() const {
  FormFactorOptions options = factor_options_;
  options.memory_held = residentBytes();
  FormFactorPlan plan = planFormFactors(patches(), options, progress_);
  // Planning may have tried the exact method, which takes more than hemicubes then do.
  plan.bytes = std::max(plan.bytes, peakBytes());
  return plan;
}

void Pipeline::factors() {
  const StageKey key = factorsKey(factor_options_, patches());
  const bool own = request_.command == Command::factors;
  std::optional<FormFactorPlan> plan;
  if (factorsFit(key, plan)) {
    results_.factors = std::move(previous_.factors);
    results_.factors_key = previous_.factors_key;
    matrix_loaded_ = false;
    report_.stage("form_factors", "form factors", "reused", source_);
    summarizeFactors(report_, formFactors(), patches(), own ? Detail::full : Detail::none);
  } else {
    const std::string reason = why(previous_.factors_key, key, previous_.factors.has_value());
    const Stopwatch watch;
    results_.factors = computedStage("form factors", [&] {
      if (!plan) plan = planFactors();
      announceFactors(*plan);
      FormFactors factors = computeFormFactors(*plan, progress_);
      factors.report.estimated_bytes = plan->bytes;
      return factors;
    });
    results_.factors_key = key.text();
    matrix_loaded_ = true;
    factors_computed_ = true;
    computed("form_factors", "form factors", reason, watch.seconds());
    summarizeFactors(report_, formFactors(), patches(), own ? Detail::full : Detail::brief);
  }
  previous_.factors.reset();
}

StageKey Pipeline::usedFactorsKey() const {
  if (!results_.factors) return {};
  return usedKey(StageKey(results_.factors_key), results_.factors->method);
}

void Pipeline::loadMatrix() {
  if (matrix_loaded_ || !results_.factors) return;
  const std::size_t bytes = results_.factors->report.matrix_bytes;
  if (!request_.memory_limit.empty() &&
      bytes > parseBytes("--memory-limit", request_.memory_limit)) {
    throw RunError(fmt::format("{}: its form factors take {} of memory, --memory-limit allows {}",
                               source_, bytesText(bytes), request_.memory_limit));
  }
  std::optional<FormFactors> factors = std::move(readResults(source_, true).factors);
  // Another run may have replaced the file since: its matrix belongs to another mesh.
  if (!factors || fileState(source_) != source_state_) {
    throw RunError(source_ + ": was replaced by another run meanwhile; run this one again");
  }
  results_.factors = std::move(factors);
  matrix_loaded_ = true;
  progress_.check();
}

int Pipeline::bands() const {
  if (results_.materials) return results_.materials->bands;
  return from_results_ && previous_.materials ? previous_.materials->bands : kSceneBands;
}

void Pipeline::takeOwnMaterials() {
  if (!mesh_reused_) {
    throw InputError(
        fmt::format("{}: holds materials of {} bands for each patch of its mesh, and the options "
                    "given ask for another mesh; leave them out, or make the materials anew",
                    request_.input, bands()));
  }
  results_.materials = std::move(previous_.materials);
  previous_.materials.reset();
}

const PatchMaterials& Pipeline::materials() {
  if (!results_.materials) results_.materials = patchMaterials(scene(), patches());
  return made(results_.materials);
}

void Pipeline::solution() {
  const StageKey key = solutionKey(solve_options_, materials(), usedFactorsKey());
  const bool own = request_.command == Command::solve;
  if (previous_.solution && previous_.solution_key == key.text()) {
    results_.solution = std::move(previous_.solution);
    report_.stage("solution", "solution", "reused", source_);
  } else {
    const std::string reason = why(previous_.solution_key, key, previous_.solution.has_value());
    loadMatrix();
    const Stopwatch watch;
    results_.solution = computedStage("solution", [&] {
      return solve(formFactors(), materials(), patches(), solve_options_, progress_);
    });
    computed("solution", "solution", reason, watch.seconds());
  }
  results_.solution_key = key.text();
  previous_.solution.reset();
  summarizeSolution(report_, solved(), formFactors(), patches(), solve_options_,
                    own ? Detail::full : Detail::brief);
}

void Pipeline::gathered() {
  const StageKey key = gatherKey(gather_options_, materials(), patches());
  const bool own = request_.command == Command::gather;
  if (previous_.gathered && previous_.gather_key == key.text()) {
    results_.gathered = std::move(previous_.gathered);
    report_.stage("gather", "gather", "reused", source_);
  } else {
    const std::string reason = why(previous_.gather_key, key, previous_.gathered.has_value());
    const Stopwatch watch;
    results_.gathered = computedStage(
        "gathering", [&] { return gather(patches(), materials(), gather_options_, progress_); });
    computed("gather", "gather", reason, watch.seconds());
  }
  results_.gather_key = key.text();
  previous_.gathered.reset();
  summarizeGathered(report_, gatheredLight(), patches(), gather_options_,
                    own ? Detail::full : Detail::brief);
}

bool Pipeline::keepFactors() {
  if (results_.factors || !previous_.factors) return false;
  const StageKey key = factorsKey(factorOptionsOf(StageKey(previous_.factors_key)), patches());
  if (key.text() != previous_.factors_key) {
    report_.stage("form_factors", "form factors", "dropped", why(previous_.factors_key, key, true));
    return true;
  }
  results_.factors = std::move(previous_.factors);
  results_.factors_key = previous_.factors_key;
  report_.stage("form_factors", "form factors", "kept", "they still fit");
  return false;
}

bool Pipeline::keepSolution() {
  if (results_.solution || !previous_.solution) return false;
  const StageKey key =
      solutionKey(solveOptionsOf(StageKey(previous_.solution_key)), materials(), usedFactorsKey());
  if (!results_.factors || key.text() != previous_.solution_key) {
    report_.stage("solution", "solution", "dropped", why(previous_.solution_key, key, true));
    return true;
  }
  results_.solution = std::move(previous_.solution);
  results_.solution_key = previous_.solution_key;
  report_.stage("solution", "solution", "kept", "it still fits");
  return false;
}

bool Pipeline::keepGathered() {
  if (results_.gathered || !previous_.gathered) return false;
  const StageKey key =
      gatherKey(gatherOptionsOf(StageKey(previous_.gather_key)), materials(), patches());
  if (key.text() != previous_.gather_key) {
    report_.stage("gather", "gather", "dropped", why(previous_.gather_key, key, true));
    return true;
  }
  results_.gathered = std::move(previous_.gathered);
  results_.gather_key = previous_.gather_key;
  report_.stage("gather", "gather", "kept", "it still fits");
  return false;
}

bool Pipeline::onlyAdds() const {
  return from_results_ && !request_.overridesScene() && !replaces_;
}

void Pipeline::save(const std::string& path) {
  // What was gathered on the same mesh stays: its key says what it was made of.
  const bool lend = mesh_reused_ && previous_.gathered && !results_.gathered;
  if (lend) {
    results_.gathered = std::move(previous_.gathered);
    results_.gather_key = previous_.gather_key;
  }
  writeResults(path, results_, progress_);
  if (lend) previous_.gathered = std::exchange(results_.gathered, std::nullopt);
  saved_ = path;
  changed_ = lend;
}

void Pipeline::keepLaterStages() {
  // In this order: a solution stands on its form factors.
  bool dropped = keepFactors();
  dropped = keepSolution() || dropped;
  dropped = keepGathered() || dropped;
  const bool of_scene = bands() == kSceneBands;
  if (of_scene && !results_.solution && !results_.gathered) results_.materials.reset();
  changed_ = changed_ || dropped;
}

}  // namespace radiosity::cli
