// Partly visible pairs: obstructed plates of known exchange, groups of targets against the exact
// clipper, and error figures against the truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "formfactor/exact/assembly/error_figure.h"
#include "formfactor/exact/occluded/occluded_pairs.h"
#include "formfactor/exact/occluded/pair_sampling.h"
#include "formfactor/exact/unoccluded/unoccluded.h"
#include "formfactor/exact/visibility/visibility.h"
#include "occluder_builder.h"
#include "support/mesh_builder.h"
#include "truth/ground_truth.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

/// A mesh with the exact method's data and its partly visible pairs.
struct PairsCase : VisibilitySink {
  explicit PairsCase(PatchMesh given)
      : mesh(std::move(given)),
        elements(mesh),
        occluders(mesh, elements),
        exact(elements, 1e-10, true) {
    const Visibility visibility(elements, occluders);
    VisibilityCounts counts;
    for (const Facet& facet : elements.facets) {
      if (!facet.black) visibility.classify(facet.elements, *this, counts);
    }
  }
  void unoccluded(ElementRange rows, ElementRange columns) override {
    for (Index r = rows.first; r < rows.end; ++r) {
      for (Index c = columns.first; c < columns.end; ++c) open.push_back({r, c, exact.pair(r, c)});
    }
  }
  void occluded(Index row, Index column, std::span<const Index> blockers) override {
    const auto begin = std::uint32_t(list.size());
    list.insert(list.end(), blockers.begin(), blockers.end());
    pairs.push_back({row, column, begin, std::uint32_t(list.size()), exact.pair(row, column)});
  }
  std::vector<OccludedExchange> evaluate(double tolerance, OccludedCounts& counts,
                                         bool simd = true) const {
    std::vector<OccludedExchange> out(pairs.size());
    OccludedKernel(elements, occluders, tolerance, simd).evaluate(pairs, list, out, counts);
    return out;
  }

  PatchMesh mesh;
  ElementSet elements;
  OccluderSet occluders;
  UnoccludedKernel exact;
  std::vector<OccludedPair> pairs;
  std::vector<Index> list;
  struct Open {
    Index row, column;
    double exchange;
  };
  std::vector<Open> open;  ///< with nothing in between
};

/// Unit plates at z = 0 and z = 1 that face each other, n x n patches each.
MeshBuilder plates(int n) {
  MeshBuilder builder;
  builder.grid("lower", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  builder.grid("upper", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n);
  return builder;
}

/// Form factor from plate to plate past a sheet [x0, x1] x [y0, y1] at half height.
double pastSheet(double x0, double x1, double y0, double y1, double tolerance) {
  MeshBuilder builder = plates(8);
  builder.grid("sheet", {x0, y0, 0.5}, {x1 - x0, 0, 0}, {0, y1 - y0, 0}, 1, 1, true);
  const PairsCase scene(builder.build());
  // Pairs with the sheet, the third surface, are no part of the sum.
  double sum = 0;
  const auto plate = [&](Index e) { return scene.mesh.surface[scene.elements.patch[e]] < 2; };
  for (const PairsCase::Open& pair : scene.open) {
    if (plate(pair.row) && plate(pair.column)) sum += pair.exchange;
  }
  OccludedCounts counts;
  const auto found = scene.evaluate(tolerance, counts);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (plate(scene.pairs[k].row) && plate(scene.pairs[k].column)) sum += found[k].exchange;
  }
  return sum / (scene.elements.scale * scene.elements.scale);
}

struct Sheet {
  double x0, x1, y0, y1;
  double form_factor;
};

TEST(OccludedPairs, PlatesPastASheetHaveTheirClosedForms) {
  // Closed forms: the aperture's and the obstructed form factor add up to that of the plates, and
  // the aperture's follows from those of rectangles. Tolerance 1e-7 of 1/N, N = 129: errors of
  // some 1500 occluded pairs, each 20 times that at most and of either sign, are below 1e-6 in sum.
  const std::vector<Sheet> sheets = {
      {0, 0.5, 0, 0.5, 0.149868671773790},       {0, 0.5, 0, 1, 0.0999124478491937},
      {0.45, 0.55, 0.45, 0.55, 0.1945396236482}, {0.375, 0.625, 0.375, 0.625, 0.1694742049118},
      {0.25, 0.75, 0.25, 0.75, 0.0995062945990}, {0.125, 0.875, 0.125, 0.875, 0.0294835449148},
      {0.05, 0.95, 0.05, 0.95, 0.0049533100175}, {0.25, 0.75, 0, 1, 0.0583268459018}};
  for (const Sheet& sheet : sheets) {
    EXPECT_NEAR(pastSheet(sheet.x0, sheet.x1, sheet.y0, sheet.y1, 1e-7), sheet.form_factor, 1e-6)
        << sheet.x0 << ' ' << sheet.y0;
  }
}

