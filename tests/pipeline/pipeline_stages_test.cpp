// The stages of a scene by the library alone: stages made, stages reused, and messages.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/names.h"
#include "radiosity/pipeline.h"
#include "support/results_folder.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

const std::string kBox = RADIOSITY_SOURCE_DIR "/data/cornell-box-closed.obj";

/// Records its messages.
class Recorder : public PipelineObserver {
 public:
  void opened(const Pipeline& pipeline) override { faces = pipeline.scene().faceCount(); }
  void notes(const Pipeline& /*pipeline*/, std::span<const Note> notes) override {
    for (const Note& note : notes) said += note.text + "\n";
  }
  void notReused(const std::string& path, const std::string& why) override {
    said += "not reused " + path + ": " + why + "\n";
  }
  void planned(const Pipeline& pipeline, const FormFactorPlan& plan) override {
    EXPECT_TRUE(pipeline.results().mesh);
    EXPECT_GT(plan.bytes, 0u);
    events.emplace_back("plan");
  }
  void stage(const Pipeline& /*pipeline*/, const StageEvent& event) override {
    constexpr std::array kStages = {"mesh", "factors", "solution", "elements", "gather"};
    constexpr std::array kActions = {"reused", "computed", "recomputed", "kept", "dropped"};
    std::string text = std::string(kStages.at(std::size_t(event.stage))) + " " +
                       kActions.at(std::size_t(event.action));
    const bool made =
        event.action == StageAction::computed || event.action == StageAction::recomputed;
    EXPECT_EQ(event.seconds.has_value(), made) << text;
    if (!event.detail.empty()) text += ": " + event.detail;
    events.push_back(std::move(text));
  }
  /// The messages since the last call.
  std::vector<std::string> take() { return std::exchange(events, {}); }

  std::vector<std::string> events;
  std::string said;
  std::size_t faces = 0;
};

using Events = std::vector<std::string>;

/// Coarse: seconds count here, not the light.
void makeCoarse(PipelineOptions& options) {
  options.mesh.patches = 60;
  options.factors.method = FormFactorMethod::hemicube;
  options.factors.resolution = 32;
  options.gather.resolution = 16;
  options.gather.passes = 3;
}

void makeAll(Pipeline& pipeline) {
  pipeline.solution();
  pipeline.gathered();
}

/// A closed room that reflects `reflectance` and emits 1 W/m^2 all over.
Scene furnace(double reflectance, double emission = 1) {
  test::SceneBuilder builder;
  builder.box(builder.surface("wall", reflectance, emission), {0, 0, 0}, {1, 1, 1}, false);
  return builder.scene();
}

class PipelineStages : public FolderTest {
 protected:
  /// Every stage of the box, in a file.
  std::string savedBox() {
    std::string file = path("box.h5");
    Pipeline pipeline(progress_);
    pipeline.open(kBox);
    makeCoarse(pipeline.options());
    makeAll(pipeline);
    pipeline.save(file);
    return file;
  }
  Recorder told_;
};

TEST_F(PipelineStages, EachStageMakesTheStagesBeforeIt) {
  Pipeline pipeline(progress_, &told_);
  pipeline.open(kBox);
  EXPECT_EQ(told_.faces, pipeline.scene().faceCount());
  makeCoarse(pipeline.options());
  EXPECT_TRUE(pipeline.solution().summary.usable());
  EXPECT_EQ(told_.take(),
            (Events{"mesh computed", "plan", "factors computed", "solution computed"}));
  EXPECT_TRUE(pipeline.factorsComputed());
  pipeline.gathered();
  EXPECT_EQ(told_.take(), Events{"gather computed"});
  makeAll(pipeline);
  EXPECT_EQ(told_.take(), Events{}) << "what is there is not made again";
}

