// One object from a scene to patches, form factors and light. Each stage is made on request, unless
// a results file has it already. The command line is built on it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/elements.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/light_basis.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"
#include "radiosity/results.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace [[gnu::visibility("default")]] radiosity {

class JournalFile;
class Pipeline;
class StageKey;
// Internal: for the program under mpirun (base/processes.h is not installed).
class Processes;
enum class SharedTask : std::uint32_t;

enum class StageAction {
  reused,      ///< taken from a results file
  computed,    ///< there was none
  recomputed,  ///< there was one that does not fit
  kept,        ///< not asked for; the results file has it and it still fits
  dropped      ///< not asked for; the results file has one, which no longer fits
};

/// A stage that was reused, made, kept or dropped.
struct StageEvent {
  Stage stage = Stage::mesh;
  StageAction action = StageAction::computed;
  /// Reused: the file it comes from. Recomputed and dropped: the reason, "resolution 256 -> 512".
  std::string detail;
  std::optional<double> seconds;  ///< by the clock; computed and recomputed
};

/// Receives the events of a pipeline. All calls come from the thread that called the pipeline,
/// after the event; an exception that a call throws ends the step.
class PipelineObserver {
 public:
  virtual ~PipelineObserver() = default;
  /// The scene is loaded; overrides of one from a results file are applied after this.
  virtual void opened(const Pipeline& /*pipeline*/) {}
  /// Notes on the scene; for one from a results file, the changes made by overrides.
  virtual void notes(const Pipeline& /*pipeline*/, std::span<const Note> /*notes*/) {}
  /// The results file `path`, whose stages were to be reused, cannot be read, for the reason `why`.
  virtual void notReused(const std::string& /*path*/, const std::string& /*why*/) {}
  /// Form factors are about to be computed by this plan.
  virtual void planned(const Pipeline& /*pipeline*/, const FormFactorPlan& /*plan*/) {}
  /// Rows of form factors are kept in the file `path` as they are computed, until they are in a
  /// results file. If the run ends early, the next one continues from there.
  virtual void keepsRows(const Pipeline& /*pipeline*/, const std::string& /*path*/) {}
  /// The fate of kept rows, or why rows are not kept: "resumed: 1,234 of 2,000 rows ...".
  virtual void rows(const Pipeline& /*pipeline*/, const std::string& /*text*/) {}
  virtual void stage(const Pipeline& /*pipeline*/, const StageEvent& /*event*/) {}
};

/// Keeps rows of form factors in a file as they are computed, in case the run is broken off.
struct JournalOptions {
  std::string path;    ///< as a rule beside the file that save() will write; empty: none
  bool resume = true;  ///< false: rows of an earlier run are thrown away, not used
  /// Only if form factors are expected to take this many seconds, or if the file has rows of the
  /// same: less is soon computed again.
  double from_seconds = 10;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "resume",
          .help = "Keep rows in OUT.h5.rows as they are computed, and go on from those that a run "
                  "which was broken off has left; or begin anew (default: resume, and keep rows "
                  "where they are foreseen to take {:g} s; given, always)",
          .figures = {JournalOptions().from_seconds},
          .in_key = InKey::never},
         o.resume);
  }
};

/// The options of every stage.
struct PipelineOptions {
  MeshOptions mesh;
  FormFactorOptions factors;  ///< memory_held 0: the memory that the process holds is taken
  SolveOptions solve;
  GatherOptions gather;
  ElementOptions elements;
  HeatOptions heat;
  HeatConditions heat_conditions;  ///< of the scene's surfaces: readHeatConditions()
  JournalOptions journal;
  /// Of basis(), N * bands of mesh() each. Empty: those of the results file if its light still
  /// fits, else lightSources().
  std::vector<LightSource> sources{};
};

/// A scalar of every patch, to be drawn by renderFalseColour().
enum class Quantity {
  radiosity,       ///< luminance of B, W/m^2; the sum of bands that are not three
  irradiance,      ///< the same of H
  form_factor,     ///< F from one patch to each
  row_sum,         ///< sum of the row of each patch: fronts seen
  temperature,     ///< of heat(), K; NaN if undetermined
  net_flux,        ///< of heat(), W/m^2 given off
  heat_irradiance  ///< of heat(), W/m^2, of all its bands
};
struct ScalarField {
  std::vector<double> values;  ///< N
  FalseColour legend;          ///< title and unit
  bool smooth = true;          ///< may be interpolated; false: surfaces have their own
};

/// Scene -> mesh -> form factors -> solution -> elements; scene -> mesh -> gathered light; and mesh
/// -> form factors -> radiative heat exchange, or light of single lamps.
///
/// mesh(), factors(), solution(), elements(), gathered(), heat() and basis() first make the stages
/// that they need. Each stage has a key, a text of its options and its inputs. A stage with the
/// same key is reused, from this object or else from a results file. Otherwise it is computed, and
/// stages that depend on the one before are discarded. So options() may be changed between calls. A
/// returned reference is valid until the stage is made again.
class Pipeline {
 public:
  /// Both must outlive it. `observer` may be null.
  explicit Pipeline(Progress& progress, PipelineObserver* observer = nullptr);
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;
  ~Pipeline();

