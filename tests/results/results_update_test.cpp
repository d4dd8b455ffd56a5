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
    results.elements = {};
    results.gathered = {};
    Results unsolved = results;
    unsolved.solution = {};
    unsolved.materials.reset();
    writeResults(file(), unsolved, progress_);
    return results;
  }
};

/// updateResults() with a scene that has not changed.
bool update(const std::string& path, const Results& results) {
  return updateResults(path, results, true);
}

TEST_F(ResultsUpdate, AddsASolutionAndTouchesNothingElse) {
  const Results solved = writeUnsolved();
  const std::string before = bytes();
  ASSERT_TRUE(update(file(), solved));
  const std::string after = bytes();
  EXPECT_TRUE(sample::same(solved, readResults(file())));
  ASSERT_GT(after.size(), before.size());
  EXPECT_TRUE(before.substr(kPage) == after.substr(kPage, before.size() - kPage));
  EXPECT_LT(after.size() - before.size(), before.size() / 4) << "the matrix is not in it again";
}

TEST_F(ResultsUpdate, ReplacesAnyStageAndTouchesNothingElse) {
  const Results results = sample::results(kSide, Precision::single_precision);
  const auto expectUpdate = [&](const Results& changed, bool same_scene) {
    writeResults(file(), results, progress_);
    const std::string before = bytes();
    EXPECT_TRUE(updateResults(file(), changed, same_scene));
    const std::string after = bytes();
    EXPECT_GT(after.size(), before.size());
    EXPECT_TRUE(sample::same(changed, readResults(file())));
    EXPECT_TRUE(before.substr(kPage) == after.substr(kPage, before.size() - kPage));
  };
  expectUpdate(results, false);
  forEachStage([&](const auto& stage) {
    if (stage.stage == Stage::mesh || stage.stage == Stage::form_factors) return;
    SCOPED_TRACE(stage.name);
    Results changed = results;
    (changed.*stage.value).key += " changed";
    expectUpdate(changed, true);
  });
}

TEST_F(ResultsUpdate, ReplacesASolutionManyTimesAndThenAsksForTheWholeFile) {
  Results solved = writeUnsolved();
  const std::size_t whole = bytes().size();
  int updates = 0;
  for (; updates < 1000; ++updates) {
    solved.solution.key = "n=" + std::to_string(updates);
    solved.solution->radiosity[0] = updates;
    if (!update(file(), solved)) break;
    ASSERT_TRUE(sample::same(solved, readResults(file()))) << updates;
  }
  EXPECT_GT(updates, 3);
  EXPECT_GT(bytes().size(), whole * 3 / 2);
  EXPECT_LT(bytes().size(), whole * 2);
}

TEST_F(ResultsUpdate, TakesAStageOut) {
  Results results = writeUnsolved();
  ASSERT_TRUE(update(file(), results));
  results.solution = {};
  results.materials.reset();
  ASSERT_TRUE(update(file(), results));
  EXPECT_TRUE(sample::same(results, readResults(file())));
}

TEST_F(ResultsUpdate, LeavesTheFileToARunThatExtendsIt) {
  const Results solved = writeUnsolved();
  const std::string before = bytes();
  std::FILE* other = std::fopen(file().c_str(), "r+");
  ASSERT_EQ(flock(fileno(other), LOCK_EX), 0);
  EXPECT_FALSE(update(file(), solved));
  std::fclose(other);
  EXPECT_TRUE(bytes() == before);
}

TEST_F(ResultsUpdate, LeavesAFileWithOtherFormFactorsAlone) {
  Results solved = writeUnsolved();
  const std::string before = bytes();
  solved.factors.key = "of another run";
  EXPECT_FALSE(update(file(), solved));
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
    solved.solution.key = "round=" + std::to_string(round);
    if (!update(file(), solved)) writeUnsolved();
  }
  std::ofstream(path("done")) << "";
  int status = -1;
  waitpid(reader, &status, 0);
  EXPECT_EQ(status, 0) << "a read failed";
}

TEST_F(ResultsUpdate, LeavesAFileOfAnotherKindAlone) {
  std::ofstream(file()) << "no HDF5 at all";
  const std::string before = bytes();
  EXPECT_FALSE(update(file(), sample::results(3, Precision::single_precision)));
  EXPECT_EQ(bytes(), before);
}

// Bytes that a killed run wrote behind the end are overwritten by the next.
TEST_F(ResultsUpdate, OverwritesBytesThatAKilledRunLeftBehindTheEnd) {
  const Results solved = writeUnsolved();
  std::ofstream(file(), std::ios::binary | std::ios::app) << std::string(100000, 'x');
  EXPECT_FALSE(readResults(file()).solution);
  ASSERT_TRUE(update(file(), solved));
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
    const std::string known = readResults(file()).solution.key;
    solved.solution.key = "round=" + std::to_string(round);
    solved.solution->radiosity[0] = round;
    const pid_t child = fork();
    if (child == 0) _exit(update(file(), solved) ? 0 : 1);
    std::this_thread::sleep_for(std::chrono::microseconds(250 * round));
    if (round + 1 < kRounds) kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const Results read = readResults(file());
    ASSERT_TRUE(sample::same(read.factors, solved.factors)) << round;
    if (read.solution.key == solved.solution.key) {
      EXPECT_TRUE(sample::same(read.solution, solved.solution));
      ++done;
    } else {
      EXPECT_EQ(read.solution.key, known);
      ++undone;
    }
  }
  EXPECT_GT(undone, 0);
  EXPECT_GT(done, 0);
}

}  // namespace
}  // namespace radiosity
