// The exact method as a whole: rows, accounts, error figures, skipped work, and equal bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>

#include "formfactor/computed_factors.h"
#include "formfactor/exact/assembly/error_figure.h"
#include "formfactor/exact/assembly/row_tasks.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

/// Bit for bit, as if patch order[k] of a were patch k of b.
void expectSame(const FormFactors& a, const FormFactors& b, std::vector<std::size_t> order = {}) {
  ASSERT_EQ(a.fronts.size(), b.fronts.size());
  ASSERT_EQ(a.error.size(), b.error.size());
  if (order.empty()) {
    order.resize(a.fronts.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(a.fronts[order[i]], b.fronts[i]);
    EXPECT_EQ(a.backs[order[i]], b.backs[i]);
    EXPECT_EQ(a.sky[order[i]], b.sky[i]);
    if (!a.error.empty()) {
      EXPECT_EQ(a.error[order[i]], b.error[i]);
    }
    for (std::size_t j = 0; j < order.size(); ++j) {
      ASSERT_EQ(a.matrix->at(order[i], order[j]), b.matrix->at(i, j)) << i << ' ' << j;
    }
  }
}

double totalBetween(const PatchMesh& mesh, const FormFactors& f, const std::string& from,
                    const std::string& to) {
  double exchange = 0;
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.surface_names[mesh.surface[i]] != from) continue;
    area += mesh.area[i];
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      if (mesh.surface_names[mesh.surface[j]] == to) exchange += mesh.area[i] * f.matrix->at(i, j);
    }
  }
  return exchange / area;
}

PatchMesh facingPlates(int n, double gap = 1) {
  MeshBuilder builder;
  builder.grid("low", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  builder.grid("high", {0, 0, gap}, {0, 1, 0}, {1, 0, 0}, n, n);
  return builder.build();
}

PatchMesh twinPlates(int n) {
  MeshBuilder builder;
  builder.grid("low", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  builder.grid("high", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n);
  builder.grid("blocker", {0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0}, 1, 1, true);
  return builder.build();
}

TEST(ExactFactors, FacingPlatesHaveTenDigitsWithOnePatchEach) {
  // Howell C-11, recomputed with 20 digits; double precision leaves some units of the 14th.
  const std::pair<double, double> values[] = {{0.01, 0.980416602925973},
                                              {0.1, 0.826994522397257},
                                              {1, 0.199824895698387},
                                              {10, 0.00316205683875760}};
  for (const auto& [gap, value] : values) {
    const FormFactors f = test::computed(facingPlates(1, gap), test::exactly(1e-11));
    EXPECT_EQ(pairsOf(*f.matrix).precision(), Precision::double_precision);
    EXPECT_NEAR(f.matrix->at(0, 1), value, 1e-10 * value) << gap;
    EXPECT_NEAR(f.sky[0], 1 - value, 1e-10) << gap;
  }
}

TEST(ExactFactors, ObstructedPlatesHaveTheirClosedForm) {
  // Unit squares at distance 1, a thin centred square of side 1/2 half way: 0.0995062945990 (from
  // the closed form of the aperture). The tolerance is per pair, relative to the mean 1/N; 2 * 16
  // pairs of one row and random signs leave some units of it.
  const PatchMesh mesh = twinPlates(4);
  const FormFactors f = test::computed(mesh, test::exactly(1e-4));
  EXPECT_NEAR(totalBetween(mesh, f, "low", "high"), 0.0995062945990, 2e-5);
  EXPECT_GT(f.report.exact.occluded, 0u);
  EXPECT_GT(f.report.exact.rechecked, 0u);
}

TEST(ExactFactors, RowsOfAClosedRoomWithABlockSumToOne) {
  const PatchMesh mesh = test::roomWithBlock(4).build();
  const FormFactors f = test::computed(mesh);
  EXPECT_TRUE(f.report.closed);
  // Rows sum to 1 but for the error of occluded pairs. A row's sum of N errors is at most
  // sqrt(N) times the root of their squares, which the figure bounds in 99 of 100 rows.
  const double root_n = std::sqrt(double(mesh.size()));
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (std::abs(f.fronts[i] - 1) > root_n * f.error[i]) ++beyond;
    // 208 patches: half a mean form factor, of dozens of occluded pairs in the row.
    EXPECT_NEAR(f.fronts[i], 1.0, 2.5e-3) << i;
    EXPECT_EQ(f.sky[i], 0.0);
    EXPECT_EQ(f.backs[i], 0.0);
  }
  EXPECT_LE(beyond, mesh.size() / 100);
  EXPECT_GT(f.report.largest_row_error, 0.0);  // raw, not hidden
  EXPECT_LT(f.report.largest_row_error, 2.5e-3);
}

TEST(ExactFactors, ClosureIsReportedOrEnforced) {
  const PatchMesh mesh = test::roomWithBlock(4).build();
  FormFactorOptions options = test::exactly();
  const FormFactors told = test::computed(mesh, options);
  EXPECT_FALSE(told.report.closure_enforced);
  EXPECT_EQ(told.report.closure.largest_residual_before, told.report.largest_row_error);
  EXPECT_GT(told.report.closure.rms_residual_before, 0.0);
  EXPECT_LT(told.report.closure.rms_residual_before, told.report.largest_row_error);
  EXPECT_EQ(told.report.closure.adjustable, 0u);  // counted on request only
  options.closure = ClosureMode::off;
  const FormFactors raw = test::computed(mesh, options);
  expectSame(told, raw);  // a report changes nothing
  EXPECT_EQ(raw.report.closure.largest_residual_before, 0.0);
  options.closure = ClosureMode::enforce;
  const FormFactors closed = test::computed(mesh, options);
  ASSERT_TRUE(closed.report.closure_enforced);
  // All clipped pairs but those whose rules agree to the bit; some of them came out as hidden.
  EXPECT_LE(closed.report.closure.adjustable, raw.report.exact.occluded + raw.report.exact.hidden);
  EXPECT_GT(closed.report.closure.adjustable, raw.report.exact.occluded * 9 / 10);
  // Rows with an uncertain entry sum to 1 as well as single precision holds values that add up to
  // 1; the others are as far off as closed forms are.
  EXPECT_LT(closed.report.closure.largest_residual, 3e-5);
  EXPECT_EQ(closed.report.largest_row_error, raw.report.largest_row_error);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_NEAR(closed.fronts[i], 1, 3e-5);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NEAR(mesh.area[i] * closed.matrix->at(i, j), mesh.area[j] * closed.matrix->at(j, i),
                  1e-7 * mesh.area[i] * closed.matrix->at(i, j));
    }
  }
}