/// A room with blocks of several sizes, some of them turned: everything sees everything past
/// several of them.
PatchMesh clutteredRoom(int n) {
  MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, n, true);
  for (int k = 0; k < 12; ++k) {
    const double a = 2.4 * k;
    const double size = 0.06 + 0.01 * (k % 5);
    const Vec3 middle(0.5 + 0.32 * std::cos(a), 0.5 + 0.32 * std::sin(a), 0.15 + 0.06 * k);
    const Vec3 u = size * Vec3(std::cos(a / 3), std::sin(a / 3), 0);
    const Vec3 v = size * Vec3(-std::sin(a / 3), std::cos(a / 3), 0);
    const Vec3 w = size * Vec3(0, 0, 1.5);
    const std::string name = "block " + std::to_string(k);
    builder.grid(name, middle + w, u, v, 1, 1);
    builder.grid(name, middle, v, u, 1, 1);
    builder.grid(name, middle, u, w, 1, 1);
    builder.grid(name, middle + v, w, u, 1, 1);
    builder.grid(name, middle, w, v, 1, 1);
    builder.grid(name, middle + u, v, w, 1, 1);
  }
  return builder.build();
}

TEST(OccludedPairs, ExchangeStaysBetweenZeroAndUnoccluded) {
  const PairsCase scene(clutteredRoom(3));
  for (const double tolerance : {1e-3, 1e-4}) {
    OccludedCounts counts;
    const auto found = scene.evaluate(tolerance, counts);
    EXPECT_EQ(counts.pairs, scene.pairs.size());
    EXPECT_GT(counts.subdivided, 0u);
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_GE(found[k].exchange, 0);
      ASSERT_LE(found[k].exchange, scene.pairs[k].unoccluded);
      ASSERT_GE(found[k].error, 0);
    }
  }
}

TEST(OccludedPairs, VectorsAndBatchesChangeNothing) {
  const PairsCase scene(clutteredRoom(3));
  for (const double tolerance : {1e-3, 1e-4}) {
    OccludedCounts counts;
    const auto vectors = scene.evaluate(tolerance, counts);
    const auto scalar = scene.evaluate(tolerance, counts, false);
    const OccludedKernel kernel(scene.elements, scene.occluders, tolerance, true);
    for (std::size_t k = 0; k < vectors.size(); ++k) {
      ASSERT_EQ(vectors[k].exchange, scalar[k].exchange);
      ASSERT_EQ(vectors[k].error, scalar[k].error);
      if (k % 16 != 0) continue;
      OccludedExchange alone;
      kernel.evaluate(std::span(&scene.pairs[k], 1), scene.list, std::span(&alone, 1), counts);
      ASSERT_EQ(vectors[k].exchange, alone.exchange);
      ASSERT_EQ(vectors[k].error, alone.error);
    }
  }
}

TEST(OccludedPairs, StricterEvaluationConfirmsStatedErrors) {
  const PairsCase scene(clutteredRoom(2));
  for (const double tolerance : {1e-2, 1e-4}) {
    OccludedCounts counts;
    const auto found = scene.evaluate(tolerance, counts);
    const OccludedKernel kernel(scene.elements, scene.occluders, tolerance, true);
    std::vector<OccludedExchange> strict(found.size());
    kernel.evaluateStrictly(scene.pairs, scene.list, strict);
    double difference2 = 0;
    double stated2 = 0;
    double strictly_stated2 = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double d = strict[k].exchange - found[k].exchange;
      difference2 += d * d;
      stated2 += found[k].error * found[k].error;
      strictly_stated2 += strict[k].error * strict[k].error;
    }
    EXPECT_GT(difference2, 0);
    EXPECT_LE(difference2, stated2);
    // Its own error is a good deal below the error that it checks.
    EXPECT_LE(strictly_stated2, 0.1 * stated2);
  }
}

