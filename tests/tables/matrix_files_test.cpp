// Matrices of form factors from files: read as their formats say, compared row for row.
#include "radiosity/matrix_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "radiosity/row_matrix.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

class MatrixFiles : public FolderTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    save(path(name), {text.begin(), text.end()});
  }
  MatrixFile read(const std::string& name, std::span<const double> areas = {}) {
    return readMatrixFile(path(name), progress_, areas);
  }
  void refuses(const std::string& text, const std::string& part) {
    write("x.mtx", text);
    expectError<InputError>(path("x.mtx"), part, [&] { read("x.mtx"); });
  }
};

// Opposite faces of a cube: catalogue C-11 of Howell et al.; adjacent ones follow from closure.
constexpr double kOppositeSides = 0.199824896;

/// View3D's file of the cube, whose faces 1 and 4, 2 and 5, 3 and 6 are opposite: six decimals.
std::string cubeOfView3d() {
  std::string text = "View3D 3.3.1 0 1 0 6          \n1 1 1 1 1 1\n";
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < 6; ++b) {
      const double value = a == b                 ? 0
                           : (b - a + 6) % 3 == 0 ? kOppositeSides
                                                  : (1 - kOppositeSides) / 4;
      text += fmt::format("{}{:.6f}", b == 0 ? "" : " ", value);
    }
    text += '\n';
  }
  return text + "0.500 0.500 0.500 0.500 0.500 0.500\n";
}

TEST_F(MatrixFiles, ReadsViewFactorsOfView3d) {
  write("cube.vf", cubeOfView3d());
  ASSERT_TRUE(isMatrixFile(path("cube.vf")));
  const MatrixFile file = read("cube.vf");
  ASSERT_EQ(file.factors.size(), 6u);
  EXPECT_EQ(file.factors.matrix->at(0, 3), 0.199825);
  EXPECT_EQ(file.factors.matrix->at(0, 1), 0.200044);
  EXPECT_EQ(file.factors.matrix->at(2, 2), 0);
  EXPECT_EQ(file.emissivity, std::vector<double>(6, 0.5));
  EXPECT_TRUE(file.has_areas);
  EXPECT_TRUE(file.factors.closed);
}

TEST_F(MatrixFiles, ReadsBinaryViewFactorsOfView3d) {
  std::string bytes = "View3D 3.2 1 0 0 2";
  bytes.resize(30, ' ');
  bytes += "\r\n";
  const std::vector<float> numbers = {2, 4, 0, 0.5f, 0.25f, 0.125f, 0.9f, 0.8f};
  const std::size_t header = bytes.size();
  bytes.resize(header + numbers.size() * sizeof(float));
  std::memcpy(bytes.data() + header, numbers.data(), numbers.size() * sizeof(float));
  write("x.vf", bytes);
  const MatrixFile file = read("x.vf");
  EXPECT_EQ(file.factors.matrix->area()[1], 4);
  EXPECT_EQ(file.factors.matrix->at(0, 1), 0.5);
  EXPECT_EQ(file.factors.matrix->at(1, 1), 0.125);
  EXPECT_DOUBLE_EQ(file.factors.sky[1], 1 - 0.375);
  EXPECT_EQ(file.emissivity, (std::vector<double>{0.9f, 0.8f}));
  EXPECT_FALSE(file.factors.closed);
}

TEST_F(MatrixFiles, RefusesDamagedViewFactorsOfView3d) {
  const auto refused = [&](const std::string& text, const std::string& part) {
    write("x.vf", text);
    expectError<InputError>(path("x.vf"), part, [&] { read("x.vf"); });
  };
  refused("View3D 3.3 0 1 1 1\n1\n1\n1\n", "script-F");
  refused("View3D 3.3 0 1 0 2\n1 1\n0 1\n1 0\n1\n", "has 7 numbers");
  refused("View3D 3.3 0 1 0 1\n1\nnan\n1\n", ":3: `nan` is not a finite number");
  refused("View3D 3.3 0 1 0 1\n1\n-1\n1\n", "number 2 after the header is -1");
  refused("View3D 3.3 0 1 0\n", "is no matrix of form factors");
}