TEST(ExactFactors, RowsOfAnOpenSceneAccountForSkyAndBacks) {
  // The flipped plate is perpendicular and shares an edge with both: its back takes 0.200043776075
  // (Howell C-14) of the view of each.
  MeshBuilder builder;
  builder.grid("low", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1);
  builder.grid("high", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 1, 1);
  builder.grid("flipped", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, 1);
  const PatchMesh mesh = builder.build();
  const FormFactors f = test::computed(mesh, test::exactly(1e-9));
  EXPECT_FALSE(f.report.closed);
  EXPECT_NEAR(f.fronts[0], 0.199824895698387, 1e-9);
  EXPECT_NEAR(f.backs[0], 0.200043776075403, 1e-9);
  EXPECT_NEAR(f.sky[0], 1 - 0.199824895698387 - 0.200043776075403, 1e-9);
  EXPECT_EQ(f.fronts[2], 0.0);
  EXPECT_NEAR(f.sky[2], 1.0, 1e-12);
  // Share of the whole scene's view (three unit areas) that ends on the back, named in a warning.
  EXPECT_NEAR(f.backs_by_surface[2], 2 * 0.200043776075403 / 3, 1e-9);
  ASSERT_EQ(f.report.notes.size(), 1u);
  EXPECT_NE(f.report.notes[0].text.find("flipped"), std::string::npos);
}

