// Form factors between named surfaces, against closed forms and sums made by hand.
#include "radiosity/tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "formfactor/computed_factors.h"
#include "radiosity/row_matrix.h"
#include "support/error_of.h"
#include "support/mesh_builder.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

using test::errorOf;
using test::MeshBuilder;

class Tables : public FolderTest {};

/// The inside of the unit cube, a surface a face, n x n patches each.
PatchMesh cube(int n) {
  MeshBuilder builder;
  builder.grid("z0", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  builder.grid("z1", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n);
  builder.grid("x0", {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, n, n);
  builder.grid("x1", {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, n, n);
  builder.grid("y0", {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, n, n);
  builder.grid("y1", {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, n, n);
  return builder.build();
}

NamedFactors between(const PatchMesh& mesh, const FormFactors& factors,
                     const std::vector<std::string>& groups = {}) {
  Progress quiet;
  return factorsBetween(mesh, factors, groupSurfaces(mesh.surface_names, groups), quiet);
}

// Howell, Menguc, Daun & Siegel, catalogue C-11 and C-14; to nine digits in View3D's manual.
constexpr double kOpposite = 0.199824896;

TEST_F(Tables, FacesOfTheCubeHaveTheirPublishedFormFactors) {
  const PatchMesh mesh = cube(4);
  const NamedFactors table = between(mesh, test::computed(mesh, test::exactly(1e-7)));
  ASSERT_EQ(table.names, mesh.surface_names);
  const double adjacent = (1 - kOpposite) / 4;
  for (std::size_t a = 0; a < 6; ++a) {
    EXPECT_DOUBLE_EQ(table.matrix->area()[a], 1);
    for (std::size_t b = 0; b < 6; ++b) {
      const double truth = a == b ? 0 : a / 2 == b / 2 ? kOpposite : adjacent;
      // Closed forms hold 1e-5 of each value at least (DEFINITIONS: tolerance).
      EXPECT_NEAR(table.matrix->at(a, b), truth, 1e-5 * truth) << a << ' ' << b;
      EXPECT_GE(table.entryError(a, b), std::abs(table.matrix->at(a, b) - truth) - 1e-9);
    }
    EXPECT_EQ(table.sky[a], 0);
    EXPECT_EQ(table.backs[a], 0);
  }
  EXPECT_TRUE(table.closed);
}

TEST_F(Tables, GroupsFollowViewFactorAlgebra) {
  const PatchMesh mesh = cube(3);
  const NamedFactors table =
      between(mesh, test::computed(mesh, test::exactly(1e-7)), {"walls=[xy]?"});
  ASSERT_EQ(table.names, (std::vector<std::string>{"walls", "z0", "z1"}));
  EXPECT_NEAR(table.matrix->area()[0], 4, 1e-14);
  // Four walls: each sees the opposite one and two others; the floor sees all four.
  const double adjacent = (1 - kOpposite) / 4;
  EXPECT_NEAR(table.matrix->at(0, 0), kOpposite + 2 * adjacent, 1e-5);
  EXPECT_NEAR(table.matrix->at(1, 0), 4 * adjacent, 1e-5);
  EXPECT_NEAR(table.matrix->at(0, 1), adjacent, 1e-5);
  EXPECT_EQ(table.members, (std::vector<std::size_t>{36, 9, 9}));
}

/// Rows of random values with their accounts.
struct Sample {
  Sample() {
    MeshBuilder builder;
    builder.grid("a", {0, 0, 0}, {3, 0, 0}, {0, 2, 0}, 3, 2);
    builder.grid("sheet", {0, 0, 5}, {1, 0, 0}, {0, 1, 0}, 2, 2, true);
    builder.grid("b", {0, 0, 9}, {0, 1, 0}, {1, 0, 0}, 2, 1);
    mesh = builder.build();
    const auto matrix = std::make_shared<RowMatrix>(mesh.area, Precision::double_precision);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> value(0.01, 0.1);
    for (std::size_t u = 0; u < mesh.size(); ++u) {
      std::vector<Index> columns;
      std::vector<double> values;
      for (Index v = 0; v < mesh.size(); ++v) {
        if (v == u || random() % 3 == 0) continue;
        columns.push_back(v);
        values.push_back(value(random));
      }
      matrix->setRow(u, columns, values);
      factors.sky.push_back(value(random));
      factors.backs.push_back(value(random));
      factors.error.push_back(1e-3 * value(random));
    }
    factors.fronts = matrix->rowSums();
    factors.matrix = matrix;
  }
  PatchMesh mesh;
  FormFactors factors;
};

TEST_F(Tables, SumsEqualThoseMadeByHand) {
  const Sample sample;
  const NamedFactors table = between(sample.mesh, sample.factors, {"g=b", "g=a"});
  ASSERT_EQ(table.names, (std::vector<std::string>{"g", "sheet"}));
  const auto rowOf = [&](std::size_t patch) {
    return sample.mesh.surface_names[sample.mesh.surface[patch]] == "sheet" ? 1u : 0u;
  };
  double exchange[2][2] = {};
  double sky[2] = {};
  double area[2] = {};
  const ExchangeOperator& f = *sample.factors.matrix;
  for (std::size_t u = 0; u < f.size(); ++u) {
    area[rowOf(u)] += f.area()[u];
    sky[rowOf(u)] += f.area()[u] * sample.factors.sky[u];
    for (std::size_t v = 0; v < f.size(); ++v) {
      exchange[rowOf(u)][rowOf(v)] += f.area()[u] * f.at(u, v);
    }
  }
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_DOUBLE_EQ(table.matrix->area()[a], area[a]);
    EXPECT_DOUBLE_EQ(table.sky[a], sky[a] / area[a]);
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_NEAR(table.matrix->at(a, b), exchange[a][b] / area[a], 1e-14);
    }
  }
  EXPECT_NEAR(table.reciprocityResidual(0, 1), std::abs(exchange[0][1] - exchange[1][0]), 1e-14);
  EXPECT_GT(table.reciprocityResidual(0, 1), 1e-3);
  EXPECT_DOUBLE_EQ(area[1], 2) << "both sides of the sheet";
}

/// The same rows, in scratch memory if it is given.
std::shared_ptr<RowMatrix> copied(const ExchangeOperator& matrix,
                                  std::shared_ptr<ScratchMemory> scratch = nullptr) {
  const std::vector<double> area(matrix.area().begin(), matrix.area().end());
  auto copy = std::make_shared<RowMatrix>(area, Precision::double_precision, std::move(scratch));
  for (std::size_t u = 0; u < area.size(); ++u) {
    std::vector<Index> columns;
    std::vector<double> values;
    pairsOf(matrix).forRow(u, [&](Index v, double value) {
      columns.push_back(v);
      values.push_back(value);
    });
    copy->setRow(u, columns, values);
  }
  return copy;
}

TEST_F(Tables, MatricesOnDiskGiveTheSameBits) {
  Sample sample;
  const NamedFactors in_memory = between(sample.mesh, sample.factors);
  sample.factors.matrix =
      copied(*sample.factors.matrix, std::make_shared<ScratchMemory>(folder_.string(), 0));
  const NamedFactors from_disk = between(sample.mesh, sample.factors);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_EQ(from_disk.sky[a], in_memory.sky[a]);
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_EQ(from_disk.matrix->at(a, b), in_memory.matrix->at(a, b));
    }
  }
}

TEST_F(Tables, EntriesAreWithinTheirErrorOfFactorsToAThousandthOfTheTolerance) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  const NamedFactors rough = between(mesh, test::computed(mesh, test::exactly(3e-2)));
  const NamedFactors fine = between(mesh, test::computed(mesh, test::exactly(3e-5)));
  std::size_t beyond = 0;
  double largest = 0;
  for (std::size_t a = 0; a < rough.size(); ++a) {
    for (std::size_t b = 0; b < rough.size(); ++b) {
      const double error = std::abs(rough.matrix->at(a, b) - fine.matrix->at(a, b));
      largest = std::max(largest, error);
      if (error > rough.entryError(a, b)) ++beyond;
    }
  }
  EXPECT_EQ(beyond, 0u);
  EXPECT_GT(largest, 1e-6) << "nothing was tested";
}

