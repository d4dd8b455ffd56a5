// The HDF5 results file: nothing lost, damage named, whole or not there at all.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "matrix/cut_sample.h"
#include "radiosity/matrix_functions.h"
#include "results_sample.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

class ResultsFile : public FolderTest {
 protected:
  void write(const Results& results) { writeResults(file(), results, progress_); }
  std::string file() const { return path("x.h5"); }
  void expectInputError(const std::string& part) const {
    expectError<InputError>(file(), part, [&] { readResults(file()); });
  }
};

TEST_F(ResultsFile, GivesBackEveryField) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    // Small: all datasets in their headers. 60: chunks, several of them for the matrix.
    for (const auto& [side, bands] : {std::pair{2u, 1}, {2u, 2}, {60u, 3}, {2u, 5}, {60u, 8}}) {
      const Results written = sample::results(side, precision, bands);
      write(written);
      EXPECT_TRUE(isResultsFile(file()));
      const Results read = readResults(file());
      EXPECT_TRUE(sample::same(written.scene, read.scene));
      EXPECT_TRUE(sample::same(written.mesh, read.mesh));
      EXPECT_TRUE(sample::same(written.factors, read.factors));
      EXPECT_TRUE(sample::same(written.solution, read.solution));
      EXPECT_TRUE(sample::same(written, read));
    }
  }
}

TEST_F(ResultsFile, GivesBackRowsThatAreCut) {
  for (const bool with_pairs : {true, false}) {
    // A few patches in their headers; enough that rows take several chunks and blocks.
    for (const Index side : {3u, 30u}) {
      Results written = sample::results(side, Precision::single_precision);
      CutParts parts = test::randomCut(written.factors->fronts.size(), 1);
      if (!with_pairs) parts.pairs.reset();
      written.factors->matrix = std::make_shared<CutOperator>(parts);
      write(written);
      const Results read = readResults(file());
      const auto& found = dynamic_cast<const CutOperator&>(*read.factors->matrix);
      EXPECT_EQ(found.parts().bias, parts.bias);
      EXPECT_EQ(found.parts().area, parts.area);
      EXPECT_EQ(found.dense(), written.factors->matrix->dense());
      EXPECT_EQ(found.rowNorms(), written.factors->matrix->rowNorms());
      EXPECT_NEAR(double(estimateResultsBytes(written)), double(std::filesystem::file_size(file())),
                  8192);
    }
  }
}

TEST_F(ResultsFile, GivesBackAnyCombinationOfStages) {
  const Results full = sample::results(3, Precision::single_precision);
  for (int stages = 0; stages < 128; ++stages) {
    Results some = full;
    // Gathered light belongs to a mesh and is not stored without it.
    if ((stages & 34) != 34) some.gathered = {};
    // Heat belongs to a mesh and form factors.
    if ((stages & 6) != 6) some.heat = {};
    // So does light of single lamps.
    if ((stages & 6) != 6) some.basis = {};
    // Elements belong to a mesh and a solution.
    if ((stages & 82) != 82) some.elements = {};
    if ((stages & 1) == 0) some.scene.reset();
    if ((stages & 2) == 0) some.mesh = {};
    if ((stages & 4) == 0) some.factors = {};
    if ((stages & 8) == 0) some.materials.reset();
    if ((stages & 16) == 0) some.solution = {};
    write(some);
    EXPECT_TRUE(sample::same(some, readResults(file()))) << stages;
  }
}

TEST_F(ResultsFile, BandsFollowTheRows) {
  // As in a file made by a program with the library or h5py: materials alone, without the sky.
  Results spectral = sample::results(3, Precision::single_precision, 8);
  spectral.solution = {};
  spectral.elements = {};
  spectral.materials->lights.clear();
  write(spectral);
  const Results read = readResults(file());
  ASSERT_TRUE(read.materials);
  EXPECT_EQ(read.materials->bands, 8);
  EXPECT_TRUE(read.materials->lights.empty());
  EXPECT_TRUE(sample::same(spectral, read));

  // Rows that the file would cut short are refused before anything is written.
  spectral.materials->bands = 7;
  expectError<InputError>("", "materials: 80 reflectances are given, 10 patches of 7 bands take 70",
                          [&] { write(spectral); });
  EXPECT_TRUE(sample::same(read, readResults(file())));
}