TEST(ExactFactors, AConcavePatchExchangesAsMuchAsItsSquares) {
  // An L of three unit squares as one concave patch exchanges what the three squares exchange.
  const auto scene = [](bool whole) {
    MeshBuilder builder;
    const std::vector<Vec3> l = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    const std::vector<std::vector<Vec3>> squares = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                                    {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}},
                                                    {{0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}};
    builder.polygon("l", {l}, whole ? std::vector<std::vector<Vec3>>{l} : squares);
    builder.grid("high", {0, 0, 1}, {0, 2, 0}, {2, 0, 0}, 3, 3);
    PatchMesh mesh = builder.build();
    if (!whole) return mesh;
    // The builder cuts an outline into a fan, which does not fit an L; these four triangles do.
    const Index* c = &mesh.corners[mesh.corner_offset[0]];
    const std::size_t first = mesh.piece_offset[0];
    mesh.pieces[first] = {c[0], c[1], c[2]};
    mesh.pieces[first + 1] = {c[0], c[2], c[3]};
    mesh.pieces[first + 2] = {c[0], c[3], c[5]};
    mesh.pieces[first + 3] = {c[3], c[4], c[5]};
    mesh.area[0] = 3;
    return mesh;
  };
  const PatchMesh whole = scene(true);
  const PatchMesh parts = scene(false);
  const FormFactors a = test::computed(whole, test::exactly(1e-9));
  const FormFactors b = test::computed(parts, test::exactly(1e-9));
  ASSERT_EQ(whole.size(), parts.size() - 2);
  EXPECT_GT(a.report.exact.elements, whole.size());
  for (std::size_t j = 0; j < 9; ++j) {
    double of_squares = 0;
    for (std::size_t i = 0; i < 3; ++i) of_squares += b.matrix->at(3 + j, i);
    EXPECT_NEAR(a.matrix->at(1 + j, 0), of_squares, 1e-9);
    EXPECT_NEAR(a.matrix->at(0, 1 + j) * 3, a.matrix->at(1 + j, 0) * whole.area[1 + j], 1e-12);
  }
}

TEST(ExactFactors, CoplanarPatchesCostNothing) {
  MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 100, 100);
  const FormFactors f = test::computed(builder.build());
  const ExactReport& e = f.report.exact;
  EXPECT_EQ(e.elements, 10000u);
  EXPECT_EQ(e.unoccluded + e.occluded + e.hidden, 0u);
  EXPECT_EQ(e.contour + e.lambert + e.product + e.points + e.shaft_tests, 0u);
  EXPECT_EQ(pairsOf(*f.matrix).nonZeros(), 0u);
}

TEST(ExactFactors, ConvexScenesRunNoVisibility) {
  MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 2, 3}, 4, true);
  const FormFactors f = test::computed(builder.build());
  const ExactReport& e = f.report.exact;
  EXPECT_EQ(e.occluded + e.hidden + e.shaft_tests + e.points, 0u);
  EXPECT_EQ(e.facet_pairs_unoccluded + e.facet_pairs_no_exchange, e.facet_pairs);
  // 15 pairs of walls of 16 x 16 pairs each.
  EXPECT_EQ(e.unoccluded, 15u * 256);
  EXPECT_TRUE(f.report.closed);
  EXPECT_LT(f.report.largest_row_error, 2e-5);  // the closed forms' 1e-5, and storage
}

TEST(ExactFactors, ThreadsScalarTargetAndScaleChangeNoBit) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  const FormFactors f = test::computed(mesh);
  setThreads(1);
  expectSame(f, test::computed(mesh));
  setThreads(0);
  FormFactorOptions scalar = test::exactly();
  scalar.simd = false;
  expectSame(f, test::computed(mesh, scalar));
  for (const int exponent : {-20, 20}) {
    PatchMesh scaled = mesh;
    for (Vec3& v : scaled.vertices) v *= std::ldexp(1.0, exponent);
    for (Vec3& v : scaled.centroid) v *= std::ldexp(1.0, exponent);
    for (Vec3& v : scaled.polygons.origin) v *= std::ldexp(1.0, exponent);
    for (double& a : scaled.area) a *= std::ldexp(1.0, 2 * exponent);
    expectSame(f, test::computed(scaled));
  }
}