/// A square in the plane z = height about (x, y), facing up or down.
void square(MeshBuilder& builder, const std::string& name, double x, double y, double height,
            double side, bool up, bool two_sided = false) {
  const Vec3 corner(x - side / 2, y - side / 2, height);
  const Vec3 u(side, 0, 0);
  const Vec3 v(0, side, 0);
  builder.grid(name, corner, up ? u : v, up ? v : u, 1, 1, two_sided);
}

/// The pair of the first two surfaces.
const OccludedPair& firstPair(const PairsCase& scene) {
  for (const OccludedPair& pair : scene.pairs) {
    if (scene.mesh.surface[scene.elements.patch[pair.row]] +
            scene.mesh.surface[scene.elements.patch[pair.column]] ==
        1) {
      return pair;
    }
  }
  throw std::logic_error("the pair is not occluded");
}

TEST(OccludedPairs, PointsAreTakenOnTheEndWithSlowerShadows) {
  // A small plate closely beside an occluder, and a large one, farther in its own size from the
  // nearest edge of another: but from there the small one is seen past that or not, in a step.
  MeshBuilder builder;
  square(builder, "large", 0, 0, 0, 1, true);
  square(builder, "small", 0.1, 0.07, 1, 0.02, false);
  square(builder, "beside the large", 0.9, 0.1, 0.1, 1.1, true, true);
  square(builder, "beside the small", 0.15, 0.07, 0.997, 0.1, true, true);
  const PairsCase scene(builder.build());
  const OccludedPair& pair = firstPair(scene);
  const EdgeDistances distances(scene.elements, scene.occluders);
  PairPreparation ready(scene.elements, scene.occluders, distances);
  ready.prepare(std::span(&pair, 1), scene.list, SampledEnd::calmer);
  const SampledPair calmer = ready.pairs.at(0);
  ready.prepare(std::span(&pair, 1), scene.list, SampledEnd::restless);
  const SampledPair restless = ready.pairs.at(0);
  EXPECT_EQ(scene.mesh.surface[scene.elements.patch[calmer.sampled]], 1);
  EXPECT_EQ(restless.sampled, calmer.target);
  EXPECT_LT(calmer.change, restless.change);
}

/// A square of side .5, a strip of .05 by 1 facing it from a height of 2, along y or x, and between
/// them a half plane, or nearly so, that ends in x = `edge`, parallel to y.
PairsCase stripPastAnEdge(bool along_edge, double edge) {
  MeshBuilder builder;
  square(builder, "square", 0, 0, 0, 0.5, true);
  const Vec3 half = along_edge ? Vec3(0.025, 0.5, 0) : Vec3(0.5, 0.025, 0);
  const Vec3 u(2 * half.x, 0, 0);
  const Vec3 v(0, 2 * half.y, 0);
  builder.grid("strip", Vec3(0, 0, 2) - half, v, u, 1, 1, false);
  builder.grid("half plane", {edge - 9, -9, 1}, {9, 0, 0}, {0, 18, 0}, 1, 1, true);
  return PairsCase(builder.build());
}

double changeOf(const PairsCase& scene) {
  const EdgeDistances distances(scene.elements, scene.occluders);
  PairPreparation ready(scene.elements, scene.occluders, distances);
  double change = 0;
  // With the points on the square.
  for (const SampledEnd end : {SampledEnd::calmer, SampledEnd::restless}) {
    ready.prepare(std::span(&firstPair(scene), 1), scene.list, end);
    const SampledPair& pair = ready.pairs.at(0);
    if (scene.mesh.surface[scene.elements.patch[pair.sampled]] == 0) change = pair.change;
  }
  return change;
}

TEST(OccludedPairs, ShadowsMoveAcrossTheWidthOfANarrowTarget) {
  // Midway the edge's shadow moves as far as the eye, by .5: ten widths of the strip. If the strip
  // is turned, it moves along it, by half its length; the nearest edge alone says a bit more.
  EXPECT_NEAR(changeOf(stripPastAnEdge(true, 0)), 10, 0.1);
  EXPECT_GT(changeOf(stripPastAnEdge(false, 0)), 0.5);
  EXPECT_LT(changeOf(stripPastAnEdge(false, 0)), 1.5);
}