TEST_F(ResultsFile, KeepsUnusualValues) {
  Results odd = sample::results(3, Precision::double_precision);
  Solution solution = sample::solution(0, 3);
  solution.summary.error_bound.reset();
  solution.summary.status = SolveStatus::singular;
  odd.solution.value = solution;
  Scene scene = sample::scene();
  scene.texcoords.clear();
  scene.textures.clear();
  scene.materials[0].texture = kNone;
  scene.materials[1].emission_texture = kNone;
  scene.notes.clear();
  odd.scene = scene;
  MeshResult mesh = {sample::mesh(3), sample::meshReport()};
  mesh.report.notes.assign(5000, {Severity::info, "one of many"});
  odd.mesh = {mesh, std::string(200000, 'k')};  // more than an object header holds
  write(odd);
  EXPECT_TRUE(sample::same(odd, readResults(file())));

  Results empty;
  empty.version = "1.2.3";
  write(empty);
  EXPECT_TRUE(sample::same(empty, readResults(file())));
}

TEST_F(ResultsFile, LeavesTheMatrixOutOnRequest) {
  const Results written = sample::results(3, Precision::single_precision);
  write(written);
  const Results read = readResults(file(), false);
  FormFactors bare = sample::factors(sample::mesh(3), Precision::single_precision);
  bare.matrix.reset();
  EXPECT_TRUE(sample::same(bare, *read.factors));
  EXPECT_TRUE(sample::same(written.solution, read.solution));
  // Written back it would lose the matrix without a word.
  EXPECT_THROW(writeResults(path("y.h5"), read, progress_), RunError);
  EXPECT_EQ(files(), 1u);
}

TEST_F(ResultsFile, SameResultsGiveTheSameBytes) {
  write(sample::results(20, Precision::single_precision));
  const std::vector<char> first = load(file());
  write(sample::results(20, Precision::single_precision));
  EXPECT_EQ(first, load(file()));
}

TEST_F(ResultsFile, SizeIsEstimatedBeforeWriting) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    for (const Index side : {1u, 2u, 5u, 12u, 30u, 60u}) {
      const Results results = sample::results(side, precision);
      write(results);
      const double size = double(std::filesystem::file_size(file()));
      // HDF5 hands out metadata in blocks of 2 KiB, some of them half empty: two of them, or 5%.
      EXPECT_NEAR(double(estimateResultsBytes(results)), size, std::max(4096.0, 0.05 * size))
          << side;
    }
  }
  const Results none;
  write(none);
  EXPECT_NEAR(double(estimateResultsBytes(none)), double(std::filesystem::file_size(file())),
              4096.0);
}

