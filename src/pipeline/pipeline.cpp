// Reads stages from a results file, keeps those that still fit, and writes all back.
#include "radiosity/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/figure_text.h"
#include "base/file_name.h"
#include "base/input_file.h"
#include "base/made.h"
#include "base/option_list.h"
#include "base/parallel.h"
#include "base/process_memory.h"
#include "base/processes.h"
#include "formfactor/row_memory.h"
#include "formfactor/shared_factors.h"
#include "matrix/shared_rows.h"
#include "matrix/working_memory.h"
#include "pipeline/journal_file.h"
#include "pipeline/shared_journal.h"
#include "pipeline/stage_key.h"
#include "pipeline/stages/get_or_make.h"
#include "radiosity/names.h"
#include "radiosity/spelling.h"
#include "radiosity/version.h"
#include "results/matrix_blocks.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Red, green and blue: scene files have no other bands.
constexpr int kSceneBands = 3;

/// The first option given that applies only to scene files; empty if there is none.
std::string readingOption(const SceneOptions& given) {
  for (const Option& option : changedOptions(given)) {
    if (option.line.in_key != InKey::never) return option.line.name;
  }
  return {};
}

/// Judges by the name alone; the reader reports a file with other contents.
bool isNamedAsResults(const std::string& path) { return lowerExtension(path) == ".h5"; }

bool areAny(const SceneOverrides& overrides) {
  return !changedOptions(overrides).empty() || !overrides.lights.empty();
}

}  // namespace

Pipeline::Pipeline(Progress& progress, PipelineObserver* observer)
    : progress_(progress), observer_(observer != nullptr ? *observer : silent_) {
  results_.version = RADIOSITY_VERSION;
}

Pipeline::~Pipeline() = default;

const Scene& Pipeline::scene() const { return made(results_.scene); }

void Pipeline::open(const std::string& path, const SceneOptions& scene, const std::string& reuse) {
  requireFile(path);
  scene.validate();
  name_ = path;
  if (isResultsFile(path) || isNamedAsResults(path)) {
    openResults(path, scene);
  } else {
    progress_.begin("reading", 1);
    results_.scene = loadScene(path, scene);
    progress_.end();
    openReused(reuse);
  }
  progress_.check();
}

void Pipeline::open(Scene scene, const std::string& reuse) {
  validate(scene);
  name_ = scene.file.empty() ? "the scene" : scene.file;
  results_.scene = std::move(scene);
  openReused(reuse);
}

/// Reads the stages of `path`, all but the matrix, and remembers the state of the file.
void Pipeline::openSource(const std::string& path) {
  source_state_ = fileState(path);
  stored_ = readResults(path, false);
  source_ = path;
  on_disk_ = {path, source_state_, false};
}

void Pipeline::openResults(const std::string& path, const SceneOptions& scene) {
  const std::string option = readingOption(scene);
  if (!option.empty()) {
    throw InputError(fmt::format(
        "{}: {} says how a scene file is read, and this is a results file; give the scene file",
        path, spelled(option)));
  }
  openSource(path);
  if (!stored_.scene) {
    throw InputError(path + ": holds no scene; make it anew from the scene file");
  }
  results_.scene = std::exchange(stored_.scene, std::nullopt);
  from_results_ = true;
  on_disk_.same_scene = true;
  options_ = {optionsOf<MeshOptions>(StageKey(stored_.mesh.key)),
              optionsOf<FormFactorOptions>(StageKey(stored_.factors.key)),
              optionsOf<SolveOptions>(StageKey(stored_.solution.key)),
              optionsOf<GatherOptions>(StageKey(stored_.gathered.key)),
              optionsOf<ElementOptions>(StageKey(stored_.elements.key)),
              optionsOf<HeatOptions>(StageKey(stored_.heat.key)),
              {},
              options_.journal,
              {}};
  observer_.opened(*this);
  if (areAny(scene)) overrideScene(scene);
}