TEST(OccludedPairs, AShadowThatSlipsPastTheSamplesOfANarrowTargetIsStated) {
  // The strip is hidden from the outer tenth of the square, beyond all points of the first rule.
  for (const double hidden : {0.03, 0.05, 0.07}) {
    const PairsCase scene = stripPastAnEdge(true, 0.5 * (hidden - 0.275));
    OccludedExchange found;
    OccludedCounts counts;
    OccludedKernel(scene.elements, scene.occluders, 0.1, true)
        .evaluate(std::span(&firstPair(scene), 1), scene.list, std::span(&found, 1), counts);
    const double area = scene.elements.scale * scene.elements.scale;
    const truth::GroundTruth truth(scene.mesh, {});
    const double error =
        std::abs(found.exchange / area - scene.mesh.area[0] * truth.formFactor(0, 1));
    EXPECT_LT(error, found.error / area) << hidden;
  }
}

TEST(OccludedPairs, ErrorOfFarKernelsIsStated) {
  // A target some of its radii away, to one side, part of it behind a straight edge: no kink
  // between the points, and at loose tolerances kernels that expand about the target's middle. The
  // stated error is a root mean square over targets, with a margin of 2.55: 4 times the error here.
  for (const double away : {1.2, 1.6, 2.4}) {
    MeshBuilder builder;
    square(builder, "small", 0, 0, 0, 0.02, true);
    square(builder, "large", away, 0.1, away, 1, false);
    builder.grid("edge", {away / 2, -3, away / 2}, {3, 0, 0}, {0, 6, 0}, 1, 1, true);
    const PairsCase scene(builder.build());
    const OccludedPair& pair = firstPair(scene);
    const double area = scene.elements.scale * scene.elements.scale;
    const truth::GroundTruth truth(scene.mesh, {});
    const double exchange = scene.mesh.area[0] * truth.formFactor(0, 1);
    OccludedExchange found;
    OccludedCounts counts;
    OccludedKernel(scene.elements, scene.occluders, 0.1, true)
        .evaluate(std::span(&pair, 1), scene.list, std::span(&found, 1), counts);
    const double error = std::abs(found.exchange / area - exchange);
    EXPECT_LT(error, found.error / area) << away;
    EXPECT_LT(found.error / area, 10 * error) << away;
  }
}

/// The patch whose middle is nearest to a point.
Index patchAt(const PatchMesh& mesh, const Vec3& point) {
  Index nearest = 0;
  for (Index k = 1; k < mesh.size(); ++k) {
    const double before = glm::distance(mesh.centroid[nearest], point);
    if (glm::distance(mesh.centroid[k], point) < before) nearest = k;
  }
  return nearest;
}

TEST(OccludedPairs, APairThatIsCutShortAtOneEndIsEvaluatedFromTheOther) {
  // Two walls past two blocks. From the end along which shadows move less, cells are halved until
  // the pair has had all points that it may take, and it is off by 1%. From the other end a
  // thousand points between critical lines do.
  MeshOptions options;
  options.patches = 120;
  Progress silent;
  const Scene box = loadScene(RADIOSITY_SOURCE_DIR "/data/cornell-box-closed.obj");
  const PairsCase scene(meshScene(box, options, silent).mesh);
  const Index a = patchAt(scene.mesh, {0.555, 0.373, 0.169});
  const Index b = patchAt(scene.mesh, {0.0, 0.091, 0.210});
  const auto pair = std::find_if(scene.pairs.begin(), scene.pairs.end(), [&](const auto& p) {
    const Index row = scene.elements.patch[p.row];
    const Index column = scene.elements.patch[p.column];
    return (row == a && column == b) || (row == b && column == a);
  });
  ASSERT_NE(pair, scene.pairs.end());
  OccludedExchange found;
  OccludedCounts counts;
  OccludedKernel(scene.elements, scene.occluders, 1e-7, true)
      .evaluate(std::span(&*pair, 1), scene.list, std::span(&found, 1), counts);
  const double exchange = scene.mesh.area[a] * truth::GroundTruth(scene.mesh).formFactor(a, b);
  const double area = scene.elements.scale * scene.elements.scale;
  EXPECT_FALSE(found.cut_short);
  EXPECT_LT(found.error / area, 1e-6 * exchange);
  // Truth is good to 1e-7 of the mean form factor, of which this is about a half.
  EXPECT_NEAR(found.exchange / area, exchange, found.error / area + 1e-6 * exchange);
}