TEST_F(ResultsFile, NamesFilesThatAreNoResultsFiles) {
  expectInputError("no such file");
  save(file(), {'v', ' ', '1'});
  EXPECT_FALSE(isResultsFile(file()));
  expectInputError("not HDF5");
  std::filesystem::remove(file());
  std::filesystem::create_directory(file());
  EXPECT_FALSE(isResultsFile(file()));
  expectInputError("is a folder");
  EXPECT_THROW(write({}), InputError);
  std::filesystem::remove(file());
  H5Fclose(H5Fcreate(file().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_TRUE(isResultsFile(file()));
  expectInputError("another program");
}

/// Opens the file as another program would, to change one thing in it.
class Edit {
 public:
  explicit Edit(const std::string& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)) {}
  ~Edit() { H5Fclose(file_); }
  template <class T>
  void element(const char* dataset, hid_t type, hsize_t at, T value) {
    const hid_t id = H5Dopen2(file_, dataset, H5P_DEFAULT);
    const hid_t space = H5Dget_space(id);
    const hsize_t one = 1;
    const hid_t memory = H5Screate_simple(1, &one, nullptr);
    H5Sselect_elements(space, H5S_SELECT_SET, 1, &at);
    EXPECT_GE(H5Dwrite(id, type, memory, space, H5P_DEFAULT, &value), 0);
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(id);
  }
  template <class T>
  void attribute(const char* object, const char* name, hid_t type, T value) {
    const hid_t group = H5Gopen2(file_, object, H5P_DEFAULT);
    const hid_t id = H5Aopen(group, name, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(id, type, &value), 0);
    H5Aclose(id);
    H5Gclose(group);
  }
  void remove(const char* name) { EXPECT_GE(H5Ldelete(file_, name, H5P_DEFAULT), 0); }
  void removeAttribute(const char* object, const char* name) {
    EXPECT_GE(H5Adelete_by_name(file_, object, name, H5P_DEFAULT), 0);
  }
  /// Zeros.
  void rows(const char* name, hsize_t count, hsize_t columns) {
    const std::array<hsize_t, 2> extent = {count, columns};
    const std::vector<double> zeros(count * columns, 0.0);
    const hid_t space = H5Screate_simple(2, extent.data(), nullptr);
    const hid_t id =
        H5Dcreate2(file_, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data()), 0);
    H5Dclose(id);
    H5Sclose(space);
  }
  void vector(const char* name, hid_t type, hsize_t length) {
    const hid_t space = H5Screate_simple(1, &length, nullptr);
    H5Dclose(H5Dcreate2(file_, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
  }

 private:
  hid_t file_;
};

// A method that came later has a part of the report of its own.
TEST_F(ResultsFile, ReadsFilesWithoutAPartOfAReport) {
  Results written = sample::results(3, Precision::single_precision);
  write(written);
  Edit(file()).remove("/form_factors/report/cut");
  written.factors->report.cut = {};
  EXPECT_TRUE(sample::same(written, readResults(file())));
}

TEST_F(ResultsFile, NamesFieldsThatAnotherProgramChanged) {
  const Results good = sample::results(3, Precision::single_precision);
  const auto expectAfter = [&](const auto& change, const std::string& part) {
    write(good);
    {
      Edit edit(file());
      change(edit);
    }
    SCOPED_TRACE(part);
    expectInputError(part);
  };
  // A file of before December 2026, of a scene with more planar pieces than patches asked for.
  expectAfter([](Edit& e) { e.vector("/mesh/clusters", H5T_NATIVE_UINT, 3); },
              "its patches share unknowns");
  expectAfter([](Edit& e) { e.attribute("/", "format_version", H5T_NATIVE_INT, 99); },
              "format version 99");
  expectAfter([](Edit& e) { e.remove("/form_factors/data"); }, "/form_factors/data is missing");
  expectAfter([](Edit& e) { e.remove("/mesh/area"); }, "/mesh/area is missing");
  expectAfter([](Edit& e) { e.remove("/scene/surfaces/name"); }, "/scene/surfaces/name is missing");
  expectAfter([](Edit& e) { e.element("/form_factors/indices", H5T_NATIVE_INT, 0, 4711); },
              "/form_factors/indices has a row");
  expectAfter([](Edit& e) { e.element("/form_factors/indices", H5T_NATIVE_INT, 0, -1); },
              "/form_factors/indices has a row");
  expectAfter([](Edit& e) { e.element("/form_factors/data", H5T_NATIVE_FLOAT, 2, NAN); },
              "/form_factors/data has a row");
  expectAfter([](Edit& e) { e.element("/form_factors/indptr", H5T_NATIVE_LONG, 3, 1000000L); },
              "/form_factors/indptr does not divide");
  expectAfter([](Edit& e) { e.element("/form_factors/shape", H5T_NATIVE_LONG, 1, 9L); },
              "/form_factors/shape is not 10 x 10");
  expectAfter([](Edit& e) { e.element("/form_factors/area", H5T_NATIVE_DOUBLE, 0, -1.0); },
              "/form_factors/area holds the area -1");
  expectAfter([](Edit& e) { e.element("/mesh/corners", H5T_NATIVE_UINT, 0, 1000u); },
              "/mesh/corners points beyond");
  expectAfter([](Edit& e) { e.element("/mesh/piece_offset", H5T_NATIVE_ULONG, 1, 1000000ul); },
              "/mesh/piece_offset does not divide");
  expectAfter([](Edit& e) { e.element("/scene/materials/texture", H5T_NATIVE_UINT, 0, 2u); },
              "/scene/materials/texture points beyond");
  expectAfter(
      [](Edit& e) { e.element("/scene/materials/emission_texture", H5T_NATIVE_UINT, 0, 2u); },
      "/scene/materials/emission_texture points beyond");
  expectAfter([](Edit& e) { e.attribute("/solution", "bands", H5T_NATIVE_INT, 0); },
              "/solution/radiosity is not");
  expectAfter([](Edit& e) { e.attribute("/gather", "bands", H5T_NATIVE_INT, 5); },
              "/gather/radiosity is not 5 columns");
  expectAfter([](Edit& e) { e.attribute("/gather", "bands", H5T_NATIVE_INT, 0); },
              "/gather/radiosity is not");
  expectAfter(
      [](Edit& e) {
        e.remove("/solution/emission");
        e.rows("/solution/emission", 10, 5);
      },
      "/solution/emission is not 3 columns");
  expectAfter(
      [](Edit& e) {
        e.remove("/solution/reflectance");
        e.vector("/solution/reflectance", H5T_NATIVE_DOUBLE, 30);
      },
      "/solution/reflectance has no rows of bands");
  expectAfter(
      [](Edit& e) {
        e.remove("/solution/reflectance");
        e.remove("/solution/emission");
        e.rows("/solution/reflectance", 10, 5);
        e.rows("/solution/emission", 10, 5);
      },
      "/solution/sky is not 5 64-bit float");
  expectAfter(
      [](Edit& e) {
        e.remove("/form_factors/sky");
        e.vector("/form_factors/sky", H5T_NATIVE_DOUBLE, 7);
      },
      "/form_factors/sky");
  expectAfter(
      [](Edit& e) {
        e.remove("/mesh/area");
        e.vector("/mesh/area", H5T_NATIVE_FLOAT, 10);
      },
      "/mesh/area is not a vector of 64-bit float");
  // An extent without data must not be believed (8 TB).
  expectAfter(
      [](Edit& e) {
        e.remove("/mesh/area");
        e.vector("/mesh/area", H5T_NATIVE_DOUBLE, hsize_t(1) << 40);
      },
      "/mesh/area claims");
}

TEST_F(ResultsFile, NamesElementsThatAnotherProgramChanged) {
  const Results good = sample::results(3, Precision::single_precision);
  const Elements& e = *good.elements;
  const hsize_t roots = e.roots.size();
  const auto expectAfter = [&](const auto& change, const std::string& part) {
    write(good);
    {
      Edit edit(file());
      change(edit);
    }
    SCOPED_TRACE(part);
    expectInputError(part);
  };
  const auto set = [&](const char* column, hid_t type, hsize_t at, auto value) {
    return [=](Edit& edit) {
      const std::string dataset = std::string("/elements/direct/") + column;
      edit.element(dataset.c_str(), type, at, value);
    };
  };
  const hid_t byte = H5T_NATIVE_UCHAR;
  const hid_t index = H5T_NATIVE_UINT;
  using Byte = unsigned char;
  expectAfter([](Edit& edit) { edit.attribute("/elements", "bands", H5T_NATIVE_INT, 0); },
              "/elements/direct/values is not");
  expectAfter([](Edit& edit) { edit.remove("/elements/roots"); }, "/elements/roots is missing");
  expectAfter([](Edit& edit) { edit.element("/elements/roots/patch", H5T_NATIVE_UINT, 0, 3U); },
              "/elements/roots is not of the patches of /mesh");
  expectAfter(
      [](Edit& edit) { edit.element("/elements/roots/of_patch", H5T_NATIVE_ULONG, 1, 9UL); },
      "/elements/roots is not of the patches of /mesh");
  expectAfter(set("points", index, 3, Index(e.direct.vertices)),
              "/elements/direct/points points beyond");
  const std::string rows = "/elements/direct/elements ";
  expectAfter(set("elements/corners", byte, 0, Byte(5)), rows + "has a root with other corners");
  expectAfter(set("elements/corners", byte, roots, Byte(0)), rows + "has a part");
  expectAfter(set("elements/corners", byte, roots + 1, Byte(3)), rows + "has a part");
  expectAfter(set("elements/tested", byte, 1, Byte(2)), rows + "has elements that are tested");
  expectAfter(set("elements/tested", byte, 0, Byte(0)), rows + "has elements whose parts");
  expectAfter(set("elements/first_point", index, 1, Index(e.direct.points.size() - 8)),
              rows + "points beyond");
  expectAfter(set("elements/first_child", index, 0, Index(roots + 1)),
              rows + "has elements whose parts");
  expectAfter(set("elements/first_child", index, 0, Index(0)), rows + "has elements whose parts");
  expectAfter(set("elements/first_child", index, 0, kNone), rows + "has parts of two elements");
  expectAfter(set("elements/first_child", index, 1, Index(roots)), rows + "has a part whose");
  expectAfter(set("elements/first_point", index, roots, Index(0) + 1), rows + "has a part whose");
  Results odd = good;
  odd.elements->indirect.values[7] = NAN;
  write(odd);
  expectInputError("/elements/indirect/values holds nan at 2");
  Results alone = good;
  alone.solution = {};
  write(alone);
  expectInputError("/elements comes without mesh and solution");
}

/// Where the described fields of a report lie.
class Places {
 public:
  std::vector<std::pair<const char*, std::size_t>> found;
  void operator()(const ReportLine& /*line*/, const auto& field) { add(field); }
  void part(const char* /*name*/, const auto& field) { add(field); }
  void table(const char* /*name*/, const auto& field, const auto& /*columns*/) { add(field); }
  void notes(const auto& field) { add(field); }
  void add(const auto& field) {
    found.emplace_back(reinterpret_cast<const char*>(&field), sizeof field);
  }
};

/// `beside`: fields that the file has elsewhere.
template <class Report, class... Beside>
void expectNoFieldIsLeftOut(Beside Report::*... beside) {
  const Report report;
  Places places;
  Report::describe(places, report);
  (places.add(report.*beside), ...);
  const auto* end = reinterpret_cast<const char*>(&report);
  places.found.emplace_back(end + sizeof report, 0);
  std::sort(places.found.begin(), places.found.end());
  for (const auto& [begin, size] : places.found) {
    EXPECT_LT(begin - end, std::ptrdiff_t(sizeof(double)));
    end = begin + size;
  }
}

TEST_F(ResultsFile, ReportsDescribeEveryFieldOfEightBytes) {
  expectNoFieldIsLeftOut<MeshReport>();
  expectNoFieldIsLeftOut<ClosureReport>();
  expectNoFieldIsLeftOut<ExactReport>();
  expectNoFieldIsLeftOut<RayReport>();
  expectNoFieldIsLeftOut<HemicubeReport>();
  expectNoFieldIsLeftOut<FormFactorReport>(&FormFactorReport::hemicube);
  expectNoFieldIsLeftOut<EnergyAccount>();
  expectNoFieldIsLeftOut<SolveSkips>();
  expectNoFieldIsLeftOut<SolveSummary>();
  expectNoFieldIsLeftOut<ElementReport>();
  expectNoFieldIsLeftOut<GatherPass>();
  expectNoFieldIsLeftOut<GatherSummary>(&GatherSummary::passes);
  expectNoFieldIsLeftOut<HeatBalance>();
  expectNoFieldIsLeftOut<HeatSummary>(&HeatSummary::balance);
}

TEST_F(ResultsFile, FiguresThatAReportLacksAreAsIfNothingWasCounted) {
  write(sample::results(3, Precision::single_precision));
  {
    Edit edit(file());
    edit.removeAttribute("/form_factors/report", "pixels");
    edit.removeAttribute("/form_factors/report/exact", "shaft_tests");
    edit.removeAttribute("/solution/summary", "solver");
  }
  const Results read = readResults(file());
  EXPECT_EQ(read.factors->report.hemicube.pixels, 0u);
  EXPECT_GT(read.factors->report.hemicube.skipped_hidden, 0u);
  EXPECT_EQ(read.factors->report.exact.shaft_tests, 0u);
  EXPECT_EQ(read.solution->summary.solver, Solver::automatic);
}

TEST_F(ResultsFile, TruncationIsAnInputError) {
  write(sample::results(12, Precision::single_precision));
  const std::vector<char> whole = load(file());
  const Results good = readResults(file());
  for (std::size_t k = 0; k < 200; ++k) {
    const std::size_t length = whole.size() * k / 200;
    save(file(), {whole.begin(), whole.begin() + std::ptrdiff_t(length)});
    expectInputError(length < 8     ? "not HDF5"
                     : length < 100 ? "truncated or damaged ("
                                    : "truncated or damaged (truncated file");
  }
}

TEST_F(ResultsFile, EveryFlippedByteIsNoticedOrHarmless) {
  write(sample::results(12, Precision::single_precision));
  const std::vector<char> whole = load(file());
  const Results good = readResults(file());
  std::size_t noticed = 0;
  std::size_t harmless = 0;
  // A prime step visits every kind of place; every byte of the first 2 KiB is visited.
  for (std::size_t at = 0; at < whole.size(); at += at < 2048 ? 1 : 151) {
    std::vector<char> damaged = whole;
    damaged[at] = char(damaged[at] ^ (1 << (at % 8)));
    save(file(), damaged);
    try {
      ASSERT_TRUE(sample::same(good, readResults(file()))) << "byte " << at;
      ++harmless;
    } catch (const InputError& error) {
      const std::string message = error.what();
      ASSERT_EQ(message.rfind(file(), 0), 0u) << message;
      ASSERT_EQ(message.find("unknown reason"), std::string::npos) << message;
      ++noticed;
    }
  }
  // Only unused space between blocks may be harmless.
  EXPECT_GT(noticed, 4 * harmless);
}

TEST_F(ResultsFile, FullDiskLeavesTheOldFile) {
  const Results small = sample::results(3, Precision::single_precision);
  const Results large = sample::results(20, Precision::single_precision);
  write(small);
  const std::size_t size = estimateResultsBytes(large);
  for (int part = 0; part < 40; ++part) {
    const FullDisk disk(part * size / 40);
    expectError<RunError>(file(), "cannot be written: File too large", [&] { write(large); });
    EXPECT_EQ(files(), 1u) << part;
  }
  EXPECT_TRUE(sample::same(small, readResults(file())));
  write(large);
  EXPECT_TRUE(sample::same(large, readResults(file())));
}

/// HDF5 1.10 crashes at exit after a file it could not flush; a process that met a full disk must
/// end as it means to.
TEST_F(ResultsFile, FullDiskDoesNotCrashTheExit) {
  const Results results = sample::results(20, Precision::single_precision);
  const auto run = [&] {
    const FullDisk disk(10000);
    try {
      write(results);
    } catch (const RunError&) {
      std::exit(3);
    }
  };
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(3), "^$");
}

TEST_F(ResultsFile, InterruptionLeavesTheOldFile) {
  const Results small = sample::results(3, Precision::single_precision);
  write(small);
  class Impatient : public Progress {
   public:
    void advance(std::size_t steps) override {
      done_ += steps;
      if (done_ > 100) cancel();
    }

   private:
    std::size_t done_ = 0;
  } impatient;
  EXPECT_THROW(writeResults(file(), sample::results(20, Precision::single_precision), impatient),
               Cancelled);
  EXPECT_EQ(files(), 1u);
  EXPECT_TRUE(sample::same(small, readResults(file())));
}

TEST_F(ResultsFile, MissingFolderIsAnInputError) {
  EXPECT_THROW(writeResults(path("no/x.h5"), {}, progress_), InputError);
  EXPECT_EQ(files(), 0u);
}

/// Neither while it reads damage nor when the process ends.
TEST_F(ResultsFile, HDF5PrintsNothing) {
  write(sample::results(12, Precision::single_precision));
  const std::vector<char> whole = load(file());
  const auto run = [&] {
    for (std::size_t part = 1; part < 100; ++part) {
      std::vector<char> bytes = whole;
      bytes[bytes.size() * part / 100] ^= 0x40;
      save(file(), bytes);
      try {
        readResults(file());
      } catch (const InputError&) {
        continue;
      }
    }
    std::exit(3);
  };
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(3), "^$");
}

}  // namespace
}  // namespace radiosity
