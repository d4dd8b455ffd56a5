// From a scene to patches, form factors and light in one object: each stage is made when it is
// asked for, unless a results file has it already. The command line is made of this.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
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
class Processes;
class StageKey;
enum class SharedTask : std::uint32_t;

enum class Stage { mesh, form_factors, solution, gather, elements, heat, basis };

enum class StageAction {
  reused,      ///< taken from a results file
  computed,    ///< there was none
  recomputed,  ///< there was one, which does not fit
  kept,        ///< not asked for; the results file has it and it still fits
  dropped      ///< not asked for; the results file has one, which no longer fits
};

/// A stage that was reused, made, kept or dropped.
struct StageEvent {
  Stage stage = Stage::mesh;
  StageAction action = StageAction::computed;
  /// Reused: the file it comes from. Recomputed and dropped: why, "resolution 256 -> 512".
  std::string detail;
  std::optional<double> seconds;  ///< by the clock; computed and recomputed
};

/// Receives the events of a pipeline. All calls come from the thread that called the pipeline,
/// after the event; an exception that a call throws ends the step.
class PipelineObserver {
 public:
  virtual ~PipelineObserver() = default;
  /// The scene is there; overrides of one from a results file are applied after this.
  virtual void opened(const Pipeline& /*pipeline*/) {}
  /// Notes on the scene; for one from a results file, the changes made by overrides.
  virtual void notes(const Pipeline& /*pipeline*/, std::span<const Note> /*notes*/) {}
  /// The results file `path` was named for its stages and cannot be read, for the reason `why`.
  virtual void notReused(const std::string& /*path*/, const std::string& /*why*/) {}
  /// Form factors are about to be computed like this.
  virtual void planned(const Pipeline& /*pipeline*/, const FormFactorPlan& /*plan*/) {}
  /// Until they are in a results file, rows of form factors are kept in the file `path` as they are
  /// computed: whatever ends the run, the next one goes on from there.
  virtual void keepsRows(const Pipeline& /*pipeline*/, const std::string& /*path*/) {}
  /// What became of rows that were kept, and why rows are not: "resumed: 1,234 of 2,000 rows ...".
  virtual void rows(const Pipeline& /*pipeline*/, const std::string& /*text*/) {}
  virtual void stage(const Pipeline& /*pipeline*/, const StageEvent& /*event*/) {}
};

/// Rows of form factors are kept in a file as they are computed, for a run that is broken off.
struct JournalOptions {
  std::string path;    ///< as a rule beside the file that save() will write; empty: none
  bool resume = true;  ///< false: rows that are there are not used, but thrown away
  /// Only where form factors are foreseen to take so many seconds, or where rows of the same are
  /// there: less is soon computed again.
  double from_seconds = 10;
};

/// The options of every stage.
struct PipelineOptions {
  MeshOptions mesh;
  FormFactorOptions factors;  ///< memory_held 0: what the process holds is taken
  SolveOptions solve;
  GatherOptions gather;
  ElementOptions elements;
  HeatOptions heat;
  HeatConditions heat_conditions;  ///< of the scene's surfaces: readHeatConditions()
  JournalOptions journal;
  /// Of basis(), N * bands of mesh() each. Empty: those of the results file, where its light still
  /// fits; else lightSources().
  std::vector<LightSource> sources{};
};

/// A scalar of every patch, to be drawn by renderFalseColour().
enum class Quantity {
  radiosity,    ///< luminance of B, W/m^2; of bands that are not three their sum
  irradiance,   ///< the same of H
  form_factor,  ///< F from one patch to each; where patches share unknowns, from its cluster to
                ///< the cluster of each
  row_sum       ///< sum of the row of each patch, or of its cluster: fronts seen
};
struct ScalarField {
  std::vector<double> values;  ///< N
  FalseColour legend;          ///< title and unit
};

/// Scene -> mesh -> form factors -> solution -> elements; scene -> mesh -> gathered light; and mesh
/// -> form factors -> radiative heat exchange, or light of single lamps.
///
/// mesh(), factors(), solution(), elements(), gathered(), heat() and basis() first make what they
/// stand on. Each stage has a key, a text of its options and of what it was made from. One with the
/// same key is reused: from this object where it was made before, else from a results file;
/// otherwise it is computed, and what stands on the one before is discarded. So options() may be
/// changed between calls. References that a call returned hold until the stage is made again.
class Pipeline {
 public:
  /// Both must outlive it; no observer: nobody is told.
  explicit Pipeline(Progress& progress, PipelineObserver* observer = nullptr);
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;
  ~Pipeline();

  // ---- One of these comes first, once.