  // ---- Opening: one of these comes first, once.

  /// Opens a scene file, or a results file (.h5), whose stages are then reused and whose options
  /// are in options(). `scene`: for a results file the overrides alone (set, materials_file,
  /// one_sided, two_sided, flip, without, lights). `reuse`: with a scene file, the results file
  /// whose stages are reused if they fit the scene and options(), as a rule the one that save()
  /// will write; it need not exist. Errors: InputError if a file cannot be read; with a results
  /// file also if it has no scene, if `scene` has options for reading a scene file (unit), or if
  /// `scene` has overrides and the file has materials of its own (bands()).
  void open(const std::string& path, const SceneOptions& scene = {}, const std::string& reuse = {});
  /// Opens a scene in memory that passes validate(const Scene&); `reuse` as above.
  void open(Scene scene, const std::string& reuse = {});

  /// Call it before the first stage, in process 0 of several (src/base/processes.h), which must
  /// outlive this. All of them compute form factors, and the matrix stays with them. The others
  /// call serve() meanwhile.
  void share(Processes& processes) { processes_ = &processes; }
  /// In the others, after open() with the input of process 0: does a task for process 0 (not
  /// SharedTask::end). Where the task makes rows, serves its requests for these until it is done
  /// with them. Errors: RunError if the mesh is not that of process 0.
  void serve(Processes& processes, SharedTask task);

  // ---- Options: those of the results file's stages, else the defaults. A stage whose options are
  // changed is made again at the next request.

  PipelineOptions& options() { return options_; }
  const PipelineOptions& options() const { return options_; }

  // ---- Stages. Errors: InputError for options out of range and a scene without area; RunError if
  // form factors, solution or gathering fail on a scene that was read without a fault, or if
  // memory_limit is exceeded; Cancelled.

  /// InputError also if the results file has materials of its own (bands()) and options() ask for a
  /// mesh other than theirs.
  const MeshResult& mesh();
  /// Reused form factors come without their matrix, which may be large: matrix() reads it.
  const FormFactors& factors();
  /// The matrix of factors(). RunError if another run has replaced its file.
  const ExchangeOperator& matrix();
  /// The solution, which may not have converged: look at its summary.
  const Solution& solution();
  /// Light at points of all patches, after solution(), which must have values.
  const Elements& elements();
  /// Light by the gather method; it needs the mesh alone.
  const Gathered& gathered();
  /// Radiative heat exchange; it depends on form factors and options() alone. Errors: as
  /// solveHeat().
  const HeatSolution& heat();
  /// Light of options().sources, each by itself. Errors: as solveBasis().
  const LightBasis& basis();
  /// The results file's light of single lamps, with any sources, if it was made with these form
  /// factors and this reflectance; null: there is none that fits.
  const LightBasis* basisAtHand();
  /// Materials of the patches of mesh().
  const PatchMaterials& materials();

  // ---- Light and fields to draw.

  /// Light of solution(), or of gathered() below; solution() must have values. One band is drawn
  /// grey; InputError for two bands, or more than three.
  SurfaceLight solvedLight();
  /// solvedLight() with elements: those of elements() or, if none fit, of the patches `wanted` (as
  /// computeElements()) alone, which are computed at every call and not kept.
  SurfaceLight elementLight(std::span<const std::uint8_t> wanted = {});
  /// solvedLight() with light at points of the patches `wanted`, for gatherRadiance(). Errors: as
  /// computeElements().
  SurfaceLight pointLight(std::span<const std::uint8_t> wanted = {});
  SurfaceLight gatheredLight();
  /// Materials at points of the patches `wanted` (all if empty), where textures or colours of
  /// vertices change them; null if they do not.
  std::shared_ptr<const PointMaterials> pointMaterials(std::span<const std::uint8_t> wanted = {});
  /// `patch`: for Quantity::form_factor, below N.
  ScalarField field(Quantity quantity, std::size_t patch = 0);

  // ---- Contents.

  const Scene& scene() const;
  /// The bands of the materials: three of a scene; or those of the opened results file if it has
  /// materials of its own, a row a patch.
  int bands() const;
  /// Throws InputError if nothing in the scene emits and no sky shines. `cure`: the remedy that the
  /// message gives; none: to name a lamp. Materials of the file's own are not examined: the summary
  /// of solution() or gathered() says if all is dark.
  void requireLight(const std::function<std::string()>& cure = {}) const;
  /// The stages made, reused or kept so far; form factors perhaps without their matrix.
  const Results& results() const { return results_; }
  /// Stages in the results file that have not been asked for yet.
  const Results& stored() const { return stored_; }
  bool fromResultsFile() const { return from_results_; }
  /// True if factors() computed them: they may be expensive, so checkpoint() is worth its time.
  bool factorsComputed() const { return factors_computed_; }
  /// After mesh(): true if the stages so far fill gaps of the opened results file and replace
  /// nothing in it.
  bool onlyAdds() const { return from_results_ && !overridden_ && !replaces_; }
  /// True if results() differs from the file that was opened, or written since.
  bool changed() const { return changed_; }
  /// True if the file `path` holds results() as they are.
  bool isUpToDate(const std::string& path) const;

