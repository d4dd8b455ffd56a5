// The exact method's forecast of its own work against its counts, and the choice that `auto` makes
// from it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "exact_scenes.h"
#include "formfactor/computed_factors.h"
#include "formfactor/exact/assembly/exact_scene.h"
#include "formfactor/exact/assembly/recorded_pairs.h"
#include "formfactor/exact/assembly/row_sample.h"
#include "formfactor/foreseen_work.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

ExactEstimate estimateOf(const PatchMesh& mesh, const FormFactorOptions& options) {
  Progress silent;
  const ExactScene scene(mesh, silent);
  RowSample sample;
  sampleRows(scene, options.toleranceOf(FormFactorMethod::exact), sample, silent);
  return estimateExact(scene, sample, options);
}

PatchMesh meshNamed(const std::string& name, std::size_t patches) {
  return test::meshOf(test::dataScene(name), patches);
}

TEST(ExactEstimate, PointsAreForeseenWithinAFactorOfTwo) {
  struct Case {
    const char* scene;
    std::size_t patches;
    std::vector<double> tolerances;
  };
  // Counted points of these cases are 1.0 to 1.7 times the forecast: single pairs are off by more,
  // and the sample is small.
  constexpr double kFactor = 2;
  Progress silent;
  for (const Case& c : {Case{"cornell-box-closed", 500, {1e-1, 1e-3, 1e-4, 1e-6}},
                        Case{"two-rooms", 500, {1e-2, 1e-3, 1e-4}}, Case{"cluttered", 300, {1e-2}},
                        Case{"curved", 1500, {1e-1}}}) {
    const PatchMesh mesh = meshNamed(c.scene, c.patches);
    for (const double tolerance : c.tolerances) {
      const FormFactorOptions options = test::exactly(tolerance);
      const double foreseen = estimateOf(mesh, options).points;
      const auto counted = double(computeFormFactors(mesh, options, silent).report.exact.points);
      EXPECT_LT(counted, kFactor * foreseen) << c.scene << ' ' << tolerance;
      EXPECT_GT(counted, foreseen / kFactor) << c.scene << ' ' << tolerance;
    }
  }
}

TEST(ExactEstimate, RepeatsInEveryRunExceptForTimes) {
  const PatchMesh mesh = meshNamed("furnished-room", 600);
  const FormFactorOptions options = test::exactly(1e-3);
  const ExactEstimate first = estimateOf(mesh, options);
  setThreads(1);
  const ExactEstimate second = estimateOf(mesh, options);
  setThreads(0);
  EXPECT_GT(first.occluded_pairs, 0);
  EXPECT_EQ(first.occluded_pairs, second.occluded_pairs);
  EXPECT_EQ(first.work, second.work);
  EXPECT_EQ(first.refining, second.refining);
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.entries_per_row, second.entries_per_row);
}

TEST(ExactEstimate, AnUnboundedSampleCoversAllPairs) {
  const PatchMesh mesh = meshNamed("cluttered", 300);
  Progress silent;
  const ExactScene scene(mesh, silent);
  const Visibility& visibility = scene.visibility;
  for (std::size_t t = 0; t < scene.tasks.size(); ++t) {
    for (const ElementRange& range : scene.tasks[t]) {
      RecordedPairs whole;
      RecordedPairs sampled;
      VisibilityCounts whole_counts;
      VisibilityCounts counts;
      visibility.classify(range, whole, whole_counts);
      const VisibilityOfFacets of_facets = visibility.classifySome(range, {}, sampled, counts);
      EXPECT_EQ(sampled.occluded_pairs.size(), whole.occluded_pairs.size());
      EXPECT_EQ(counts.unoccluded, whole_counts.unoccluded);
      EXPECT_EQ(counts.hidden, whole_counts.hidden);
      EXPECT_EQ(counts.settled(), visibility.openPairs(range));
      EXPECT_EQ(of_facets.settled.settled() + of_facets.left, visibility.openPairs(range));
    }
  }
}