TEST_F(PipelineStages, ASavedFileIsReusedWhole) {
  Pipeline first(progress_);
  first.open(kBox);
  makeCoarse(first.options());
  makeAll(first);
  const std::string file = path("box.h5");
  EXPECT_FALSE(first.isUpToDate(file));
  first.save(file);
  EXPECT_TRUE(first.isUpToDate(file));

  Pipeline again(progress_, &told_);
  again.open(file);
  EXPECT_EQ(again.options().mesh.patches, 60u);
  EXPECT_EQ(again.options().factors.method, FormFactorMethod::hemicube);
  EXPECT_EQ(again.options().gather.passes, 3);
  makeAll(again);
  EXPECT_EQ(told_.take(), (Events{"mesh reused: " + file, "factors reused: " + file,
                                  "solution reused: " + file, "gather reused: " + file}));
  EXPECT_EQ(again.solution().radiosity, first.solution().radiosity);
  EXPECT_EQ(again.gathered().radiosity, first.gathered().radiosity);
  EXPECT_EQ(again.factors().matrix, nullptr) << "nobody asked for the matrix";
  EXPECT_EQ(again.matrix().size(), again.mesh().mesh.size());
  EXPECT_EQ(again.matrix().bytes(), first.matrix().bytes());
  EXPECT_TRUE(again.isUpToDate(file));
  EXPECT_FALSE(again.changed());
}

TEST_F(PipelineStages, StagesMadeWithoutAPipelineAreReusedByTheirKeys) {
  const std::string file = path("alone.h5");
  Progress quiet;
  PipelineOptions options;
  makeCoarse(options);
  Results results;
  results.scene = loadScene(kBox);
  results.mesh = {meshScene(*results.scene, options.mesh, quiet),
                  keyOfMesh(options.mesh, *results.scene)};
  const PatchMesh& mesh = results.mesh->mesh;
  // Apart from the results, as for shared form factors.
  const FormFactors factors = computeFormFactors(mesh, options.factors, quiet);
  results.materials = patchMaterials(*results.scene, mesh);
  results.factors.key = keyOfFactors(options.factors, mesh);
  results.solution = {solve(factors, *results.materials, mesh, options.solve, quiet),
                      keyOfSolution(options.solve, *results.materials, results.factors.key,
                                    nameOf(kFactorsFromNames, factors.method))};
  writeResults(file, results, factors, quiet);

  Recorder recorder;
  Pipeline again(quiet, &recorder);
  again.open(file);
  EXPECT_EQ(again.solution().radiosity, results.solution->radiosity);
  EXPECT_EQ(again.matrix().rowSums(), factors.matrix->rowSums());
  const std::string reused = " reused: " + file;
  EXPECT_EQ(recorder.take(), (Events{"mesh" + reused, "factors" + reused, "solution" + reused}));
}

TEST_F(PipelineStages, AChangedOptionRemakesTheStagesThatDependOnIt) {
  const std::string file = savedBox();
  const Events reused = {"mesh reused: " + file, "factors reused: " + file,
                         "solution reused: " + file, "gather reused: " + file};
  const struct {
    std::function<void(PipelineOptions&)> change;
    Events mesh, factors, solution, gather;
  } cases[] = {{[](PipelineOptions& o) { o.mesh.patches = 80; },
                {"mesh recomputed: patches 60 -> 80"},
                {"plan", "factors recomputed: mesh changed"},
                {"solution recomputed: materials changed, form factors changed"},
                {"gather recomputed: materials changed, mesh changed"}},
               {[](PipelineOptions& o) { o.factors.resolution = 64; },
                {reused[0]},
                {"plan", "factors recomputed: resolution 32 -> 64"},
                {"solution recomputed: form factors changed"},
                {reused[3]}},
               // Hemicubes ignore it.
               {[](PipelineOptions& o) { o.factors.tolerance = 1e-2; },
                {reused[0]},
                {reused[1]},
                {reused[2]},
                {reused[3]}},
               {[](PipelineOptions& o) { o.solve.tolerance = 1e-9; },
                {reused[0]},
                {reused[1]},
                {"solution recomputed: solve-tolerance 1e-06 -> 1e-09"},
                {reused[3]}},
               {[](PipelineOptions& o) { o.gather.passes = 2; },
                {reused[0]},
                {reused[1]},
                {reused[2]},
                {"gather recomputed: passes 3 -> 2"}}};
  for (const auto& c : cases) {
    Pipeline pipeline(progress_, &told_);
    pipeline.open(file);
    c.change(pipeline.options());
    pipeline.mesh();
    EXPECT_EQ(told_.take(), c.mesh);
    pipeline.factors();
    EXPECT_EQ(told_.take(), c.factors);
    pipeline.solution();
    EXPECT_EQ(told_.take(), c.solution);
    pipeline.gathered();
    EXPECT_EQ(told_.take(), c.gather);
    EXPECT_FALSE(pipeline.onlyAdds()) << "the file has form factors";
  }
}