TEST_F(Tables, SurfacesJoinTheFirstGroupThatMatches) {
  const std::vector<std::string> surfaces = {"left/white", "right/white", "lamp", "a[1]"};
  const SurfaceGroups groups =
      groupSurfaces(surfaces, std::vector<std::string>{"light=lamp", "room=*/white", "all=*"});
  EXPECT_EQ(groups.names, (std::vector<std::string>{"light", "room", "all"}));
  EXPECT_EQ(groups.of_surface, (std::vector<Index>{1, 1, 0, 2}));
  ASSERT_EQ(groups.notes.size(), 3u);
  EXPECT_EQ(groups.notes[2].text, "groups='all=*': surface lamp is in group light already");
  // An exact name counts, whatever it would match as a pattern.
  EXPECT_EQ(groupSurfaces(surfaces, std::vector<std::string>{"one=a[1]"}).of_surface,
            (std::vector<Index>{1, 2, 3, 0}));
  EXPECT_EQ(groupSurfaces(surfaces).names, surfaces);
}

TEST_F(Tables, AQuestionMarkMatchesAUtf8Character) {
  const std::vector<std::string> surfaces = {"Wände", "Winde", "Wand"};
  EXPECT_EQ(groupSurfaces(surfaces, std::vector<std::string>{"g=W?nde"}).of_surface,
            (std::vector<Index>{0, 0, 1}));
}