NamedFactors threeRows() {
  NamedFactors factors;
  factors.numbered = true;
  factors.names = {"a b", "lamp/light", ""};
  const auto matrix =
      std::make_shared<RowMatrix>(std::vector<double>{2, 0.5, 1}, Precision::double_precision);
  matrix->setRow(0, std::vector<Index>{1, 2}, std::vector<double>{0.1, 1. / 3});
  matrix->setRow(1, std::vector<Index>{0}, std::vector<double>{0.4});
  factors.matrix = matrix;
  factors.sky = {0.25, 0.6, 1};
  factors.backs = {0.3, 0, 0};
  return factors;
}

TEST_F(MatrixFiles, OurMatrixMarketIsReadBackWithAreasAccountsAndNames) {
  const NamedFactors factors = threeRows();
  writeMatrixMarket(path("x.mtx"), factors, progress_);
  const MatrixFile file = read("x.mtx");
  EXPECT_TRUE(file.has_areas);
  EXPECT_TRUE(file.has_accounts);
  EXPECT_EQ(file.factors.names, factors.names);
  EXPECT_EQ(file.factors.sky, factors.sky);
  EXPECT_EQ(file.factors.backs, factors.backs);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(file.factors.matrix->area()[i], factors.matrix->area()[i]);
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_EQ(file.factors.matrix->at(i, j), factors.matrix->at(i, j));
    }
  }
}

TEST_F(MatrixFiles, ReadsEveryKindOfMatrixMarketThatHoldsFormFactors) {
  write("x.mtx", "%%MatrixMarket MATRIX Array Real General\n% by columns\n2 2\n0\n.5\n.25\n.125\n");
  const MatrixFile dense = read("x.mtx");
  EXPECT_EQ(dense.factors.matrix->at(1, 0), 0.5);
  EXPECT_EQ(dense.factors.matrix->at(0, 1), 0.25);
  EXPECT_FALSE(dense.has_areas);
  EXPECT_DOUBLE_EQ(dense.factors.sky[0], 0.75);
  write("x.mtx", "%%MatrixMarket matrix coordinate integer symmetric\r\n\r\n2 2 1\r\n2 1 1\r\n");
  const std::vector<double> areas = {3, 3};
  const MatrixFile symmetric = read("x.mtx", areas);
  EXPECT_EQ(symmetric.factors.matrix->at(0, 1), 1);
  EXPECT_EQ(symmetric.factors.matrix->at(1, 0), 1);
  EXPECT_EQ(symmetric.factors.matrix->area()[1], 3);
  EXPECT_TRUE(symmetric.has_areas);
  EXPECT_TRUE(symmetric.factors.closed);
}

TEST_F(MatrixFiles, RefusesDamagedMatrixMarket) {
  const std::string banner = "%%MatrixMarket matrix coordinate real general\n";
  refuses("%%MatrixMarket matrix coordinate complex general\n1 1 0\n", ":1: is not `matrix");
  refuses("%%MatrixMarket vector\n", ":1: is not `matrix");
  refuses(banner, "ends before the size");
  refuses(banner + "2 3 0\n", ":2: is 2 x 3");
  refuses(banner + "2 2 -1\n", ":2: `-1` is no count");
  refuses(banner + "2 2 1000000000\n1 1 1\n", "too short");
  refuses(banner + "4000000000 4000000000 0\n", "claims 4000000000 rows");
  refuses(banner + "2 2 2\n1 2 .5\n", "ends after 1 of 2 entries");
  refuses(banner + "2 2 1\n1 2 .5\n2 1 .5\n", ":4: there are more than the 1 entries");
  refuses(banner + "2 2 1\n1 3 .5\n", ":3: `3` is no row or column: they go from 1 to 2");
  refuses(banner + "2 2 1\n0 1 .5\n", ":3: `0` is no row");
  refuses(banner + "2 2 1\n1 2 -.5\n", ":3: `-.5` is no form factor");
  refuses(banner + "2 2 1\n1 2 inf\n", ":3: `inf` is no form factor");
  refuses(banner + "2 2 1\n1 2\n", ":3: is not `row column value`");
  refuses(banner + "2 2 2\n1 2 .5\n1 2 .5\n", "row 1, column 2 is given twice");
  refuses("hello\n", "is no matrix of form factors");
  write("x.mtx", banner + "2 2 0\n");
  const std::vector<double> three = {1, 2, 3};
  expectError<InputError>(path("x.mtx"), "has 2 rows, and 3 areas", [&] { read("x.mtx", three); });
}