TEST_F(PipelineStages, NewMaterialsKeepTheFormFactors) {
  const std::string file = savedBox();
  Pipeline pipeline(progress_, &told_);
  SceneOptions overrides;
  overrides.set = {"white.reflectance=0.9"};
  pipeline.open(file, overrides);
  EXPECT_NE(told_.said.find("white"), std::string::npos) << told_.said;
  makeAll(pipeline);
  EXPECT_EQ(told_.take(), (Events{"mesh reused: " + file, "factors reused: " + file,
                                  "solution recomputed: materials changed",
                                  "gather recomputed: materials changed"}));
  EXPECT_FALSE(pipeline.isUpToDate(file));
}

/// A light file of the box with elements, few rays each.
std::string savedElements(const std::string& file, Progress& progress) {
  Pipeline pipeline(progress);
  pipeline.open(kBox);
  makeCoarse(pipeline.options());
  pipeline.options().elements.rays = 64;
  pipeline.elements();
  pipeline.save(file);
  return file;
}

TEST_F(PipelineStages, ElementsOfTheSameSolutionAreReused) {
  const std::string file = savedElements(path("box.h5"), progress_);
  Pipeline pipeline(progress_, &told_);
  pipeline.open(file);
  EXPECT_EQ(pipeline.options().elements.rays, 64) << "as the file has them";
  const Events made = {"mesh reused: " + file, "factors reused: " + file,
                       "solution reused: " + file, "elements reused: " + file};
  // A picture of one patch takes the elements of all, since they exist.
  std::vector<std::uint8_t> wanted(pipeline.mesh().mesh.size(), 0);
  wanted[0] = 1;
  const SurfaceLight light = pipeline.elementLight(wanted);
  EXPECT_EQ(told_.take(), made);
  EXPECT_TRUE(std::ranges::all_of(
      std::span(light.elements->indirect.elements).first(light.elements->roots.size()),
      [](const Element& root) { return root.corners != 0; }));
  EXPECT_TRUE(pipeline.isUpToDate(file));
  Pipeline keeps(progress_, &told_);
  keeps.open(file);
  keeps.solution();
  told_.take();
  keeps.keepLaterStages();
  EXPECT_EQ(told_.take(), Events{"elements kept"});
}

TEST_F(PipelineStages, TheFileMarksFormFactorsForSourcesAlone) {
  const std::string file = path("sources.h5");
  Pipeline first(progress_);
  first.open(kBox);
  first.options().mesh.patches = 60;
  first.options().factors.method = FormFactorMethod::exact;
  first.options().factors.sources_only = true;
  first.factors();
  first.save(file);

  Pipeline again(progress_, &told_);
  again.open(file);
  EXPECT_TRUE(again.options().factors.sources_only);
  told_.take();
  again.factors();
  EXPECT_EQ(told_.take(), (Events{"mesh reused: " + file, "factors reused: " + file}));
  again.options().factors.sources_only = false;
  again.factors();
  EXPECT_EQ(told_.take(), (Events{"plan", "factors recomputed: tolerance sources -> default"}));
}