TEST(ExactFactors, NumberingChangesNoBit) {
  const MeshBuilder builder = test::roomWithBlock(3);
  const PatchMesh mesh = builder.build();
  std::vector<std::size_t> order(mesh.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  PatchMesh shuffled = builder.build(order);
  // The identity of a patch is its index within the surface, whatever its number.
  for (std::size_t k = 0; k < order.size(); ++k) {
    shuffled.index_in_surface[k] = mesh.index_in_surface[order[k]];
  }
  expectSame(test::computed(mesh), test::computed(shuffled), order);
}

TEST(ExactFactors, MemoryIsEstimatedAndRefused) {
  const PatchMesh mesh = test::roomWithBlock(4).build();
  FormFactorOptions options = test::exactly();
  Progress silent;
  const FormFactorPlan plan = planFormFactors(mesh, options, silent);
  EXPECT_EQ(plan.method, FormFactorMethod::exact);
  EXPECT_GE(plan.bytes, test::computed(mesh, options).report.matrix_bytes);
  options.memory_limit = 1000;
  EXPECT_THROW(test::computed(mesh, options), RunError);
}

TEST(ExactFactors, APlanOutlivesItsMesh) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  Progress silent;
  for (const auto method : {FormFactorMethod::exact, FormFactorMethod::hemicube}) {
    FormFactorOptions options = test::exactly();
    options.method = method;
    options.resolution = 32;
    options.near_exact = true;
    const FormFactors expected = test::computed(mesh, options);
    auto dies = std::make_unique<PatchMesh>(mesh);
    const FormFactorPlan copied = planFormFactors(*dies, options, silent);
    *dies = PatchMesh();
    dies.reset();
    expectSame(computeFormFactors(copied, silent), expected);
    auto shared = std::make_shared<const PatchMesh>(mesh);
    const FormFactorPlan kept = planFormFactors(shared, options, silent);
    EXPECT_EQ(shared.use_count(), 2);  // not copied
    shared.reset();
    expectSame(computeFormFactors(kept, silent), expected);
  }
  EXPECT_THROW(planFormFactors(std::shared_ptr<const PatchMesh>(), test::exactly(), silent),
               std::logic_error);
}

TEST(ExactFactors, CancelEndsTheRun) {
  struct CancelAtOnce : Progress {
    void advance(std::size_t) override { cancel(); }
  } progress;
  EXPECT_THROW(computeFormFactors(test::roomWithBlock(4).build(), test::exactly(), progress),
               Cancelled);
}

TEST(ExactFactors, AutoReportsItsMethodAndTheReason) {
  Progress silent;
  const PatchMesh mesh = test::roomWithBlock(3).build();
  const FormFactors f = test::computed(mesh, FormFactorOptions());
  EXPECT_EQ(f.method, FormFactorMethod::exact);
  // Exact is taken without a look at rays if it is fast, as it is here.
  EXPECT_EQ(f.report.method_reason.rfind("it takes ", 0), 0u) << f.report.method_reason;
}

TEST(ExactFactors, DegeneratePatchesHaveEmptyRows) {
  PatchMesh mesh = facingPlates(2);
  mesh.area[5] = 0;
  mesh.polygon[5] = kNone;
  mesh.normal[5] = Vec3(0.0);
  const FormFactors f = test::computed(mesh);
  EXPECT_EQ(f.report.empty_rows, 1u);
  EXPECT_EQ(f.fronts[5] + f.backs[5] + f.sky[5] + f.error[5], 0.0);
}

TEST(ExactFactors, EmptyAndSinglePatchMeshesExchangeNothing) {
  const FormFactors none = test::computed(PatchMesh());
  EXPECT_EQ(none.fronts.size(), 0u);
  MeshBuilder builder;
  builder.grid("alone", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const FormFactors one = test::computed(builder.build());
  EXPECT_EQ(one.fronts[0], 0.0);
  EXPECT_EQ(one.sky[0], 1.0);
}

TEST(RowTasks, CoverEveryElementOnceWithoutMixingFacets) {
  const PatchMesh mesh = test::roomWithBlock(9).build();
  const ElementSet elements(mesh);
  const RowTasks tasks(elements);
  Index next = 0;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    for (const ElementRange& range : tasks[t]) {
      EXPECT_EQ(range.first, next);
      EXPECT_EQ(elements.facet[range.first], elements.facet[range.end - 1]);
      next = range.end;
    }
  }
  EXPECT_EQ(next, elements.patch_elements);
  EXPECT_GT(tasks.size(), 8u);
}

TEST(RowTasks, LeadingRowsAreInTasksOfTheirOwn) {
  for (const int patches : {1, 2, 40}) {
    MeshBuilder builder = test::roomWithBlock(9);
    builder.grid("lamp", {0.1, 0.1, 0.9}, {0, 0.1, 0}, {0.8, 0, 0}, 1, patches);
    const PatchMesh mesh = builder.build();
    std::vector<std::uint8_t> flags(mesh.size(), 0);
    std::fill_n(flags.end() - patches, patches, std::uint8_t(1));
    const ElementSet elements(mesh, Progress(), flags);
    ASSERT_EQ(elements.leading_elements, std::size_t(patches));
    const RowTasks tasks(elements);
    std::size_t leads = 0;
    for (; tasks[leads].front().first < elements.leading_elements; ++leads) {
      EXPECT_LE(tasks[leads].back().end, elements.leading_elements);
    }
    EXPECT_GE(leads, std::min<std::size_t>(patches, 16)) << "enough for several threads";
  }
}