TEST_F(MatrixFiles, DifferencesEqualThoseWorkedOutByHand) {
  MatrixFile a;
  a.factors = threeRows();
  MatrixFile b = a;
  const auto other =
      std::make_shared<RowMatrix>(std::vector<double>{2, 0.5, 1}, Precision::double_precision);
  other->setRow(0, std::vector<Index>{1, 2}, std::vector<double>{0.1, 0.3});
  other->setRow(1, std::vector<Index>{0, 2}, std::vector<double>{0.4, 0.2});
  b.factors.matrix = other;
  const MatrixComparison c = compareMatrices(a, b, progress_);
  const double squares = 2 * (0.01 + 1. / 9) + 0.5 * 0.16;
  const double difference = 2 * (1. / 3 - 0.3) * (1. / 3 - 0.3) + 0.5 * 0.04;
  EXPECT_DOUBLE_EQ(c.relative_l2, std::sqrt(difference / squares));
  EXPECT_EQ(c.largest, 0.2);
  EXPECT_EQ(c.row, 1u);
  EXPECT_EQ(c.column, 2u);
  EXPECT_EQ(c.a, 0);
  EXPECT_EQ(c.b, 0.2);
  EXPECT_DOUBLE_EQ(c.account_b.least_sum, 0);
  EXPECT_DOUBLE_EQ(c.account_b.largest_sum, 0.6);
  EXPECT_DOUBLE_EQ(c.account_b.mean_sum, (2 * 0.4 + 0.5 * 0.6) / 3.5);
  ASSERT_TRUE(c.account_a.reciprocity.has_value());
  ASSERT_EQ(c.names.size(), 3u);
  EXPECT_EQ(c.names[0].name, "lamp/light");
  EXPECT_DOUBLE_EQ(c.names[0].relative_l2, std::sqrt(0.02 / 0.08));
  EXPECT_EQ(compareMatrices(a, a, progress_).relative_l2, 0);
  EXPECT_FALSE(c.renamed_row.has_value());
  b.factors.names[1] = "";
  EXPECT_FALSE(compareMatrices(a, b, progress_).renamed_row.has_value()) << "a row without a name";
  b.factors.names[0] = "another";
  EXPECT_EQ(compareMatrices(a, b, progress_).renamed_row, 0u);
}

TEST_F(MatrixFiles, MissingAreasGiveEqualWeightsAndNoReciprocity) {
  MatrixFile a;
  a.factors = threeRows();
  a.has_areas = false;
  const MatrixComparison c = compareMatrices(a, a, progress_);
  EXPECT_FALSE(c.weighted);
  EXPECT_FALSE(c.account_a.reciprocity.has_value());
}

TEST_F(MatrixFiles, RowsTakeMaterialsByNumberAndName) {
  MatrixFile file;
  file.factors = threeRows();
  file.factors.names = {"wall", "lamp", "wall"};
  write("m.csv",
        "# by name\nname, reflectance_1, reflectance_2, emission_1, emission_2\n"
        "lamp,.1,.2,10,20\n\n*,.5,.6,0,0\n");
  const PatchMaterials by_name = readRowMaterials(path("m.csv"), file);
  EXPECT_EQ(by_name.bands, 2);
  EXPECT_EQ(by_name.reflectance, (std::vector<double>{.5, .6, .1, .2, .5, .6}));
  EXPECT_EQ(by_name.emission, (std::vector<double>{0, 0, 10, 20, 0, 0}));
  file.emissivity = {.9, .8, .7};
  write("m.csv", "row,emission\n3,1\n1,2\n2,0\n");
  const PatchMaterials by_row = readRowMaterials(path("m.csv"), file);
  EXPECT_EQ(by_row.reflectance, (std::vector<double>{1 - .9, 1 - .8, 1 - .7}));
  EXPECT_EQ(by_row.emission, (std::vector<double>{2, 0, 1}));
  write("m.csv", "row,emission\n*,0\n1,2\n");
  EXPECT_EQ(readRowMaterials(path("m.csv"), file).emission, (std::vector<double>{2, 0, 0}));
}