TEST_F(PipelineStages, ElementsThatNoLongerFitAreNotUsed) {
  const std::string file = savedElements(path("box.h5"), progress_);
  SceneOptions brighter;
  brighter.set = {"white.reflectance=0.9"};
  const struct {
    SceneOptions scene;
    double tolerance;
    std::string why;
  } cases[] = {{brighter, 0.01, "solution changed"}, {{}, 0.05, "element-tolerance 0.01 -> 0.05"}};
  for (const auto& c : cases) {
    Pipeline pipeline(progress_, &told_);
    pipeline.open(file, c.scene);
    pipeline.options().elements.tolerance = c.tolerance;
    pipeline.solution();
    told_.take();
    const Elements& found = pipeline.elements();
    EXPECT_EQ(told_.take(), Events{"elements recomputed: " + c.why});
    EXPECT_NE(found.indirect.values, readResults(file).elements->indirect.values);

    Pipeline some(progress_, &told_);
    some.open(file, c.scene);
    some.options().elements.tolerance = c.tolerance;
    std::vector<std::uint8_t> wanted(some.mesh().mesh.size(), 0);
    wanted[0] = 1;
    some.solution();
    told_.take();
    some.elementLight(wanted);
    EXPECT_EQ(told_.take(), Events{"elements recomputed: " + c.why});
    EXPECT_FALSE(some.results().elements) << "a part is not kept";
  }
  Pipeline dropped(progress_, &told_);
  dropped.open(file, brighter);
  dropped.solution();
  told_.take();
  dropped.keepLaterStages();
  EXPECT_EQ(told_.take(), Events{"elements dropped: solution changed"});
}

TEST_F(PipelineStages, OptionsMayChangeBetweenCalls) {
  Pipeline pipeline(progress_, &told_);
  pipeline.open(furnace(0.5));
  makeCoarse(pipeline.options());
  makeAll(pipeline);
  told_.take();
  pipeline.options().solve.solver = Solver::jacobi;
  makeAll(pipeline);
  EXPECT_EQ(told_.take(), Events{"solution recomputed: solver auto -> jacobi"});
  pipeline.options().factors.seed = 2;
  pipeline.factors();
  EXPECT_FALSE(pipeline.results().solution) << "it stood on other form factors";
  EXPECT_TRUE(pipeline.results().gathered);
  makeAll(pipeline);
  EXPECT_EQ(told_.take(), (Events{"plan", "factors recomputed: seed 1 -> 2",
                                  "solution recomputed: form factors changed"}));
  pipeline.options().gather.inset = 0.2;
  pipeline.options().gather.random_turns = false;
  pipeline.gathered();
  EXPECT_EQ(told_.take(),
            Events{"gather recomputed: random-turns default -> off, inset default -> 0.2"});
  pipeline.options().gather = {};
  makeCoarse(pipeline.options());
  pipeline.gathered();
  EXPECT_EQ(told_.take(),
            Events{"gather recomputed: random-turns off -> default, inset 0.2 -> default"});
  const std::size_t before = pipeline.mesh().mesh.size();
  pipeline.options().mesh.patches = 200;
  EXPECT_GT(pipeline.mesh().mesh.size(), before);
  EXPECT_FALSE(pipeline.results().factors || pipeline.results().gathered);
  EXPECT_EQ(pipeline.materials().emission.size(), 3 * pipeline.mesh().mesh.size());
  EXPECT_EQ(pipeline.solution().radiosity.size(), 3 * pipeline.mesh().mesh.size());
}

TEST_F(PipelineStages, ASceneFromMemoryReusesItsFile) {
  const std::string file = path("furnace.h5");
  {
    Pipeline pipeline(progress_, &told_);
    pipeline.open(furnace(0.5), file);  // not there yet
    makeCoarse(pipeline.options());
    pipeline.requireLight();
    // B = E / (1 - rho); single precision rows, each of up to 60 entries off by 3e-8 of itself.
    for (const double b : pipeline.solution().radiosity) ASSERT_NEAR(b, 2, 1e-5);
    pipeline.save(file);
    told_.take();
  }
  {
    Pipeline pipeline(progress_, &told_);
    pipeline.open(furnace(0.5), file);
    makeCoarse(pipeline.options());
    pipeline.solution();
    EXPECT_EQ(told_.take(), (Events{"mesh reused: " + file, "factors reused: " + file,
                                    "solution reused: " + file}));
    EXPECT_FALSE(pipeline.fromResultsFile());
  }
  Scene other = furnace(0.5);
  other.vertices[0].x -= 0.25;
  Pipeline pipeline(progress_, &told_);
  pipeline.open(other, file);
  makeCoarse(pipeline.options());
  pipeline.mesh();
  EXPECT_EQ(told_.take(), Events{"mesh recomputed: geometry changed"});
}