TEST(ExactEstimate, ASampleKeepsToItsBound) {
  const PatchMesh mesh = meshNamed("furnished-room", 600);
  Progress silent;
  const ExactScene scene(mesh, silent);
  VisibilitySample sample;
  sample.most_tests = 1000;
  std::size_t tests = 0;
  std::size_t stopped = 0;
  // A facet begun is looked at to its end: a walk down the tree of occluders, then one item.
  const std::size_t beyond = 4 * scene.occluders.occluders.size();
  for (std::size_t t = 0; t < scene.tasks.size(); ++t) {
    for (const ElementRange& range : scene.tasks[t]) {
      RecordedPairs sampled;
      VisibilityCounts counts;
      scene.visibility.classifySome(range, sample, sampled, counts);
      tests = std::max(tests, counts.shaft_tests);
      EXPECT_LE(counts.settled(), scene.visibility.openPairs(range));
      stopped += counts.settled() < scene.visibility.openPairs(range) ? 1 : 0;
    }
  }
  EXPECT_GT(stopped, 0u);
  EXPECT_LT(tests, sample.most_tests + beyond);
}

/// What is settled before a descent is easy: a sample without any other pairs knows nothing of
/// them.
TEST(ExactEstimate, ASampleGoesOnUntilADescentSettlesPairs) {
  const PatchMesh mesh = meshNamed("furnished-room", 600);
  Progress silent;
  const ExactScene scene(mesh, silent);
  VisibilitySample sample;
  sample.most_tests = 1;
  const std::size_t beyond = 4 * scene.occluders.occluders.size();
  std::array<std::size_t, 2> none{};  // ranges without any settled in a descent
  for (const bool goes_on : {false, true}) {
    sample.limit_of_tests = goes_on ? 20'000 : 0;
    for (std::size_t t = 0; t < scene.tasks.size(); ++t) {
      for (const ElementRange& range : scene.tasks[t]) {
        RecordedPairs sampled;
        VisibilityCounts counts;
        const VisibilityOfFacets of_facets =
            scene.visibility.classifySome(range, sample, sampled, counts);
        EXPECT_LT(counts.shaft_tests, 20'000 + beyond);
        if (of_facets.left > 0 && counts.settled() == of_facets.settled.settled()) ++none[goes_on];
      }
    }
  }
  EXPECT_GT(none[0], 10u);
  EXPECT_EQ(none[1], 0u);
}

TEST(ExactEstimate, TighterTolerancesTakeLonger) {
  const PatchMesh mesh = meshNamed("two-rooms", 300);
  const ExactEstimate loose = estimateOf(mesh, test::exactly(1e-2));
  const ExactEstimate tight = estimateOf(mesh, test::exactly(1e-3));
  EXPECT_GT(loose.refining, 0);
  EXPECT_LT(loose.refining, loose.work);
  // Refining goes with 1 / tolerance; sums of some thousand numbers, rounded differently.
  EXPECT_NEAR(tight.work, loose.work + 9 * loose.refining, 1e-9 * tight.work);
  EXPECT_NEAR(tight.refining, 10 * loose.refining, 1e-9 * tight.work);
  EXPECT_EQ(tight.occluded_pairs, loose.occluded_pairs);
}

TEST(ExactEstimate, UnoccludedPairsTakeNoPoints) {
  test::MeshBuilder builder;
  builder.grid("low", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8, 8);
  builder.grid("high", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 8, 8);
  const PatchMesh mesh = builder.build();
  const ExactEstimate estimate = estimateOf(mesh, test::exactly(1e-6));
  EXPECT_EQ(estimate.points, 0);
  EXPECT_EQ(estimate.refining, 0);
  EXPECT_GT(estimate.work, 0);
}

TEST(Auto, PicksExactIfLittleIsOccluded) {
  const PatchMesh mesh = meshNamed("cornell-box", 1000);
  Progress silent;
  for (const std::optional<double> tolerance : {std::optional<double>(), std::optional(1e-3)}) {
    FormFactorOptions options;
    options.tolerance = tolerance;
    const FormFactorPlan plan = planFormFactors(mesh, options, silent);
    EXPECT_EQ(plan.method, FormFactorMethod::exact);
    // Rays take some hundred times as long. They are not looked at if exact takes next to no time.
    EXPECT_GT((plan.other ? plan.other->seconds : HUGE_VAL), plan.seconds);
  }
}

TEST(Auto, PicksRaysInClutterAtALooseTolerance) {
  const PatchMesh cluttered = meshNamed("furnished-room", 5000);
  Progress silent;
  FormFactorOptions options;
  options.needs_pairs = true;
  options.tolerance = 5e-2;
  EXPECT_EQ(planFormFactors(cluttered, options, silent).method, FormFactorMethod::rays);
  options.tolerance = 1e-5;
  EXPECT_EQ(planFormFactors(cluttered, options, silent).method, FormFactorMethod::exact);
}

TEST(Auto, CutsRowsWhereRaysToTheirToleranceTakeFarLonger) {
  const PatchMesh cluttered = meshNamed("furnished-room", 5000);
  Progress silent;
  FormFactorOptions options;
  options.tolerance =
      1e-2;  // of each pair with rays, of all light with cuts: some 40 times the rays
  EXPECT_EQ(planFormFactors(cluttered, options, silent).method, FormFactorMethod::cut);
}

TEST(Auto, PicksTheMethodThatKeepsTheMemoryLimit) {
  for (const char* scene : {"cornell-box", "furnished-room"}) {
    const PatchMesh mesh = meshNamed(scene, 1000);
    Progress silent;
    FormFactorOptions options;
    options.needs_pairs = true;
    const auto bytesOf = [&](FormFactorMethod method) {
      options.method = method;
      return planFormFactors(mesh, options, silent).bytes;
    };
    const std::size_t exact = bytesOf(FormFactorMethod::exact);
    const std::size_t rays = bytesOf(FormFactorMethod::rays);
    const FormFactorMethod smaller =
        exact < rays ? FormFactorMethod::exact : FormFactorMethod::rays;
    options.method = FormFactorMethod::automatic;
    options.memory_limit = (exact + rays) / 2;
    EXPECT_EQ(planFormFactors(mesh, options, silent).method, smaller) << scene;
    // If none keeps it, the smaller one says what it needs.
    options.memory_limit = 1;
    const FormFactorPlan plan = planFormFactors(mesh, options, silent);
    EXPECT_EQ(plan.method, smaller) << scene;
    EXPECT_THROW(computeFormFactors(plan, silent), RunError);
  }
}

TEST(Auto, RaysTakeThePlaceOfExactThatTakesFarLongerThanForeseen) {
  const PatchMesh mesh = meshNamed("cornell-box", 300);
  Progress silent;
  const FormFactorOptions options;
  FormFactorPlan plan = planFormFactors(mesh, options, silent);
  ASSERT_EQ(plan.method, FormFactorMethod::exact);
  plan.seconds = -1e3;  // any time is too long
  const FormFactors f = computeFormFactors(plan, silent);
  EXPECT_EQ(f.method, FormFactorMethod::rays);
  EXPECT_EQ(f.report.method_reason.rfind("exact, which was to take", 0), 0u);
  ASSERT_FALSE(f.report.notes.empty());
  FormFactorOptions rays = options;
  rays.method = FormFactorMethod::rays;
  const FormFactors direct = computeFormFactors(mesh, rays, silent);
  for (std::size_t i = 0; i < mesh.size(); i += 7) {
    for (std::size_t j = 0; j < mesh.size(); j += 3) {
      ASSERT_EQ(f.matrix->at(i, j), direct.matrix->at(i, j)) << i << ' ' << j;
    }
  }
  // Who asked for exact gets exact.
  FormFactorOptions exact = options;
  exact.method = FormFactorMethod::exact;
  plan = planFormFactors(mesh, exact, silent);
  plan.seconds = -1e3;
  EXPECT_EQ(computeFormFactors(plan, silent).method, FormFactorMethod::exact);
}

TEST(Plan, CanBeRunSeveralTimes) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  Progress silent;
  for (const FormFactorMethod method : {FormFactorMethod::automatic, FormFactorMethod::hemicube}) {
    FormFactorOptions options;
    options.method = method;
    options.resolution = 32;
    const FormFactors direct = computeFormFactors(mesh, options, silent);
    const FormFactorPlan plan = planFormFactors(mesh, options, silent);
    for (int run = 0; run < 2; ++run) {
      const FormFactors f = computeFormFactors(plan, silent);
      EXPECT_EQ(f.method, direct.method);
      EXPECT_EQ(f.report.estimated_bytes, plan.bytes);
      for (std::size_t i = 0; i < mesh.size(); ++i) {
        for (std::size_t j = 0; j < mesh.size(); ++j) {
          ASSERT_EQ(f.matrix->at(i, j), direct.matrix->at(i, j)) << i << ' ' << j;
        }
      }
    }
  }
  EXPECT_THROW(computeFormFactors(FormFactorPlan(), silent), std::logic_error);
}

}  // namespace
}  // namespace radiosity
