// Lines in a pipe: their text and frequency.
#include "cli/console_progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <regex>
#include <string>
#include <thread>
#include <vector>

namespace radiosity::cli {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// The number of "1,000".
double count(std::string text) {
  std::erase(text, ',');
  return std::stod(text);
}

/// On a busy machine the first steps may take so long that minutes are left.
constexpr const char* kLeft = "([0-9]+ min )?[0-9.]+ s left";

/// The lines of a stage of 1,000 steps of 1 ms, 500 of which are `done` before, or none.
std::vector<std::string> said(ConsoleProgress& progress, const std::string& steps,
                              std::size_t done) {
  testing::internal::CaptureStderr();
  progress.begin("form factors", 1000, steps, done);
  for (std::size_t k = done; k < 1000; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    progress.advance();
  }
  progress.end();
  return linesOf(testing::internal::GetCapturedStderr());
}

TEST(ConsoleProgress, LinesGiveRowsTimeAndMemory) {
  ConsoleProgress progress(ProgressStyle::lines, {.first = 0.2, .between = 0.3});
  const std::vector<std::string> lines = said(progress, "rows", 0);
  ASSERT_GE(lines.size(), 3u);
  const std::regex form(std::string("form factors: ([0-9,]+) of 1,000 rows \\(([0-9]+)%\\), ") +
                        kLeft + ", [0-9.]+ [KMG]iB of memory");
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
    std::smatch found;
    ASSERT_TRUE(std::regex_match(lines[k], found, form)) << lines[k];
    EXPECT_NEAR(count(found[1]) / 10, std::stod(found[2]), 0.51) << lines[k];
  }
  EXPECT_TRUE(std::regex_match(lines.back(), std::regex("form factors: done in .*"))) << lines[0];
}

TEST(ConsoleProgress, StepsWithoutANameArePercentages) {
  ConsoleProgress progress(ProgressStyle::lines, {.first = 0.3, .between = 60});
  const std::vector<std::string> lines = said(progress, "", 0);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(std::regex_match(
      lines[0], std::regex(std::string("form factors: [0-9]+%, ") + kLeft + ", .* of memory")))
      << lines[0];
}

TEST(ConsoleProgress, TimeLeftFollowsTheStepsOfThisRunAlone) {
  // 500 steps were there. After 50 more, 450 are left and take nine times as long; if the earlier
  // 500 counted as done in this time, they would take less than it.
  ConsoleProgress progress(ProgressStyle::lines, {.first = 0, .between = 60});
  testing::internal::CaptureStderr();
  progress.begin("form factors", 1000, "rows", 500);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  progress.advance(50);
  progress.end();
  const std::string text = testing::internal::GetCapturedStderr();
  std::smatch found;
  ASSERT_TRUE(std::regex_search(text, found, std::regex("550 of 1,000 rows.*, ([0-9.]+) s left")))
      << text;
  EXPECT_GE(std::stod(found[1]), 0.9) << text;
}

TEST(ConsoleProgress, LinesAreAMinuteApart) {
  const ConsoleProgress::LineTimes times;
  EXPECT_EQ(times.between, 60);
}

}  // namespace
}  // namespace radiosity::cli