TEST_F(PipelineStages, SavingKeepsValidStagesAndDropsTheRest) {
  const std::string file = savedBox();
  Pipeline pipeline(progress_, &told_);
  pipeline.open(file);
  pipeline.options().factors.resolution = 64;
  pipeline.factors();
  told_.take();
  pipeline.save(file);
  EXPECT_EQ(told_.take(), (Events{"solution dropped: form factors changed", "gather kept"}));
  EXPECT_TRUE(pipeline.isUpToDate(file));
  pipeline.save(file);
  EXPECT_EQ(told_.take(), Events{}) << "said once";
  const Results results = readResults(file);
  EXPECT_TRUE(results.factors && results.gathered && !results.solution);
}

TEST_F(PipelineStages, AStageOfUnknownInputsIsNotKept) {
  const std::string file = savedBox();
  Results results = readResults(file);
  results.gathered.key = "at=vertices passes=3";
  writeResults(file, results, progress_);
  Pipeline pipeline(progress_, &told_);
  pipeline.open(file);
  pipeline.solution();
  told_.take();
  pipeline.keepLaterStages();
  EXPECT_EQ(told_.take(), Events{"gather dropped: its key is not readable"});
}

TEST_F(PipelineStages, ACheckpointLosesNothing) {
  const std::string file = savedBox();
  Pipeline pipeline(progress_, &told_);
  pipeline.open(file);
  pipeline.options().factors.resolution = 64;
  pipeline.factors();
  pipeline.checkpoint(file);
  EXPECT_TRUE(readResults(file).gathered) << "of the same mesh";
  told_.take();
  pipeline.gathered();
  EXPECT_EQ(told_.take(), Events{"gather reused: " + file});
}

TEST_F(PipelineStages, AFileIsOnlyAddedToUntilTheMeshChanges) {
  const std::string file = path("mesh.h5");
  {
    Pipeline pipeline(progress_);
    pipeline.open(kBox);
    makeCoarse(pipeline.options());
    pipeline.mesh();
    pipeline.save(file);
  }
  Pipeline pipeline(progress_);
  pipeline.open(file);
  pipeline.mesh();
  EXPECT_TRUE(pipeline.onlyAdds());
  Pipeline finer(progress_);
  finer.open(file);
  finer.options().mesh.patches = 100;
  finer.mesh();
  EXPECT_FALSE(finer.onlyAdds());
}

TEST_F(PipelineStages, ASolutionWithoutValuesIsNotSaved) {
  Pipeline pipeline(progress_);
  pipeline.open(furnace(1));  // no light is ever absorbed
  makeCoarse(pipeline.options());
  EXPECT_EQ(pipeline.solution().summary.status, SolveStatus::singular);
  const std::string file = path("singular.h5");
  pipeline.save(file);
  const Results results = readResults(file);
  EXPECT_TRUE(results.factors);
  EXPECT_FALSE(results.solution || results.materials);
}

