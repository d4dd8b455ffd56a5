// The exact method through the public interface, against the ground truth, which shares no code
// with it: errors, the figures it states for them, and meshes made elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exact_scenes.h"
#include "formfactor/computed_factors.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/scene.h"
#include "support/scene_builder.h"
#include "truth/ground_truth.h"

namespace radiosity {
namespace {

struct SampledScore {
  double rel_l2 = 0;          ///< area-weighted, over the rows looked at
  double median_ratio = 0;    ///< median error figure / median true error
  std::size_t uncovered = 0;  ///< rows whose true error is above their figure
  std::size_t rows = 0;
};

SampledScore score(const PatchMesh& mesh, const FormFactors& f, std::size_t rows,
                   double tolerance = 1e-3) {
  truth::TruthOptions options;
  options.accuracy = std::min(1e-5, 1e-2 * tolerance);  // a hundredth of the judged error
  const truth::GroundTruth truth(mesh, options);
  SampledScore s;
  double off = 0;
  double all = 0;
  std::vector<double> figures;
  std::vector<double> errors;
  for (std::size_t k = 0; k < rows; ++k) {
    const std::size_t i = (2 * k + 1) * mesh.size() / (2 * rows);
    std::vector<double> row(mesh.size(), 0.0);
    pairsOf(*f.matrix).forRow(i, [&](Index j, double value) { row[j] = value; });
    const std::vector<double> true_row = truth.row(i).form_factors;
    double square = 0;
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      square += (row[j] - true_row[j]) * (row[j] - true_row[j]);
      all += mesh.area[i] * true_row[j] * true_row[j];
    }
    off += mesh.area[i] * square;
    errors.push_back(std::sqrt(square));
    figures.push_back(f.error[i]);
    s.uncovered += errors.back() > figures.back();
  }
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  s.rel_l2 = std::sqrt(off / all);
  s.median_ratio = median(figures) / median(errors);
  s.rows = rows;
  return s;
}

/// A mesh in the accounts of the exact method and of the truth, computed once for all tests.
struct Judged {
  std::string name;
  PatchMesh mesh;
  FormFactors factors;
  SampledScore score;
};

const std::vector<Judged>& judged() {
  static const std::vector<Judged> all = [] {
    std::vector<Judged> list;
    const auto add = [&](const std::string& name, PatchMesh mesh, std::size_t rows) {
      list.push_back({name, std::move(mesh), {}, {}});
      list.back().factors = test::exactInDouble(list.back().mesh);
      list.back().score = score(list.back().mesh, list.back().factors, rows);
    };
    add("closed Cornell box", test::meshOf(test::dataScene("cornell-box-closed"), 1000), 60);
    add("two rooms", test::meshOf(test::dataScene("two-rooms"), 600), 40);
    add("faces as patches",
        test::meshOf(test::sceneOfPatches(list[0].mesh, test::dataScene("cornell-box-closed")), 1,
                     true),
        20);
    return list;
  }();
  return all;
}

TEST(ExactAgainstTruth, TheDefaultToleranceBoundsTheRelativeError) {
  for (const Judged& j : judged()) {
    RecordProperty("relL2 of " + j.name, std::to_string(j.score.rel_l2));
    EXPECT_LE(j.score.rel_l2, 5e-4) << j.name;
  }
}

TEST(ExactAgainstTruth, ErrorFiguresCoverTheErrorsAndAreNotMuchLarger) {
  std::size_t uncovered = 0;
  for (const Judged& j : judged()) {
    RecordProperty("uncovered of " + j.name, std::to_string(j.score.uncovered));
    RecordProperty("figure over error, " + j.name, std::to_string(j.score.median_ratio));
    EXPECT_LE(j.score.median_ratio, 10) << j.name;
    uncovered += j.score.uncovered;
  }
  // Of 120 rows 1.2 may be uncovered on average; 4 or fewer are with a probability of 99%.
  EXPECT_LE(uncovered, 4u);
}

/// A blind of slats `tilt` radians from the level, between a floor and a wall, and what is outside
/// of it; all is seen from both sides.
Scene blind(double tilt) {
  test::SceneBuilder builder;
  const Index all = builder.surface("all", 0.5, 0, true);
  builder.level(all, 0, 0, 2.74, 2.64, 0);
  builder.face(all, {{2.74, 0, 0}, {2.74, 0, 1.43}, {2.74, 2.64, 1.43}, {2.74, 2.64, 0}});
  builder.face(all, {{-0.71, 0, 0}, {-0.71, 2.64, 0}, {-0.71, 2.64, 1.43}, {-0.71, 0, 1.43}});
  const Vec3 along(0, 2.376, 0);
  const Vec3 across(0.1126 * std::cos(tilt), 0, 0.1126 * std::sin(tilt));
  for (int k = 0; k < 14; ++k) {
    const Vec3 at = Vec3(0, 0.132, 0.045 + 0.0967 * k + 0.5 * std::abs(across.z)) - 0.5 * across;
    builder.face(all, {at, at + across, at + across + along, at + along});
  }
  return builder.scene();
}

TEST(ExactAgainstTruth, ErrorFiguresCoverShadowsOfSlats) {
  for (const Scene& scene : {blind(0.5), test::turned(blind(0.5)), blind(0.7)}) {
    const PatchMesh mesh = test::meshOf(scene, 300);
    const FormFactors f = test::exactInDouble(mesh, 1e-3);
    const FormFactors better = test::exactInDouble(mesh, 1e-4);
    std::size_t uncovered = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      double square = 0;
      for (std::size_t j = 0; j < mesh.size(); ++j) {
        const double off = f.matrix->at(i, j) - better.matrix->at(i, j);
        square += off * off;
      }
      const double error = std::sqrt(square);
      EXPECT_LE(error, 2 * f.error[i]) << i;
      uncovered += error > f.error[i];
    }
    // 1% of rows.
    EXPECT_LE(uncovered, mesh.size() / 100);
  }
}