TEST(ElementSet, PiecesOfAPatchStandTogether) {
  // Pairs of interlocking L-shaped patches, each cut into two pieces, all over a floor.
  MeshBuilder builder;
  const auto rectangle = [](double x0, double x1, double y0, double y1) {
    return MeshBuilder::Loop{{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
  };
  std::vector<MeshBuilder::Loop> outlines;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) outlines.push_back(rectangle(x, x + 1, y, y + 1));
  }
  builder.polygon("floor", {rectangle(0, 8, 0, 8)}, outlines);
  PatchMesh mesh = builder.build();
  // Make two far apart cells of every eight one patch: as wide an interleaving as there can be.
  const auto patch_count = mesh.size() / 2;
  PatchMesh merged = mesh;
  merged.corner_offset = {0};
  merged.piece_offset = {0};
  merged.corners.clear();
  merged.pieces.clear();
  for (std::size_t i = 0; i < patch_count; ++i) {
    for (const std::size_t cell : {i, i + patch_count}) {
      for (const Index c : mesh.outline(cell)) merged.corners.push_back(c);
      for (std::size_t t = mesh.piece_offset[cell]; t < mesh.piece_offset[cell + 1]; ++t) {
        merged.pieces.push_back(mesh.pieces[t]);
      }
    }
    merged.corner_offset.push_back(merged.corners.size());
    merged.piece_offset.push_back(merged.pieces.size());
    merged.area[i] = mesh.area[i] + mesh.area[i + patch_count];
  }
  merged.area.resize(patch_count);
  for (auto* field : {&merged.polygon, &merged.surface, &merged.index_in_surface, &merged.twin}) {
    field->resize(patch_count);
  }
  merged.centroid.resize(patch_count);
  merged.normal.resize(patch_count);
  merged.side.resize(patch_count);
  const ElementSet elements(merged);
  ASSERT_EQ(elements.patch_elements, 4 * patch_count);
  std::size_t changes = 1;
  for (std::size_t e = 1; e < elements.patch_elements; ++e) {
    if (elements.patch[e] != elements.patch[e - 1]) ++changes;
  }
  EXPECT_EQ(changes, patch_count);
}

/// Exchange areas between surfaces, m^2.
std::vector<double> exchangeOfSurfaces(const Scene& scene, std::size_t patches, double tolerance,
                                       bool& joined) {
  MeshOptions meshing;
  meshing.patches = patches;
  Progress progress;
  const PatchMesh mesh = meshScene(scene, meshing, progress).mesh;
  joined = false;
  for (std::size_t i = 0; i < mesh.size(); ++i) joined |= mesh.outline(i).size() > 4;
  const FormFactors f = test::computed(mesh, test::exactly(tolerance));
  const std::size_t n = mesh.surface_names.size();
  std::vector<double> sum(n * n, 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      sum[mesh.surface[i] * n + mesh.surface[j]] += mesh.area[i] * f.matrix->at(i, j);
    }
  }
  return sum;
}

TEST(ExactFactors, JoinedPatchesExchangeAsMuchAsTheirCells) {
  // The exchange of surfaces does not depend on how they are cut.
  const Scene scene = loadScene(RADIOSITY_SOURCE_DIR "/data/cornell-box-closed.obj");
  bool joined = false;
  const std::vector<double> few = exchangeOfSurfaces(scene, 20, 1e-5, joined);
  ASSERT_TRUE(joined);
  const std::vector<double> many = exchangeOfSurfaces(scene, 300, 1e-5, joined);
  ASSERT_FALSE(joined);
  const double total = std::accumulate(many.begin(), many.end(), 0.0);
  for (std::size_t k = 0; k < few.size(); ++k) {
    // A row is off by about the tolerance; surfaces are many rows.
    EXPECT_NEAR(few[k], many[k], 1e-4 * many[k] + 1e-6 * total) << k;
  }
}