TEST_F(PipelineStages, FieldsHoldTheRequestedQuantity) {
  Pipeline pipeline(progress_);
  pipeline.open(kBox);
  makeCoarse(pipeline.options());
  const ScalarField sums = pipeline.field(Quantity::row_sum);
  EXPECT_EQ(sums.values, pipeline.factors().fronts);
  const ScalarField row = pipeline.field(Quantity::form_factor, 5);
  double sum = 0;
  for (const double f : row.values) sum += f;
  EXPECT_NEAR(sum, sums.values[5], 1e-6);  // of up to 60 values in single precision
  const ScalarField bright = pipeline.field(Quantity::radiosity);
  const double* b = pipeline.solution().radiosity.data() + 15;
  EXPECT_NEAR(bright.values[5], 0.2126 * b[0] + 0.7152 * b[1] + 0.0722 * b[2], 1e-12 * b[0]);
  EXPECT_EQ(bright.legend.unit, "W/m^2");
  // B = E + rho H, band by band; the lamp aside, luminance of B is less than that of H.
  const ScalarField arriving = pipeline.field(Quantity::irradiance);
  const SurfaceLight light = pipeline.solvedLight();
  for (std::size_t i = 0; i < arriving.values.size(); ++i) {
    EXPECT_LE(light.reflected[i], arriving.values[i]) << i;
  }
  EXPECT_EQ(light.patches, pipeline.solution().radiosity);
  EXPECT_TRUE(light.corners.empty());
  EXPECT_EQ(pipeline.gatheredLight().corners.size(), 3 * pipeline.mesh().mesh.corners.size());
}

/// Materials that a program has written into a file, of other bands than a scene's three.
TEST_F(PipelineStages, AFilesOwnMaterialsBelongToItsMesh) {
  const std::string file = savedBox();
  Results own = readResults(file);
  PatchMaterials& materials = *own.materials;
  const PatchMaterials of_scene = materials;
  const std::size_t size = own.mesh->mesh.size();
  materials = {5, {}, {}, {}};
  for (std::size_t k = 0; k < 5 * size; ++k) {
    const std::size_t rgb = 3 * (k / 5) + k % 5 % 3;
    materials.reflectance.push_back(of_scene.reflectance[rgb]);
    materials.emission.push_back(of_scene.emission[rgb]);
  }
  own.solution = {};
  own.gathered = {};
  writeResults(file, own, progress_);

  Pipeline pipeline(progress_, &told_);
  pipeline.open(file);
  EXPECT_EQ(pipeline.bands(), 5);
  const std::vector<double> b = pipeline.solution().radiosity;
  EXPECT_EQ(told_.take(),
            (Events{"mesh reused: " + file, "factors reused: " + file, "solution computed"}));
  ASSERT_EQ(b.size(), 5 * size);
  for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(b[5 * i], b[5 * i + 3]) << i;
  EXPECT_NEAR(pipeline.field(Quantity::radiosity).values[7], b[35] + b[36] + b[37] + b[38] + b[39],
              1e-12 * b[35]);
  expectError<InputError>("", "or one in grey, not 5", [&] { pipeline.solvedLight(); });

  const std::size_t patches = std::exchange(pipeline.options().mesh.patches, 20);
  expectError<InputError>(file, "ask for another mesh", [&] { pipeline.mesh(); });
  pipeline.options().mesh.patches = patches;
  EXPECT_EQ(pipeline.solution().radiosity, b) << "a refusal leaves all as it was";
  SceneOptions overrides;
  overrides.lights = {uniformSky({1, 1, 1})};
  Pipeline overridden(progress_);
  expectError<InputError>(file, "materials of 5 bands", [&] { overridden.open(file, overrides); });
}

/// Results files live long: a key written differently would discard their stages.
TEST_F(PipelineStages, KeysKeepTheirText) {
  Pipeline pipeline(progress_);
  pipeline.open(kBox);
  makeCoarse(pipeline.options());
  makeAll(pipeline);
  const Results& results = pipeline.results();
  const auto expectKey = [](const std::string& key, const std::string& pattern) {
    EXPECT_TRUE(std::regex_match(key, std::regex(pattern))) << key;
  };
  const std::string hash = "[0-9a-f]{16}";
  expectKey(results.mesh.key,
            "patches=60 max-edge=0 weld=1e-07 faces-as-patches=off scene=" + hash);
  expectKey(
      results.factors.key,
      "method=hemicube seed=1 resolution=32 symmetrize=off near=off precision=single mesh=" + hash);
  expectKey(results.solution.key,
            "solver=auto solve-tolerance=1e-06 max-iterations=10000 "
            "materials=" +
                hash + " sky=0 factors=" + hash);
  expectKey(results.gathered.key,
            "at=vertices passes=3 gather-tolerance=0.0001 resolution=16 seed=1 "
            "crease=30 materials=" +
                hash + " sky=0 mesh=" + hash);
}

