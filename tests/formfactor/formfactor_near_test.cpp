// The near-pair correction of hemicubes against area-to-area form factors.
#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

FormFactors computeNear(const PatchMesh& mesh, FormFactorMethod method, bool near_exact) {
  FormFactorOptions options;
  options.method = method;
  options.near_exact = near_exact;
  options.precision = Precision::double_precision;
  options.tolerance = 1e-4;  // far below the errors of hemicubes
  Progress silent;
  return computeFormFactors(mesh, options, silent);
}

/// Area-weighted relL2 of a against b.
double difference(const PatchMesh& mesh, const FormFactors& a, const FormFactors& b) {
  double off = 0;
  double all = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      const double truth = b.matrix->at(i, j);
      off += mesh.area[i] * std::pow(a.matrix->at(i, j) - truth, 2);
      all += mesh.area[i] * truth * truth;
    }
  }
  return std::sqrt(off / all);
}

TEST(NearPairs, PlatesOfOnePatchHaveTheirClosedForm) {
  // Howell C-11, gap 0.1 and 1: the plates are near each other everywhere.
  for (const auto& [gap, value] : {std::pair(0.1, 0.826994522397257), {1.0, 0.199824895698387}}) {
    MeshBuilder builder;
    builder.grid("low", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    builder.grid("high", {0, 0, gap}, {0, 1, 0}, {1, 0, 0});
    const FormFactors f = computeNear(builder.build(), FormFactorMethod::hemicube, true);
    EXPECT_EQ(f.report.hemicube.near_pairs, 2u);
    EXPECT_NEAR(f.matrix->at(0, 1), value, 1e-5 * value);
    EXPECT_NEAR(f.sky[0], 1 - value, 1e-5);
  }
}

TEST(NearPairs, AWholeRoomGetsBetterAndStaysClosed) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  const FormFactors exact = computeNear(mesh, FormFactorMethod::exact, false);
  const FormFactors plain = computeNear(mesh, FormFactorMethod::hemicube, false);
  const FormFactors corrected = computeNear(mesh, FormFactorMethod::hemicube, true);
  // A single point is off by per cents next to an edge; the rest is occluded or less near.
  EXPECT_LT(difference(mesh, corrected, exact), 0.4 * difference(mesh, plain, exact));
  EXPECT_LE(corrected.report.largest_row_error, 1e-12);  // sums of at most 200 terms
  EXPECT_EQ(corrected.report.hemicube.capped, 0u);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_NEAR(corrected.fronts[i], 1, 1e-12);
    for (std::size_t j = 0; j < mesh.size(); ++j) EXPECT_GE(corrected.matrix->at(i, j), 0);
  }
}

TEST(NearPairs, AreOffByDefault) {
  const FormFactors f = computeNear(test::roomWithBlock(2).build(), FormFactorMethod::hemicube,
                                    FormFactorOptions().near_exact);
  EXPECT_EQ(f.report.hemicube.near_pairs, 0u);
}

}  // namespace
}  // namespace radiosity