TEST_F(MatrixFiles, RefusesTablesOfRowsThatDoNotFit) {
  MatrixFile file;
  file.factors = threeRows();
  file.factors.names = {"wall", "lamp", "wall"};
  const auto refused = [&](const std::string& text, const std::string& part) {
    write("m.csv", text);
    expectError<InputError>(path("m.csv"), part, [&] { readRowMaterials(path("m.csv"), file); });
  };
  refused("reflectance\n.5\n", ":1: the header needs one of `row`");
  refused("row,emission\n1,2\n", "no column `reflectance`");
  refused("row,reflectance,albedo\n1,.5,.5\n", "column 'albedo' is none of");
  refused("row,reflectance,reflectance\n1,.5,.5\n", "two columns 'reflectance'");
  refused("row,reflectance_1,reflectance_2,emission\n1,.5,.5,0\n", "2 columns of reflectance");
  refused("row,reflectance\n4,.5\n", ":2: `4` is no row: they go from 1 to 3");
  refused("row,reflectance\n1,1.5\n", ":2: reflectance `1.5` is not a number within 0 and 1");
  refused("row,reflectance,emission\n1,.5,-1\n", ":2: emission `-1` is not a finite number");
  refused("row,reflectance\n1,.5\n1,.5\n", ":3: row 1 is given on line 2 already");
  refused("row,reflectance\n1,.5\n2,.5\n", "no line is for row 3 (wall)");
  refused("name,reflectance\ndoor,.5\n", ":2: no row is called door; there are: lamp, wall");
  refused("row,reflectance\n1\n", ":2: 1 fields, and the header has 2");
  refused("row,reflectance\n\"1,.5\n", ":2: a quote is opened and not closed");
}

TEST_F(MatrixFiles, TablesMayComeFromSpreadsheets) {
  const std::vector<double> both{4, 5};
  const std::string byte_order_mark = "\xef\xbb\xbf";
  const std::vector<std::string> tables{"area_m2\r\n4\r\n5\r\n",
                                        "area_m2\r4\r5",
                                        "area_m2,,\n4,,\n,,\n5,,\n",
                                        "area_m2\xc2\xa0\n4\n 5 \n",
                                        "name, area_m2\na, \"4\"\n \"b, c\",5\n",
                                        byte_order_mark + "area_m2\n4\n5\n",
                                        "# areas\rarea_m2\r4\r5\r"};
  for (const std::string& text : tables) {
    write("a.csv", text);
    EXPECT_EQ(readAreas(path("a.csv")), both) << text;
  }
  write("a.csv", std::string("\xff\xfe\x34\0\n\0", 6));
  expectError<InputError>(path("a.csv"), ":1: is UTF-16; save it as UTF-8",
                          [&] { readAreas(path("a.csv")); });
  write("a.csv", "name,area_m2\na,0,5\n");
  expectError<InputError>(path("a.csv"), "points in numbers", [&] { readAreas(path("a.csv")); });
}

TEST_F(MatrixFiles, AreasAreReadFromAListOrAColumn) {
  write("a.txt", "1\n2.5\n\n3\n");
  EXPECT_EQ(readAreas(path("a.txt")), (std::vector<double>{1, 2.5, 3}));
  write("a.csv", "name,area_m2\n\"a, b\",4\nc,5\n");
  EXPECT_EQ(readAreas(path("a.csv")), (std::vector<double>{4, 5}));
  write("a.csv", "row,area_m2\n2,5\n1,4\n");
  EXPECT_EQ(readAreas(path("a.csv")), (std::vector<double>{4, 5}));
  const auto refused = [&](const std::string& text, const char* part) {
    write("a.csv", text);
    expectError<InputError>(path("a.csv"), part, [&] { readAreas(path("a.csv")); });
  };
  refused("row,area_m2\n2,5\n2,4\n", ":3: row 2 is given on line 2 already");
  refused("row,area_m2\n1,5\n3,4\n", ":3: `3` is no row: they go from 1 to 2");
  write("a.txt", "1\n-2\n");
  expectError<InputError>(path("a.txt"), ":2: `-2` is no area", [&] { readAreas(path("a.txt")); });
  write("a.csv", "name,area\na,1\n");
  expectError<InputError>(path("a.csv"), "no column area_m2", [&] { readAreas(path("a.csv")); });
}

}  // namespace
}  // namespace radiosity