void Pipeline::overrideScene(const SceneOverrides& overrides) {
  if (hasOwnMaterials()) {
    throw InputError(fmt::format(
        "{}: holds materials of {} bands, which options that change the scene's colours do not "
        "reach; leave those out and change reflectance, emission and sky in /solution",
        name_, bands()));
  }
  std::vector<Note>& notes = made(results_.scene).notes;
  const std::size_t known = notes.size();
  applyOverrides(made(results_.scene), overrides);
  overridden_ = true;
  on_disk_.same_scene = false;
  changed_ = true;
  observer_.notes(*this, std::span(notes).subspan(std::min(known, notes.size())));
}

void Pipeline::openReused(const std::string& path) {
  changed_ = true;
  observer_.opened(*this);
  observer_.notes(*this, scene().notes);
  std::error_code ignored;
  if (path.empty() || !std::filesystem::exists(path, ignored)) return;
  try {
    if (isResultsFile(path)) openSource(path);
  } catch (const InputError& error) {
    // It is about to be replaced anyway: no stages to reuse, and no reason to fail.
    observer_.notReused(path, error.what());
  }
}

int Pipeline::bands() const {
  if (results_.materials) return results_.materials->bands;
  return from_results_ && stored_.materials ? stored_.materials->bands : kSceneBands;
}

/// Whether the materials are those of the results file, since their bands are not those of a scene.
bool Pipeline::hasOwnMaterials() const { return bands() != kSceneBands; }

/// The file's own materials belong to its mesh alone. `reused`: whether that mesh is reused.
void Pipeline::requireOwnMesh(bool reused) const {
  if (reused || !hasOwnMaterials()) return;
  throw InputError(
      fmt::format("{}: holds materials of {} bands for each patch of its mesh, and the options "
                  "given ask for another mesh; leave them out, or make the materials anew",
                  name_, bands()));
}

void Pipeline::requireLight(const std::function<std::string()>& cure) const {
  if (hasOwnMaterials()) return;
  if (anyShines(scene().lights)) return;
  for (const Surface& surface : scene().surfaces) {
    if (scene().materials[surface.material].emission != Vec3(0.0)) return;
  }
  throw InputError(fmt::format(
      "{}: nothing in the scene emits light, so the picture would be black; {}", name_,
      cure ? cure()
           : fmt::format("make something a lamp, {} (W/m^2/sr), or let the sky shine in, {}",
                         spelled("set", likelyLamp(scene()) + ".radiance=10"),
                         spelled("sky", "1"))));
}

bool Pipeline::isUpToDate(const std::string& path) const {
  return !changed_ && (path == source_ || path == saved_);
}

/// Scratch memory for the stored matrix; null if the matrix fits into memory.
std::shared_ptr<ScratchMemory> Pipeline::memoryOfStoredMatrix() const {
  const FormFactorOptions& options = options_.factors;
  const std::size_t n = made(results_.factors).fronts.size();
  const std::size_t bytes = made(results_.factors).report.matrix_bytes;
  const std::size_t beside = residentBytes() + matrixWorkingMemory(n, allowedThreads());
  const RowMemory memory = planRowMemory(beside + bytes, beside, bytes, options);
  if (options.memory_limit > 0 && memory.bytes > options.memory_limit) {
    throw RunError(fmt::format(
        "{}: its form factors, {}, take {} of memory together with all else, {} allows {}", source_,
        bytesText(bytes), bytesText(memory.bytes), spelled("memory_limit"),
        bytesText(options.memory_limit)));
  }
  return makeRowMemory(memory, options, n);
}

/// Each process reads a share of the rows. Process 0 keeps the rest of its form factors.
void Pipeline::shareStoredMatrix() {
  SharedTask task = SharedTask::stored_matrix;
  processes_->broadcastValue(task);
  const SharedStep step(*processes_);
  std::vector<char> path(source_.begin(), source_.end());
  processes_->broadcastArray(path);
  made(results_.factors).matrix = std::make_shared<SharedRows>(
      *processes_, readMatrixPart(source_, {0, std::size_t(processes_->size())}),
      [this] { progress_.check(); });
}