/// Every so many rows of a mesh, true.
struct TrueRows {
  TrueRows(const PairsCase& scene, std::size_t every) {
    truth::TruthOptions options;
    options.accuracy = 1e-5;
    const truth::GroundTruth truth(scene.mesh, options);
    for (std::size_t row = 0; row < scene.elements.patch_elements; row += every) {
      elements.push_back(Index(row));
      form_factors.push_back(truth.row(scene.elements.patch[row]).form_factors);
    }
  }
  std::vector<Index> elements;
  std::vector<std::vector<double>> form_factors;
};

/// The true errors of entries, and the stated ones.
struct RowErrors {
  double relative = 0;      ///< area-weighted, of all rows
  std::size_t below = 0;    ///< rows whose true error is below its figure
  double median_ratio = 0;  ///< figure over true error
};

RowErrors compareRows(const PairsCase& scene, const TrueRows& rows, double tolerance) {
  OccludedCounts counts;
  const auto found = scene.evaluate(tolerance, counts);
  std::vector<double> figure(scene.elements.patch_elements);
  ErrorSums sums(figure.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const OccludedPair& pair = scene.pairs[k];
    if (pair.column < figure.size()) sums.addOccluded(pair.row, pair.column, found[k].error);
  }
  sums.figures(std::span(scene.elements.area).first(figure.size()), 0, figure);
  RowErrors errors;
  double error2 = 0;
  double all2 = 0;
  std::vector<double> ratios;
  for (std::size_t r = 0; r < rows.elements.size(); ++r) {
    const Index row = rows.elements[r];
    const double area = scene.elements.area[row];
    double row2 = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const OccludedPair& pair = scene.pairs[k];
      if (pair.row != row && pair.column != row) continue;
      const Index other = pair.row == row ? pair.column : pair.row;
      if (other >= scene.elements.patch_elements) continue;
      const double d = found[k].exchange / area - rows.form_factors[r][scene.elements.patch[other]];
      row2 += d * d;
    }
    for (const double f : rows.form_factors[r]) all2 += f * f * area;
    error2 += row2 * area;
    errors.below += std::sqrt(row2) <= figure[row];
    if (row2 > 0) ratios.push_back(figure[row] / std::sqrt(row2));
  }
  errors.relative = std::sqrt(error2 / all2);
  std::nth_element(ratios.begin(), ratios.begin() + std::ptrdiff_t(ratios.size() / 2),
                   ratios.end());
  errors.median_ratio = ratios[ratios.size() / 2];
  return errors;
}

TEST(OccludedPairs, RowsKeepTheToleranceAndTheirFigures) {
  // One block in a room, and twelve. The tolerance is for the root mean square over a row's
  // entries in mean form factors, which is less than theirs. It is met if a tenth of the pairs are
  // occluded; among twelve blocks nearly all are: three times it is asserted. Figures are above the
  // error in every row of the sample, and within ten times it in half of them; within twenty, if
  // large patches past many blocks leave much to guess.
  const PairsCase block(test::roomWithBlock(3).build());
  const PairsCase clutter(clutteredRoom(3));
  for (const PairsCase* scene : {&block, &clutter}) {
    const TrueRows rows(*scene, 13);
    for (const double tolerance : {1e-3, 1e-4}) {
      const RowErrors errors = compareRows(*scene, rows, tolerance);
      EXPECT_LT(errors.relative, (scene == &block ? 1 : 3) * tolerance) << tolerance;
      EXPECT_EQ(errors.below, rows.elements.size()) << tolerance;
      EXPECT_LT(errors.median_ratio, scene == &block ? 10 : 20) << tolerance;
    }
  }
}

}  // namespace
}  // namespace radiosity