TEST(ErrorSums, FiguresFollowKnownErrors) {
  // Two rows of areas 2 and 1 with G_12 = 0.5, of which an error of 0.01 is stated.
  ErrorSums sums(2);
  std::vector<double> row = {0, 0.5};
  sums.addAndScale(0, row, 0.5);
  EXPECT_EQ(row[1], 0.25);
  sums.addOccluded(0, 1, 0.01);
  const std::vector<double> area = {2, 1};
  std::vector<double> figure(2);
  // The square of a single pair's error scatters by as much again. sum A err^2 = 2 (2 (0.005)^2) +
  // 2 (0.01)^2, sum A F^2 = 2 (0.25)^2 + 0.5^2.
  EXPECT_NEAR(sums.figures(area, 0, figure), std::sqrt(3e-4 / 0.375), 1e-15);
  EXPECT_NEAR(figure[0], 0.005 * std::sqrt(2.0), 1e-16);
  EXPECT_NEAR(figure[1], 0.01 * std::sqrt(2.0), 1e-16);
  // A pair is off by twice the figure of a row that has nothing else: figures are raised to three
  // and a half times what they were.
  sums.addRecheck(0, 1, 2 * 0.01 * std::sqrt(2.0), 0.01);
  EXPECT_NEAR(sums.recheckRatio(), 2.0, 1e-12);
  sums.figures(area, 0, figure);
  EXPECT_NEAR(figure[1], 3.5 * 0.01 * std::sqrt(2.0), 1e-15);
  // Of four equal pairs, 4 err^2, the sum scatters by half of itself.
  ErrorSums many(2);
  for (int k = 0; k < 4; ++k) many.addOccluded(0, 1, 0.01);
  many.figures(area, 0, figure);
  EXPECT_NEAR(figure[1], 0.01 * std::sqrt(6.0), 1e-15);
  // An error below four sevenths of the figure raises nothing.
  ErrorSums calm(2);
  calm.addOccluded(0, 1, 0.01);
  calm.addRecheck(0, 1, -0.008, 0.01);
  calm.figures(area, 0, figure);
  EXPECT_NEAR(figure[1], 0.01 * std::sqrt(2.0), 1e-16);
  // Rows are drawn from all rechecked pairs: if one pair in ten is off by ten times its stated
  // error, rows of one pair meet it.
  ErrorSums mixed(2);
  mixed.addOccluded(0, 1, 0.01);
  for (int k = 0; k < 10; ++k) mixed.addRecheck(0, 1, k == 0 ? 0.1 : 0.001, 0.01);
  EXPECT_NEAR(mixed.recheckRatio(), 10 / std::sqrt(2.0), 1e-12);
  // Rows of small patches count as much as those of large ones: two of four rows, of 16 pairs each,
  // exchange a millionth and are off by ten times the stated error. Of 16 pairs drawn, 8 are theirs
  // on average, and in the worst hundredth of draws 12 to 14: the root of
  // 100 * 12 / 16 / (1 + 1/4), or more; with all of them, of 80.
  ErrorSums unequal(4);
  for (int k = 0; k < 16; ++k) {
    unequal.addOccluded(0, 1, 0.01);
    unequal.addOccluded(2, 3, 1e-8);
    unequal.addRecheck(0, 1, 0.001, 0.01);
    unequal.addRecheck(2, 3, 1e-7, 1e-8);
  }
  EXPECT_GT(unequal.recheckRatio(), std::sqrt(60.0));
  EXPECT_LE(unequal.recheckRatio(), std::sqrt(80.0) * (1 + 1e-12));
  // An error of a black back is one of the row's account of backs, not of the matrix.
  ErrorSums black(2);
  black.addBlackBack(1, 0.01);
  EXPECT_EQ(black.figures(area, 0, figure), 0);
  EXPECT_EQ(figure[0], 0);
  EXPECT_NEAR(figure[1], 0.01 * std::sqrt(2.0), 1e-16);
  // Closed forms: 0.06 of 1e-3 of each value.
  ErrorSums closed(2);
  row = {0, 0.5};
  closed.addAndScale(0, row, 0.5);
  closed.figures(area, 1e-3, figure);
  EXPECT_NEAR(figure[0], 0.06 * 0.25e-3, 1e-16);
}

}  // namespace
}  // namespace radiosity