  // ---- The results file.

  /// Completes results() for a file. Stages of the results file that were not asked for are kept if
  /// they still fit, else dropped. A solution without values (of a singular system) is removed.
  void keepLaterStages();
  /// The scratch memory for a matrix to be read from the file; null: it goes into memory.
  std::shared_ptr<ScratchMemory> memoryOfStoredMatrix() const;
  /// Reads the matrix of form factors that are there without it. Errors: as matrix().
  void loadMatrix();
  /// Completes results() and brings the file `path` up to date without writing the form factors
  /// again. That needs the file that was opened, or written since, still with these form factors;
  /// else it returns false: call save(). Errors: as updateResults().
  bool update(const std::string& path);
  /// Completes results() and writes them, all of them if update() cannot: the file appears whole or
  /// is unchanged. Errors: as writeResults().
  void save(const std::string& path);
  /// Writes the stages so far, before a later step can fail. Light gathered on the same mesh, if
  /// the opened file holds any, stays; nothing is dropped yet.
  void checkpoint(const std::string& path);
  /// Removes the file of JournalOptions if it has rows of these form factors, which are now
  /// written. save() and checkpoint() do so themselves.
  void discardKeptRows();

 private:
  void openResults(const std::string& path, const SceneOptions& scene);
  void openSource(const std::string& path);
  void openReused(const std::string& path);
  void overrideScene(const SceneOverrides& overrides);

  // One way for every stage (pipeline/stages/get_or_make.h).
  template <class T, class Make>
  const T& getOrMake(const StageOf<T>& stage, const StageKey& key, const Make& make);
  template <class T, class Make>
  const T& makeAnew(const StageOf<T>& stage, const StageKey& key, const Make& make);
  template <class T>
  const T& takeStored(const StageOf<T>& stage, StageAction action = StageAction::reused);
  std::string why(const std::string& stored_key, const StageKey& key) const;
  void tell(Stage stage, StageAction action, const std::string& detail) const;
  void computed(Stage stage, const std::string& reason, double seconds);
  void discardFrom(Stage first);
  std::optional<std::string> inputNow(std::string_view name);
  std::string changedInputs(const StageKey& key);

  bool factorsFit(const Keyed<FormFactors>& factors, const StageKey& key,
                  std::optional<FormFactorPlan>& plan) const;
  FormFactorPlan planFactors() const;
  FormFactors computeFactors(std::optional<FormFactorPlan> plan, const StageKey& key);
  std::optional<FormFactorMethod> methodOfKeptRows(const StageKey& key) const;
  void openJournal(const FormFactorPlan& plan, const StageKey& key);
  StageKey usedFactorsKey() const;
  bool hasOwnMaterials() const;
  void shareStoredMatrix();
  std::shared_ptr<const ExchangeMatrix> shareRows(Processes& processes);
  void requireOwnMesh(bool reused) const;
  const PatchMaterials& materialsOfMesh();

  StageKey elementsKeyNow() const;
  Elements elementsOf(std::span<const std::uint8_t> wanted, const StageKey& key);
  void dropEmptySolution();
  void wrote(const std::string& path);

  Processes* processes_ = nullptr;  ///< null: this process alone
  std::unique_ptr<JournalFile> journal_;
  Progress& progress_;
  PipelineObserver silent_;
  PipelineObserver& observer_;
  PipelineOptions options_;
  Results results_;
  Results stored_;      ///< stages taken from it or discarded leave their keys, to say what changed
  std::string name_;    ///< of the scene, for messages
  std::string source_;  ///< the results file that stages come from
  std::string source_state_;  ///< when it was read
  /// The results file that was opened or written last.
  struct {
    std::string path;
    std::string state;        ///< fileState() then
    bool same_scene = false;  ///< it has the current scene
  } on_disk_;
  std::string saved_;          ///< the last file that save() or checkpoint() wrote
  std::string factors_asked_;  ///< the key that the form factors at hand are known to fit
  bool from_results_ = false;
  bool overridden_ = false;
  bool changed_ = false;
  bool mesh_reused_ = false;
  bool factors_computed_ = false;
  bool replaces_ = false;
};

// ---- Keys of stages made without a pipeline, for a results file (Keyed::key). A pipeline that
// opens the file with the same options reuses the stages.

std::string keyOfMesh(const MeshOptions& options, const Scene& scene);
std::string keyOfFactors(const FormFactorOptions& options, const PatchMesh& mesh);
/// `factors_key`, `method`: of the form factors; the word of FormFactors::method in
/// kFactorsFromNames.
std::string keyOfSolution(const SolveOptions& options, const PatchMaterials& materials,
                          const std::string& factors_key, const std::string& method);
std::string keyOfHeat(const HeatOptions& options, const HeatConditions& conditions,
                      const std::string& factors_key, const std::string& method);

}  // namespace radiosity