TEST_F(Tables, RefusesInvalidGroups) {
  const std::vector<std::string> surfaces = {"left", "right"};
  const auto error = [&](std::vector<std::string> groups) {
    return errorOf([&] { groupSurfaces(surfaces, groups); });
  };
  EXPECT_EQ(error({"g=up*"}), "groups='g=up*': matches no surface; there are: left, right");
  EXPECT_NE(error({"g"}).find("groups='g': is no NAME=PATTERN"), std::string::npos);
  EXPECT_NE(error({"=*"}).find("is no NAME=PATTERN"), std::string::npos);
  EXPECT_NE(error({"g=*", "h=left"}).find("groups='h=left': all surfaces"), std::string::npos);
  EXPECT_NE(error({"left=right"}).find("surface left has that name"), std::string::npos);
}

TEST_F(Tables, ReceiversNeedNamesOfTheirOwn) {
  const Sample sample;
  NamedFactors table = between(sample.mesh, sample.factors, {"sky=a"});
  const auto write = [&] { writeFactorsCsv(path("x.csv"), table, TableLayout::wide, progress_); };
  expectError<InputError>(path("x.csv"), "the sky is called sky, as another receiver is", write);
  table.sky_name = "heaven";
  write();
  EXPECT_EQ(files(), 1u);
}

TEST_F(Tables, NamesAndAreasThatPartnersCannotReadAreRefused) {
  const Sample sample;
  const auto idf = [&](const std::string& group, const std::string& zone) {
    return [&, group, zone] {
      writeEnergyPlus(path("x.idf"), between(sample.mesh, sample.factors, {group}), zone,
                      progress_);
    };
  };
  expectError<InputError>(path("x.idf"), "'a, b' is no name for EnergyPlus", idf("a, b=a", "z"));
  expectError<InputError>(path("x.idf"), "ignores case", idf("B=a", "z"));
  expectError<InputError>(path("x.idf"), "'' is no name", idf("c=a", ""));
  FormFactors above = sample.factors;
  const std::shared_ptr<RowMatrix> rows_above = copied(*above.matrix);
  above.matrix = rows_above;
  for (std::size_t u = 0; u < above.matrix->size(); ++u) {
    if (sample.mesh.surface_names[sample.mesh.surface[u]] != "b") continue;
    rows_above->setRow(u, std::vector<Index>{0}, std::vector<double>{1 + 1e-6});
  }
  expectError<InputError>(path("x.idf"), "F from b to a is 1.000001", [&] {
    writeEnergyPlus(path("x.idf"), between(sample.mesh, above), "z", progress_);
  });
  FormFactors flat = sample.factors;
  std::vector<double> area(flat.matrix->area().begin(), flat.matrix->area().end());
  area.back() = 0;  // the last patch: of the sheet's backs
  flat.matrix = std::make_shared<RowMatrix>(area, Precision::double_precision);
  const NamedFactors rows = factorsOfPatches(sample.mesh, flat);
  expectError<InputError>(path("x.vf"), "patch 15 has no area", [&] {
    writeView3d(path("x.vf"), rows, std::vector<double>(rows.size(), 0.5), progress_);
  });
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace radiosity
