// Stage reuse: each stage is taken from a results file where its key fits, and computed otherwise.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "cli/report.h"
#include "cli/request.h"
#include "cli/stage_key.h"
#include "radiosity/results.h"

namespace radiosity::cli {

/// A stage that must be there by now.
template <class Stage>
auto& made(Stage& stage) {
  if (!stage) throw std::logic_error("a stage was used before it was made");
  return *stage;
}

/// Scene -> mesh -> form factors -> solution, for one run. What is reused, computed or dropped is
/// said on a line each.
///
/// Where stages come from: a results file given as input, whose stages keep the options they were
/// made with unless others are given; or, where the input is a scene file, the results file that
/// the run will write, if there is one already (then the options are those given and the defaults,
/// so that a command means the same whether or not its output is there).
class Pipeline {
 public:
  Pipeline(const Request& request, Report& report, Progress& progress);

  /// Loads the scene, applies the overrides. `results_output`: the .h5 this run writes, or empty.
  void open(const std::string& results_output);
  /// InputError, with the cure, where nothing in the scene emits.
  void requireLight() const;
  void mesh();
  /// Where they are reused they come without the matrix, until loadMatrix().
  void factors();
  void solution();
  /// By the gather method; needs the mesh only.
  void gathered();
  /// Loads the matrix where the reused form factors came without it. RunError where another run
  /// has replaced the file meanwhile.
  void loadMatrix();
  /// Keeps the later stages that still fit and says which are dropped.
  void keepLaterStages();

  Results& results() { return results_; }
  /// What the results file given as input holds beyond its scene; for `info`.
  const Results& stored() const { return previous_; }
  const Scene& scene() const { return made(results_.scene); }
  const PatchMesh& patches() const { return made(results_.mesh).mesh; }
  const FormFactors& formFactors() const { return made(results_.factors); }
  const Solution& solved() const { return made(results_.solution); }
  const Gathered& gatheredLight() const { return made(results_.gathered); }
  const PatchMaterials& materials();
  /// Three, which the scene says; or what the results file given as input says itself, with
  /// materials of its own, a row a patch. After open().
  int bands() const;
  bool fromResultsFile() const { return from_results_; }
  /// True where what there is so far fills gaps of the results file given and replaces nothing in
  /// it. After mesh().
  bool onlyAdds() const;
  bool factorsComputed() const { return factors_computed_; }
  /// Writes the stages there are so far, so that what comes after can fail.
  void save(const std::string& path);
  /// True where the file holds results() as they are: the stages came from it, or were saved there.
  bool isUpToDate(const std::string& path) const {
    return !changed_ && (path == source_ || path == saved_);
  }
  /// True where results() differs from the file the stages came from, or were saved to since.
  bool changed() const { return changed_; }

 private:
  void openResults();
  /// Reads the stages of `path`, all but the matrix, and remembers in which state it was.
  void openSource(const std::string& path);
  void openScene(const std::string& results_output);
  /// InputError where the mesh is not the one that the file's own materials belong to.
  void takeOwnMaterials();
  /// What was given over what the results file has or the defaults; wrong ones are found here,
  /// before any work.
  void chooseOptions();
  /// Whether the source's form factors are what was asked for: other options than those that made
  /// them may differ. `plan` is set where it had to be made to tell.
  bool factorsFit(const StageKey& key, std::optional<FormFactorPlan>& plan) const;
  FormFactorPlan planFactors() const;
  void announceFactors(const FormFactorPlan& plan);
  StageKey usedFactorsKey() const;
  /// Each returns true where the stage is dropped.
  bool keepFactors();
  bool keepSolution();
  bool keepGathered();
  std::string why(const std::string& stored_key, const StageKey& key, bool present) const;
  void computed(const std::string& stage, const std::string& label, const std::string& reason,
                double seconds);

  const Request& request_;
  MeshOptions mesh_options_;
  FormFactorOptions factor_options_;
  SolveOptions solve_options_;
  GatherOptions gather_options_;
  Report& report_;
  Progress& progress_;
  Results results_;   ///< the stages of this run
  Results previous_;  ///< what the source holds and has not been taken over yet
  std::string source_;
  std::string source_state_;
  bool from_results_ = false;
  bool matrix_loaded_ = false;
  bool changed_ = false;
  bool mesh_reused_ = false;
  bool factors_computed_ = false;
  bool replaces_ = false;  ///< something of the source
  std::string saved_;      ///< where save() wrote
  bool writes_results_ = false;
};

}  // namespace radiosity::cli