/// Computes this process's share of the form factors.
std::shared_ptr<const ExchangeMatrix> Pipeline::shareRows(Processes& processes) {
  FirstJournal first;
  first.broadcast(processes);
  const std::unique_ptr<JournalFile> file = first.open(processes.rank());
  std::unique_ptr<SharedJournal> journal;
  if (file) journal = std::make_unique<SharedJournal>(*file, first.path, first.resume);
  return shareFormFactors(mesh().mesh, processes, progress_, journal.get());
}

void Pipeline::serve(Processes& processes, SharedTask task) {
  if (task == SharedTask::mesh) {
    mesh();
    return;
  }
  if (task == SharedTask::form_factors) {
    // Rows that are cut are all in process 0.
    if (const auto own = shareRows(processes)) serveRows(processes, *own, makeMatrixBlockWriter);
    return;
  }
  std::vector<char> path;
  processes.broadcastArray(path);
  const MatrixPart part{std::size_t(processes.rank()), std::size_t(processes.size())};
  serveRows(processes, *readMatrixPart({path.begin(), path.end()}, part), makeMatrixBlockWriter);
}

void Pipeline::loadMatrix() {
  if (!results_.factors || results_.factors->matrix) return;
  if (processes_ != nullptr && traitsOf(results_.factors->method).stores_pairs) {
    shareStoredMatrix();
    return;
  }
  Keyed<FormFactors> factors = readResults(source_, true, memoryOfStoredMatrix()).factors;
  // Another run may have replaced the file since: its matrix belongs to another mesh.
  if (!factors || fileState(source_) != source_state_) {
    throw RunError(source_ + ": was replaced by another run meanwhile; run this one again");
  }
  results_.factors.value = std::move(factors.value);
  progress_.check();
}

void Pipeline::dropEmptySolution() {
  if (!results_.solution || !results_.solution->radiosity.empty()) return;
  results_.solution = {};
}

void Pipeline::keepLaterStages() {
  if (!results_.mesh) mesh();
  dropEmptySolution();
  // What a stage is made from comes before it.
  forEachStage([this](const auto& stage) {
    auto& stored = stored_.*stage.value;
    if (results_.*stage.value || !stored) return;
    const std::string changed = changedInputs(StageKey(stored.key));
    if (changed.empty()) {
      takeStored(stage, StageAction::kept);
      return;
    }
    stored.value.reset();
    changed_ = true;
    tell(stage.stage, StageAction::dropped, changed);
  });
  const bool needed = results_.solution || results_.gathered || hasOwnMaterials();
  if (!needed) results_.materials.reset();
}

bool Pipeline::update(const std::string& path) {
  keepLaterStages();
  if (path != on_disk_.path || fileState(path) != on_disk_.state) return false;
  if (!updateResults(path, results_, on_disk_.same_scene)) return false;
  wrote(path);
  // The file still has the form factors that we read from it.
  if (path == source_) source_state_ = on_disk_.state;
  return true;
}

void Pipeline::save(const std::string& path) {
  if (update(path)) return;
  loadMatrix();
  writeResults(path, results_, progress_);
  wrote(path);
}

void Pipeline::wrote(const std::string& path) {
  on_disk_ = {path, fileState(path), true};
  discardKeptRows();
  saved_ = path;
  changed_ = false;
}

void Pipeline::checkpoint(const std::string& path) {
  dropEmptySolution();
  loadMatrix();
  // Gathered light on the same mesh stays in the file: its key says whether it still fits.
  const bool lend = mesh_reused_ && stored_.gathered && !results_.gathered;
  if (lend) std::swap(results_.gathered, stored_.gathered);
  writeResults(path, results_, progress_);
  if (lend) std::swap(results_.gathered, stored_.gathered);
  wrote(path);
  changed_ = lend;
}

}  // namespace radiosity