// ---- Errors

TEST_F(PipelineStages, ADarkSceneIsRefused) {
  Pipeline pipeline(progress_);
  pipeline.open(furnace(0.5, 0));
  expectError<InputError>("test scene", "set='wall/wall.radiance=10'",
                          [&] { pipeline.requireLight(); });
  expectError<InputError>("test scene", "nothing in the scene emits light",
                          [&] { pipeline.requireLight([] { return "light a candle"; }); });
  EXPECT_EQ(pipeline.solution().summary.status, SolveStatus::no_light) << "it can be solved";
}

TEST_F(PipelineStages, SceneOptionsAreRefusedForResultsFiles) {
  const std::string file = savedBox();
  SceneOptions inches;
  inches.unit = "in";
  SceneOptions bare;
  bare.textures = false;
  Pipeline pipeline(progress_);
  expectError<InputError>(file, "unit says how a scene file is read",
                          [&] { pipeline.open(file, inches); });
  expectError<InputError>(file, "textures says", [&] { pipeline.open(file, bare); });
  const std::string absent = path("absent.obj");
  expectError<InputError>(absent, "no such file", [&] { pipeline.open(absent); });
}

TEST_F(PipelineStages, ADamagedFileIsAnErrorOrNotReused) {
  const std::string file = savedBox();
  std::vector<char> bytes = load(file);
  bytes.resize(bytes.size() / 2);
  save(file, bytes);
  expectError<InputError>(file, "", [&] {
    Pipeline pipeline(progress_);
    pipeline.open(file);
  });
  Pipeline pipeline(progress_, &told_);
  pipeline.open(kBox, {}, file);
  EXPECT_NE(told_.said.find("not reused " + file), std::string::npos) << told_.said;
  makeCoarse(pipeline.options());
  pipeline.mesh();
  EXPECT_EQ(told_.take(), Events{"mesh computed"});
  pipeline.save(file);
  EXPECT_TRUE(readResults(file).mesh);
}

TEST_F(PipelineStages, AMatrixOfAnotherRunIsNotTaken) {
  const std::string file = savedBox();
  Pipeline pipeline(progress_);
  pipeline.open(file);
  pipeline.factors();
  savedBox();
  expectError<RunError>(file, "was replaced by another run", [&] { pipeline.matrix(); });
  Pipeline small(progress_);
  small.open(file);
  small.options().factors.memory_limit = 100;
  expectError<RunError>(file, "memory_limit allows 100 B", [&] { small.matrix(); });
}

TEST_F(PipelineStages, OptionsOutOfRangeAreNamed) {
  Pipeline pipeline(progress_);
  pipeline.open(furnace(0.5));
  makeCoarse(pipeline.options());
  pipeline.options().factors.resolution = 17;
  EXPECT_THROW(pipeline.solution(), InputError);
  pipeline.options().factors.resolution = 32;
  pipeline.options().solve.tolerance = 2;
  EXPECT_THROW(pipeline.solution(), InputError);
}

TEST_F(PipelineStages, AnObserverMayStopALongPlan) {
  class Impatient : public PipelineObserver {
    void planned(const Pipeline& /*pipeline*/, const FormFactorPlan& /*plan*/) override {
      throw RunError("too long");
    }
  };
  Impatient impatient;
  Pipeline pipeline(progress_, &impatient);
  pipeline.open(furnace(0.5));
  makeCoarse(pipeline.options());
  EXPECT_THROW(pipeline.factors(), RunError);
  EXPECT_FALSE(pipeline.results().factors);
}

}  // namespace
}  // namespace radiosity
