// Ctrl-C: a run that polls ends by itself, one that does not is ended, and neither leaves anything.
#include "cli/signal_guard.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "base/atomic_file.h"

namespace radiosity::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Answer {
  int code = -1;
  double seconds = 0;  ///< from the signal on
};

/// Runs `work` in a process of its own, which gets a SIGINT once it has made the file `begun`.
Answer interrupt(const fs::path& begun, const std::function<void(ConsoleProgress&)>& work) {
  const pid_t child = fork();
  if (child == 0) {
    ConsoleProgress progress(ProgressStyle::silent);
    int code = 0;
    {
      const SignalGuard guard(progress);
      try {
        work(progress);
      } catch (const Cancelled&) {
        code = 7;
      }
    }
    _exit(code);
  }
  while (!fs::exists(begun)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const Clock::time_point start = Clock::now();
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          std::chrono::duration<double>(Clock::now() - start).count()};
}

class Interrupted : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("signal_guard_" + std::to_string(getpid()));
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  void begin() const { std::ofstream(path("begun")) << "x"; }
  fs::path folder_;
};

// 0.35 s at most by design, the rest for a busy machine: far below the minute of sleep.
constexpr double kAnswer = 2;

TEST_F(Interrupted, StageThatNeverPollsIsEndedAndLeavesNothing) {
  const Answer answer = interrupt(folder_ / "begun", [&](ConsoleProgress&) {
    const AtomicFile file(path("out.h5"));
    std::ofstream(file.temporary()) << "half";
    begin();
    std::this_thread::sleep_for(std::chrono::minutes(1));
  });
  EXPECT_EQ(answer.code, 1);
  EXPECT_LT(answer.seconds, kAnswer);
  fs::remove(folder_ / "begun");
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Interrupted, StageThatPollsEndsByItself) {
  const Answer answer = interrupt(folder_ / "begun", [&](ConsoleProgress& progress) {
    const AtomicFile file(path("out.h5"));
    std::ofstream(file.temporary()) << "half";
    begin();
    while (true) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      progress.check();
    }
  });
  EXPECT_EQ(answer.code, 7);
  EXPECT_LT(answer.seconds, kAnswer);
  fs::remove(folder_ / "begun");
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Interrupted, CommittedFilesStay) {
  const Answer answer = interrupt(folder_ / "begun", [&](ConsoleProgress&) {
    AtomicFile whole(path("whole.h5"));
    std::ofstream(whole.temporary()) << "whole";
    whole.commit();
    const AtomicFile half(path("half.h5"));
    std::ofstream(half.temporary()) << "half";
    begin();
    std::this_thread::sleep_for(std::chrono::minutes(1));
  });
  EXPECT_EQ(answer.code, 1);
  fs::remove(folder_ / "begun");
  ASSERT_TRUE(fs::exists(path("whole.h5")));
  fs::remove(path("whole.h5"));
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace radiosity::cli
