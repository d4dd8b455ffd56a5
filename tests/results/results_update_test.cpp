// A results file that is extended: the form factors are not written again, and a run killed
// meanwhile leaves the file as it was, or whole.
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "results_sample.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

constexpr std::size_t kPage = 4096;
constexpr Index kSide = 24;  // some chunks of matrix, some of solution

class ResultsUpdate : public FolderTest {
 protected:
  std::string file() const { return path("x.h5"); }
  std::string bytes() const {
    std::ifstream in(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// The file without the solution and stages that depend on it.
  Results writeUnsolved() {
    Results results = sample::results(kSide, Precision::single_precision);
    results.elements.reset(), results.elements_key.clear();
    results.gathered.reset(), results.gather_key.clear();
    Results unsolved = results;
    unsolved.solution.reset(), unsolved.solution_key.clear();
    unsolved.materials.reset();
    writeResults(file(), unsolved, progress_);
    return results;
  }
};

constexpr StagesAsStored kButTheSolution = {.scene = true,
                                            .solution = false,
                                            .elements = true,
                                            .gathered = true,
                                            .heat = true,
                                            .basis = true};

TEST_F(ResultsUpdate, AddsASolutionAndTouchesNothingElse) {
  const Results solved = writeUnsolved();
  const std::string before = bytes();
  ASSERT_TRUE(updateResults(file(), solved, kButTheSolution));
  const std::string after = bytes();
  EXPECT_TRUE(sample::same(solved, readResults(file())));
  ASSERT_GT(after.size(), before.size());
  EXPECT_TRUE(before.substr(kPage) == after.substr(kPage, before.size() - kPage));
  EXPECT_LT(after.size() - before.size(), before.size() / 4) << "the matrix is not in it again";
}

TEST_F(ResultsUpdate, ReplacesAnyStageAndTouchesNothingElse) {
  const Results results = sample::results(kSide, Precision::single_precision);
  const StagesAsStored all{.scene = true,
                           .solution = true,
                           .elements = true,
                           .gathered = true,
                           .heat = true,
                           .basis = true};
  const std::pair<const char*, bool StagesAsStored::*> stages[] = {
      {"scene", &StagesAsStored::scene},       {"solution", &StagesAsStored::solution},
      {"elements", &StagesAsStored::elements}, {"gathered", &StagesAsStored::gathered},
      {"heat", &StagesAsStored::heat},         {"basis", &StagesAsStored::basis}};
  for (const auto& [name, stage] : stages) {
    SCOPED_TRACE(name);
    writeResults(file(), results, progress_);
    const std::string before = bytes();
    StagesAsStored stored = all;
    stored.*stage = false;
    EXPECT_TRUE(updateResults(file(), results, stored));
    const std::string after = bytes();
    EXPECT_TRUE(sample::same(results, readResults(file())));
    EXPECT_TRUE(before.substr(kPage) == after.substr(kPage, before.size() - kPage));
  }
}

TEST_F(ResultsUpdate, ReplacesASolutionManyTimesAndThenAsksForTheWholeFile) {
  Results solved = writeUnsolved();
  const std::size_t whole = bytes().size();
  int updates = 0;
  for (; updates < 1000; ++updates) {
    solved.solution_key = "n=" + std::to_string(updates);
    solved.solution->radiosity[0] = updates;
    if (!updateResults(file(), solved, kButTheSolution)) break;
    ASSERT_TRUE(sample::same(solved, readResults(file()))) << updates;
  }
  EXPECT_GT(updates, 3);
  EXPECT_GT(bytes().size(), whole * 3 / 2);
  EXPECT_LT(bytes().size(), whole * 2);
}

TEST_F(ResultsUpdate, TakesAStageOut) {
  Results results = writeUnsolved();
  ASSERT_TRUE(updateResults(file(), results, kButTheSolution));
  results.solution.reset(), results.solution_key.clear();
  results.materials.reset();
  ASSERT_TRUE(updateResults(file(), results, kButTheSolution));
  EXPECT_TRUE(sample::same(results, readResults(file())));
}

TEST_F(ResultsUpdate, LeavesTheFileToARunThatExtendsIt) {
  const Results solved = writeUnsolved();
  const std::string before = bytes();
  std::FILE* other = std::fopen(file().c_str(), "r+");
  ASSERT_EQ(flock(fileno(other), LOCK_EX), 0);
  EXPECT_FALSE(updateResults(file(), solved, kButTheSolution));
  std::fclose(other);
  EXPECT_TRUE(bytes() == before);
}

TEST_F(ResultsUpdate, LeavesAFileWithOtherFormFactorsAlone) {
  Results solved = writeUnsolved();
  const std::string before = bytes();
  solved.factors_key = "of another run";
  EXPECT_FALSE(updateResults(file(), solved, kButTheSolution));
  EXPECT_TRUE(bytes() == before);
}

// HDF5 asks for the length of a file before it reads the end that its first page names.
TEST_F(ResultsUpdate, MayBeReadWhileAnotherRunSwitchesTheFile) {
  Results solved = writeUnsolved();
  const pid_t reader = fork();
  if (reader == 0) {
    int failures = 0;
    while (access(path("done").c_str(), F_OK) != 0) {
      try {
        readResults(file());
      } catch (const InputError&) {
        ++failures;
      }
    }
    _exit(failures == 0 ? 0 : 1);
  }
  for (int round = 0; round < 300; ++round) {
    solved.solution_key = "round=" + std::to_string(round);
    if (!updateResults(file(), solved, kButTheSolution)) writeUnsolved();
  }
  std::ofstream(path("done")) << "";
  int status = -1;
  waitpid(reader, &status, 0);
  EXPECT_EQ(status, 0) << "a read failed";
}

TEST_F(ResultsUpdate, LeavesAFileOfAnotherKindAlone) {
  std::ofstream(file()) << "no HDF5 at all";
  const std::string before = bytes();
  EXPECT_FALSE(
      updateResults(file(), sample::results(3, Precision::single_precision), kButTheSolution));
  EXPECT_EQ(bytes(), before);
}

// Bytes that a killed run wrote behind the end are overwritten by the next.
TEST_F(ResultsUpdate, OverwritesBytesThatAKilledRunLeftBehindTheEnd) {
  const Results solved = writeUnsolved();
  std::ofstream(file(), std::ios::binary | std::ios::app) << std::string(100000, 'x');
  EXPECT_FALSE(readResults(file()).solution);
  ASSERT_TRUE(updateResults(file(), solved, kButTheSolution));
  EXPECT_TRUE(sample::same(solved, readResults(file())));
}

// Processes killed after 0 to 20 ms: some before, some within, some after the update. The last one
// is left alone.
TEST_F(ResultsUpdate, AKillAtAnyMomentLeavesTheFileAsItWasOrWhole) {
  Results solved = writeUnsolved();
  int done = 0;
  int undone = 0;
  constexpr int kRounds = 80;
  for (int round = 0; round < kRounds; ++round) {
    const std::string known = readResults(file()).solution_key;
    solved.solution_key = "round=" + std::to_string(round);
    solved.solution->radiosity[0] = round;
    const pid_t child = fork();
    if (child == 0) _exit(updateResults(file(), solved, kButTheSolution) ? 0 : 1);
    std::this_thread::sleep_for(std::chrono::microseconds(250 * round));
    if (round + 1 < kRounds) kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const Results read = readResults(file());
    ASSERT_TRUE(sample::same(read.factors, solved.factors)) << round;
    if (read.solution_key == solved.solution_key) {
      EXPECT_TRUE(sample::same(read.solution, solved.solution));
      ++done;
    } else {
      EXPECT_EQ(read.solution_key, known);
      ++undone;
    }
  }
  EXPECT_GT(undone, 0);
  EXPECT_GT(done, 0);
}

}  // namespace
}  // namespace radiosity
