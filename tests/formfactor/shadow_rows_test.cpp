// Rows of emitters by shadow rays, against exact ones and closed forms.
#include "formfactor/rays/shadow_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "formfactor/computed_factors.h"
#include "formfactor/exact_scenes.h"
#include "radiosity/exchange_matrix.h"
#include "support/mesh_builder.h"
#include "visibility/clipping/point_to_polygon.h"

namespace radiosity {
namespace {

std::vector<KnownRow> shadowRows(const PatchMesh& mesh, const std::vector<Index>& wanted) {
  Progress quiet;
  return ShadowRows(mesh, wanted, 1).compute(quiet);
}

class ShadowRowsOf : public testing::TestWithParam<const char*> {};

// Each row is held against the exact one to 1e-2, as what all patches see of all emitters.
TEST_P(ShadowRowsOf, AScene) {
  const Scene scene = test::dataScene(GetParam());
  const PatchMesh mesh = test::meshOf(scene, 1000);
  const std::vector<Index> emitters = emittingPatches(mesh, patchMaterials(scene, mesh));
  ASSERT_FALSE(emitters.empty());
  const FormFactors truth = test::computed(mesh, test::exactly(1e-2));
  std::vector<double> seen(mesh.size(), 0.0);
  std::vector<double> squares(mesh.size(), 0.0);
  for (const KnownRow& row : shadowRows(mesh, emitters)) {
    for (const auto& [patch, exchange, error] : row.entries) {
      seen[patch] += exchange / mesh.area[patch];
      squares[patch] += error * error / (mesh.area[patch] * mesh.area[patch]);
    }
  }
  double off = 0;
  double norm = 0;
  std::size_t outside = 0;
  for (Index i = 0; i < mesh.size(); ++i) {
    double whole = 0;
    for (const Index e : emitters) whole += truth.matrix->at(i, e);
    off += mesh.area[i] * (seen[i] - whole) * (seen[i] - whole);
    norm += mesh.area[i] * whole * whole;
    // Three standard errors, and a thousandth for what falls between all points.
    outside += std::abs(seen[i] - whole) > 3 * std::sqrt(squares[i]) + 1e-3 ? 1 : 0;
  }
  // Rays are added until a patch is off by 2% of what it sees.
  EXPECT_LT(std::sqrt(off / norm), 0.02);
  EXPECT_LT(double(outside), 0.01 * double(mesh.size()));
}

INSTANTIATE_TEST_SUITE_P(ShadowRows, ShadowRowsOf,
                         testing::Values("cornell-box-closed", "cluttered", "two-rooms"));

TEST(ShadowRows, OfALampHaveAllThatItSees) {
  const Scene scene = test::dataScene("cornell-box-closed");
  const PatchMesh mesh = test::meshOf(scene, 600);
  const std::vector<Index> emitters = emittingPatches(mesh, patchMaterials(scene, mesh));
  for (const KnownRow& row : shadowRows(mesh, emitters)) {
    double sum = 0;
    for (const KnownExchange& entry : row.entries) sum += entry.exchange;
    for (const SeenBack& back : row.backs) sum += back.share * mesh.area[row.patch];
    // Of some 600 patches, each off by 2% of what it sees of all emitters at most.
    EXPECT_NEAR(sum / mesh.area[row.patch], 1, 0.01);
  }
}

TEST(ShadowRows, HaveTheSameBitsForAnyThreads) {
  const Scene scene = test::dataScene("cluttered");
  const PatchMesh mesh = test::meshOf(scene, 300);
  const std::vector<Index> emitters = emittingPatches(mesh, patchMaterials(scene, mesh));
  setThreads(1);
  const std::vector<KnownRow> one = shadowRows(mesh, emitters);
  setThreads(0);
  const std::vector<KnownRow> all = shadowRows(mesh, emitters);
  ASSERT_EQ(one.size(), all.size());
  for (std::size_t r = 0; r < one.size(); ++r) {
    ASSERT_EQ(one[r].entries.size(), all[r].entries.size());
    for (std::size_t e = 0; e < one[r].entries.size(); ++e) {
      EXPECT_EQ(one[r].entries[e].exchange, all[r].entries[e].exchange);
    }
  }
}

/// What a lamp at height 1, 2 to 3 along both axes, gives to a point of the floor past the edge x =
/// 2.5 of a plate at half its height: light comes from beyond the edge's image at 5 - x.
double pastTheEdge(const Vec3& at) {
  const double from = std::clamp(5 - at.x, 2.0, 3.0);
  if (from >= 3) return 0;
  const std::vector<Vec3> outline{{from, 2, 1}, {from, 3, 1}, {3, 3, 1}, {3, 2, 1}};
  return pointToPolygon(at, {0, 0, 1}, outline);
}

// Of 400 patches of a lamp each has two rays of a patch at first. Those that few rays happen to
// miss must not stay unseen: half shadows would be too dark.
TEST(ShadowRows, OfAHalfShadowAreNotBiased) {
  test::MeshBuilder builder;
  builder.grid("floor", {2, 2, 0}, {1, 0, 0}, {0, 1, 0}, 10, 10);
  builder.grid("plate", {-9, -9, .5}, {11.5, 0, 0}, {0, 23, 0}, 1, 1, true);
  for (const int parts : {1, 5, 20}) {
    test::MeshBuilder with = builder;
    with.grid("lamp", {2, 2, 1}, {0, 1, 0}, {1, 0, 0}, parts, parts);
    const PatchMesh mesh = with.build();
    std::vector<Index> emitters;
    for (Index i = 0; i < mesh.size(); ++i) {
      if (mesh.surface_names[mesh.surface[i]] == "lamp") emitters.push_back(i);
    }
    std::vector<double> seen(mesh.size(), 0.0);
    for (const KnownRow& row : shadowRows(mesh, emitters)) {
      for (const KnownExchange& entry : row.entries) {
        seen[entry.patch] += entry.exchange / mesh.area[entry.patch];
      }
    }
    double sum = 0;
    double whole = 0;
    for (Index i = 0; i < mesh.size(); ++i) {
      if (mesh.surface_names[mesh.surface[i]] != "floor") continue;
      double mean = 0;
      for (int x = 0; x < 10; ++x) {
        for (int y = 0; y < 10; ++y) {
          mean += pastTheEdge(mesh.centroid[i] + Vec3(.01 * x - .045, .01 * y - .045, 0)) / 100;
        }
      }
      // 2% of what it sees, or .2% of what it would see, three times; a lamp of 1 m^2 at 1 m fills
      // a quarter of the view at most.
      EXPECT_NEAR(seen[i], mean, 3 * std::max(.02 * mean, .002 * .25)) << parts << " " << i;
      sum += seen[i];
      whole += mean;
    }
    // Errors of a hundred patches cancel, but for a bias.
    EXPECT_NEAR(sum / whole, 1, 0.005) << parts;
  }
}

// 400 patches of a lamp and 2,500 below are more pairs than exact rows may have.
TEST(ShadowRows, AreTakenWhereExactOnesAreTooMuch) {
  test::MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {5, 0, 0}, {0, 5, 0}, 50, 50);
  builder.grid("lamp", {2, 2, 1}, {0, 1, 0}, {1, 0, 0}, 20, 20);
  const PatchMesh mesh = builder.build();
  std::vector<Index> emitters;
  for (Index i = 0; i < mesh.size(); ++i) {
    if (mesh.surface_names[mesh.surface[i]] == "lamp") emitters.push_back(i);
  }
  ASSERT_EQ(emitters.size(), 400u);
  for (const FormFactorMethod method : {FormFactorMethod::rays, FormFactorMethod::cut}) {
    FormFactorOptions options;
    options.method = method;
    options.tolerance = 0.1;
    options.exact_rows = emitters;
    const FormFactors f = test::computed(mesh, options);
    EXPECT_EQ(f.report.shadow_rows, 400u);
    EXPECT_FALSE(f.report.exact_rows);
    EXPECT_TRUE(std::ranges::any_of(f.report.notes, [](const Note& note) {
      return note.text.find("by shadow rays") != std::string::npos;
    }));
    std::vector<double> lamp(mesh.size(), 0.0);
    for (const Index e : emitters) lamp[e] = 1;
    std::vector<double> irradiance(mesh.size());
    f.matrix->product(lamp, 1, irradiance);
    const std::vector<Vec3> outline{{2, 2, 1}, {2, 3, 1}, {3, 3, 1}, {3, 2, 1}};
    for (Index i = 0; i < mesh.size(); ++i) {
      if (lamp[i] > 0) continue;
      // Patches of a tenth of the distance: the middle is within .2% of the mean.
      const double whole = pointToPolygon(mesh.centroid[i], mesh.normal[i], outline);
      EXPECT_NEAR(irradiance[i], whole, 0.01 * whole);
    }
  }
}

}  // namespace
}  // namespace radiosity