  /// Opens a scene file, or a results file (.h5), whose stages then are reused and whose options
  /// are in options(). `scene`: for a results file the overrides alone (set, materials_file,
  /// one_sided, two_sided, sky). `reuse`: with a scene file, the results file whose stages are
  /// reused where they fit the scene and options(), as a rule the one that save() will write; it
  /// need not be there. Errors: InputError for what cannot be read, for a results file without a
  /// scene, where `scene` says how a scene file is read ("--unit") and `path` is a results file,
  /// and for overrides of one with materials of its own (bands()).
  void open(const std::string& path, const SceneOptions& scene = {}, const std::string& reuse = {});
  /// A scene in memory, as validate(const Scene&) asks; `reuse` as above.
  void open(Scene scene, const std::string& reuse = {});

  /// Before the first stage, in process 0 of several (src/base/processes.h), which must outlive
  /// this: form factors are computed by all of them, and their matrix stays with them. The others
  /// call serve() meanwhile.
  void share(Processes& processes) { processes_ = &processes; }
  /// In the others, after open() with what process 0 opened: does a task that process 0 asks for
  /// (not SharedTask::end), and then what it asks of these rows until it is done with them. Errors:
  /// RunError where the mesh is not process 0's.
  void serve(Processes& processes, SharedTask task);

  // ---- Options: those the results file's stages were made with, elsewhere the defaults. To keep
  // one, leave it; a stage whose options are changed is made again the next time it is asked for.

  PipelineOptions& options() { return options_; }
  const PipelineOptions& options() const { return options_; }

  // ---- Stages. Errors: InputError for options out of range and a scene without area; RunError
  // where form factors, solution or gathering fail on a scene that was read without a fault, where
  // memory_limit is exceeded; Cancelled.

  /// InputError also where the results file has materials of its own (bands()) and options() ask
  /// for another mesh than the one they belong to.
  const MeshResult& mesh();
  /// Reused ones come without their matrix, which may be large: matrix() reads it.
  const FormFactors& factors();
  /// The matrix of factors(). RunError where another run has replaced the file it is in.
  const ExchangeMatrix& matrix();
  /// Not converging is data: look at its summary.
  const Solution& solution();
  /// Light at points after solution(), which must have values; of all patches.
  const Elements& elements();
  /// By the gather method; stands on the mesh alone.
  const Gathered& gathered();
  /// Radiative heat exchange; stands on form factors, and on options() alone beside them. Errors:
  /// as solveHeat().
  const HeatSolution& heat();
  /// Light of options().sources, each by itself. Errors: as solveBasis().
  const LightBasis& basis();
  /// The results file's light of single lamps, made with these form factors and this reflectance,
  /// whatever its sources; null: it has none that fits.
  const LightBasis* basisAtHand();
  /// Materials of the patches of mesh().
  const PatchMaterials& materials();

  // ---- What to draw.

  /// Of solution(), which must have values, and of gathered(). One band is drawn grey; InputError
  /// where there are two, or more than three.
  SurfaceLight solvedLight();
  /// solvedLight() with elements: those of elements(), or, where there are none that fit, of the
  /// patches `wanted` (as computeElements()) alone, which are computed at every call and not kept.
  SurfaceLight elementLight(std::span<const std::uint8_t> wanted = {});
  /// solvedLight() with light at points of the patches `wanted`, for gatherRadiance(). Errors: as
  /// computeElements().
  SurfaceLight pointLight(std::span<const std::uint8_t> wanted = {});
  SurfaceLight gatheredLight();
  /// `patch`: of Quantity::form_factor, below N.
  ScalarField field(Quantity quantity, std::size_t patch = 0);

  // ---- What there is.

  const Scene& scene() const;
  /// Of the materials: three, which the scene says, or what the results file opened says itself
  /// with materials of its own, a row a patch.
  int bands() const;
  /// InputError where nothing in the scene emits and no sky shines. `cure`: what the message says
  /// to do about it; none: to name a lamp. Materials of the file's own are not looked at: the
  /// summary of solution() or gathered() says where all is dark.
  void requireLight(const std::function<std::string()>& cure = {}) const;
  /// The stages made, reused or kept so far; form factors perhaps without their matrix.
  const Results& results() const { return results_; }
  /// Stages in the results file that nobody has asked for yet.
  const Results& stored() const { return stored_; }
  bool fromResultsFile() const { return from_results_; }
  /// Where factors() computed them: they may be dear, so checkpoint() is worth its time.
  bool factorsComputed() const { return factors_computed_; }
  /// After mesh(): true where the stages so far fill gaps of the results file opened and replace
  /// nothing in it.
  bool onlyAdds() const { return from_results_ && !overridden_ && !replaces_; }
  /// Where results() differs from the file opened, or from that written since.
  bool changed() const { return changed_; }
  /// Where the file `path` holds results() as they are.
  bool isUpToDate(const std::string& path) const;

  // ---- The results file.