TEST(ExactAgainstTruth, ATighterToleranceLowersTheError) {
  const PatchMesh mesh = test::meshOf(test::dataScene("cornell-box-closed"), 300);
  double previous = 1;
  for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
    const SampledScore s = score(mesh, test::exactInDouble(mesh, tolerance), 20, tolerance);
    EXPECT_LT(s.rel_l2, 0.5 * previous) << tolerance;
    // Single entries may be off by ten tolerances times the mean form factor, which is below the
    // root mean square of a row.
    EXPECT_LT(s.rel_l2, 10 * tolerance) << tolerance;
    previous = s.rel_l2;
  }
}

TEST(ExactAgainstTruth, FacesAsPatchesAreTheSamePatches) {
  const Judged& own = judged()[0];
  const Judged& faces = judged()[2];
  ASSERT_EQ(faces.mesh.size(), own.mesh.size());
  EXPECT_EQ(faces.factors.report.exact.solids, own.factors.report.exact.solids);
  EXPECT_EQ(faces.factors.report.exact.occluded, own.factors.report.exact.occluded);
  // Patch k is face k. A row's error is at most twice its figure (tests/property), in either
  // matrix. All values but one in 10^5 are within ten tolerances of the truth, so that two are
  // within twenty.
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < own.mesh.size(); i += 7) {
    double square = 0;
    for (std::size_t j = 0; j < own.mesh.size(); ++j) {
      const double apart = faces.factors.matrix->at(i, j) - own.factors.matrix->at(i, j);
      square += apart * apart;
      beyond += std::abs(apart) > 0.02 / double(own.mesh.size()) ? 1 : 0;
    }
    EXPECT_LE(std::sqrt(square), 2 * (faces.factors.error[i] + own.factors.error[i])) << i;
  }
  EXPECT_LE(double(beyond), 1e-5 * double(own.mesh.size()) * double(own.mesh.size()) / 7);
}

}  // namespace
}  // namespace radiosity
