// property [--minutes N | --scenes N] [--seed S] [--kind K] [--folder DIR] [--shrink SECONDS]
// [--limit SECONDS]: random scenes by all methods, and what must hold of each; see ../README.md.
// Exit code 1 if something does not hold: the scene is then in the folder, with the command that
// shows it.
#include <fmt/format.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "checks.h"
#include "kinds.h"
#include "shrink.h"

namespace radiosity::property {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  double minutes = 0;  ///< 0: a number of scenes
  std::size_t scenes = 160;
  std::uint64_t seed = 1;
  std::string kind;  ///< empty: all
  std::string folder;
  double shrink_seconds = 20;
  long most_seconds = 120;  ///< of a scene
};

template <class Value>
Value number(const std::string& name, const std::string& text) {
  Value value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::invalid_argument(fmt::format("{} {}: give a number", name, text));
  }
  return value;
}

Arguments parse(const std::vector<std::string>& words) {
  Arguments given;
  given.folder = (std::filesystem::temp_directory_path() / "property").string();
  for (std::size_t k = 0; k < words.size(); k += 2) {
    const std::string& name = words[k];
    if (k + 1 == words.size()) throw std::invalid_argument(name + " needs a value");
    const std::string& value = words[k + 1];
    if (name == "--minutes")
      given.minutes = number<double>(name, value);
    else if (name == "--scenes")
      given.scenes = number<std::size_t>(name, value);
    else if (name == "--seed")
      given.seed = number<std::uint64_t>(name, value);
    else if (name == "--kind")
      given.kind = value;
    else if (name == "--folder")
      given.folder = value;
    else if (name == "--shrink")
      given.shrink_seconds = number<double>(name, value);
    else if (name == "--limit")
      given.most_seconds = number<long>(name, value);
    else
      throw std::invalid_argument("no option " + name);
  }
  return given;
}

/// For the handler of signals: the scene that is being looked at.
char current_scene[512];

void tell(const char* text) { [[maybe_unused]] const auto n = write(2, text, std::strlen(text)); }

/// A crash, an assertion of a library, or a scene without end.
extern "C" void onSignal(int signal) {
  tell(signal == SIGPROF ? "\nproperty: TIME: " : "\nproperty: CRASH: ");
  tell(current_scene);
  tell("\n");
  _exit(1);
}

/// Ends the program after so many seconds of its own processor time; 0: never.
void limit(long seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

class Run {
 public:
  explicit Run(Arguments given) : given_(std::move(given)) {
    std::filesystem::create_directories(given_.folder);
    current_ =
        (std::filesystem::path(given_.folder) / fmt::format("current-{}", getpid())).string();
    for (const Kind& kind : kinds()) {
      if (given_.kind.empty() || given_.kind == kind.name) chosen_.push_back(kind);
    }
    if (chosen_.empty()) throw std::invalid_argument("no kind " + given_.kind);
  }

  int operator()() {
    const Clock::time_point start = Clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(Clock::now() - start).count();
    };
    const auto more = [&] {
      return given_.minutes > 0 ? seconds() < 60 * given_.minutes : scenes_ < given_.scenes;
    };
    for (std::uint64_t seed = given_.seed; more(); ++seed) {
      for (const Kind& kind : chosen_) {
        if (more()) look(kind, seed);
      }
    }
    std::filesystem::remove(current_ + ".obj");
    std::filesystem::remove(current_ + ".mtl");
    return report(seconds());
  }

 private:
  void look(const Kind& kind, std::uint64_t seed) {
    const Clock::time_point start = Clock::now();
    const Model model = makeModel(kind, seed);
    model.write(current_);
    const auto end =
        fmt::format_to_n(current_scene, sizeof current_scene - 1, "--kind {} --seed {}: {}",
                         kind.name, seed, model.command(current_));
    *end.out = 0;
    limit(given_.most_seconds);
    const Findings findings = check(model, current_);
    limit(0);
    ++scenes_;
    ++made_[kind.name];
    seconds_[kind.name] += std::chrono::duration<double>(Clock::now() - start).count();
    refused_ += findings.refused;
    too_long_ += findings.too_long;
    for (const auto& [method, count] : findings.rows) {
      rows_[method].add(count);
      rows_of_kind_[fmt::format("{} {}", kind.name, method)].add(count);
    }
    for (const Fault& fault : findings.faults) found(model, fault);
  }

  /// Keeps the first scenes of each fault in a kind, as small as they can be made.
  void found(const Model& model, const Fault& fault) {
    std::size_t& times = faults_[fmt::format("{} ({})", fault.what, model.kind)];
    if (++times > 3) return;
    std::string name = fmt::format("{}-{}-{}", model.kind, model.seed, fault.what);
    std::replace(name.begin(), name.end(), ' ', '_');
    const std::string path = (std::filesystem::path(given_.folder) / name).string();
    Model least = model;
    if (times == 1 && given_.shrink_seconds > 0) {
      least = shrunk(model, fault.what, current_, given_.shrink_seconds);
    }
    least.write(path);
    fmt::print("property: --kind {} --seed {}: {}: {}\n  {}\n", model.kind, model.seed, fault.what,
               fault.detail, least.command(path));
    std::fflush(stdout);
  }

  int report(double seconds) const {
    bool held = faults_.empty();
    fmt::print(
        "property: {} scenes in {:.0f} s, {} refused with a cure, {} computations too long\n",
        scenes_, seconds, refused_, too_long_);
    for (const auto& [kind, number] : made_) {
      fmt::print("  {:<10} {:>6} scenes, {:.2f} s each\n", kind, number,
                 seconds_.at(kind) / double(number));
    }
    for (const auto& [method, count] : rows_) held = rowsHold(method, count) && held;
    for (const auto& [name, count] : rows_of_kind_) held = rowsHold(name, count) && held;
    for (const auto& [fault, times] : faults_) fmt::print("  {} x {}\n", times, fault);
    fmt::print("property: {}\n", held ? "all held" : "FAILED");
    return held ? EXIT_SUCCESS : EXIT_FAILURE;
  }

  /// 99% of rows are within their figures. Rows of a scene are alike, so a kind is judged once it
  /// has several scenes' worth.
  static bool rowsHold(const std::string& name, const RowCount& count) {
    const double inside = 1 - double(count.beyond) / double(std::max<std::size_t>(1, count.rows));
    const bool holds = inside >= 0.99 || count.rows < 1000;
    fmt::print("  rows within figures, {:<18} {:>8} rows, {:.2f}%, worst {:.2f} ({}){}\n", name,
               count.rows, 100 * inside, count.worst, count.worst_scene, holds ? "" : " FAILED");
    return holds;
  }

  Arguments given_;
  std::vector<Kind> chosen_;
  std::string current_;
  std::size_t scenes_ = 0;
  std::size_t refused_ = 0;
  std::size_t too_long_ = 0;
  std::map<std::string, std::size_t> made_;
  std::map<std::string, double> seconds_;
  std::map<std::string, std::size_t> faults_;
  std::map<std::string, RowCount> rows_;
  std::map<std::string, RowCount> rows_of_kind_;
};

}  // namespace
}  // namespace radiosity::property

int main(int count, char** values) try {
  using namespace radiosity::property;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF}) {
    std::signal(signal, onSignal);
  }
  radiosity::setThreads(1);
  return Run(parse({values + 1, values + count}))();
} catch (const std::exception& error) {
  fmt::print(stderr, "property: {}\n", error.what());
  return 2;
}