  /// Completes results() for a file: stages of the results file that nobody asked for are kept
  /// where they still fit, else dropped; a solution without values (of a singular system) is taken
  /// out.
  void keepLaterStages();
  /// Where a matrix that is to be read from the file goes; null: in memory.
  std::shared_ptr<ScratchMemory> memoryOfStoredMatrix() const;
  /// Reads the matrix of form factors that are there without it. Errors: as matrix().
  void loadMatrix();
  /// Completes results() and brings the file `path` up to them without writing the form factors
  /// again: where it is the one opened, or written since, and still has them. False where that
  /// cannot be: save() it. Errors: as updateResults().
  bool update(const std::string& path);
  /// Completes results() and writes them, all of them where update() cannot: the file appears whole
  /// or stays what it was. Errors: as writeResults().
  void save(const std::string& path);
  /// Writes what there is before a later step can fail. Light gathered on the same mesh, which the
  /// opened file may hold, stays; nothing is dropped yet.
  void checkpoint(const std::string& path);
  /// Removes the file of JournalOptions, where there is one for these form factors: they are
  /// written. save() and checkpoint() do so themselves.
  void discardKeptRows();

 private:
  void openResults(const std::string& path, const SceneOptions& scene);
  void openSource(const std::string& path);
  void openReused(const std::string& path);
  void overrideScene(const SceneOptions& overrides);

  std::string why(const std::string& stored_key, const StageKey& key) const;
  void tell(Stage stage, StageAction action, const std::string& detail = {}) const;
  void computed(Stage stage, const std::string& reason, double seconds);
  void discardFrom(Stage first);

  bool factorsFit(const FormFactors& factors, const std::string& factors_key, const StageKey& key,
                  std::optional<FormFactorPlan>& plan) const;
  FormFactorPlan planFactors() const;
  FormFactors computeFactors(std::optional<FormFactorPlan> plan, const StageKey& key);
  std::optional<FormFactorMethod> methodOfKeptRows(const StageKey& key) const;
  void openJournal(const FormFactorPlan& plan, const StageKey& key);
  StageKey usedFactorsKey() const;
  bool hasOwnMaterials() const;
  void shareStoredMatrix();
  ExchangeMatrix shareRows(Processes& processes);
  void requireOwnMesh(bool reused) const;
  const PatchMaterials& materialsOfMesh();

  /// What a results file holds: the one opened or written last.
  struct OnDisk {
    std::string path;
    std::string state;   ///< fileState() then
    bool scene = false;  ///< it has the scene as it is
    /// Empty: none.
    std::string mesh_key, factors_key, solution_key, elements_key, gather_key, heat_key, basis_key;
  };
  static OnDisk onDisk(const std::string& path, const Results& results, bool scene);

  template <class T>
  bool keep(Stage stage, std::optional<T> Results::*value, std::string Results::*value_key,
            bool fits, const std::string& why_not);
  template <class T>
  bool keep(Stage stage, std::optional<T> Results::*value, std::string Results::*value_key,
            const StageKey& key, bool there = true);
  bool keepFactors();
  bool keepSolution();
  StageKey elementsKeyNow() const;
  Elements elementsOf(std::span<const std::uint8_t> wanted, const StageKey& key);
  bool keepElements();
  bool keepGathered();
  bool keepHeat();
  bool keepBasis();
  const LightBasis& takeStoredBasis();
  void dropEmptySolution();

  Processes* processes_ = nullptr;  ///< null: this one alone
  std::unique_ptr<JournalFile> journal_;
  Progress& progress_;
  PipelineObserver silent_;
  PipelineObserver& observer_;
  PipelineOptions options_;
  Results results_;
  Results stored_;  ///< a stage that left it, or was discarded, leaves its key: to say what changed
  std::string name_;          ///< of the scene, for messages
  std::string source_;        ///< the results file that stages come from
  std::string source_state_;  ///< when it was read
  OnDisk on_disk_;
  std::string saved_;          ///< the last file that save() or checkpoint() wrote
  std::string factors_asked_;  ///< the key that the form factors at hand are known to fit
  bool from_results_ = false;
  bool overridden_ = false;
  bool changed_ = false;
  bool mesh_reused_ = false;
  bool factors_computed_ = false;
  bool replaces_ = false;
};

// ---- Keys of stages that are made without a pipeline, for a results file (Results::mesh_key and
// the others): a pipeline that opens it with the same options then reuses them.

std::string keyOfMesh(const MeshOptions& options, const Scene& scene);
std::string keyOfFactors(const FormFactorOptions& options, const PatchMesh& mesh);
/// `factors_key`, `method`: of the form factors (FormFactors::method).
std::string keyOfSolution(const SolveOptions& options, const PatchMaterials& materials,
                          const std::string& factors_key, const std::string& method);
std::string keyOfHeat(const HeatOptions& options, const HeatConditions& conditions,
                      const std::string& factors_key, const std::string& method);

}  // namespace radiosity
