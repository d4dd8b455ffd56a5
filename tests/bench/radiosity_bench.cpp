// radiosity_bench [arguments]: see tools/bench.
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>

#include "error_curves.h"
#include "eye_rates.h"
#include "figures.h"
#include "gather_costs.h"
#include "products.h"
#include "rates.h"
#include "report.h"
#include "summary.h"

namespace radiosity::bench {
namespace {

struct Arguments {
  bool quick = false;
  bool rates = true;
  bool eyes = true;
  bool truth = true;  ///< the curves need it; alone: rows are made and kept
  bool curves = true;
  bool figures = true;
  bool gather = true;
  std::string scene;  ///< this one alone; empty: all
  std::string out = "out/bench";
  std::string truth_folder = "build/bench/truth";
};

constexpr const char* kUsage =
    "[--quick] [--only rates|eyes|truth|curves|figures|gather] [--scene NAME] [--out DIR] [--help]";

[[noreturn]] void refuse(const std::string& argument) {
  throw InputError(fmt::format("'{}': give {}", argument, kUsage));
}

/// Empty: help was asked for.
std::optional<Arguments> parse(int count, char** values) {
  Arguments arguments;
  for (int k = 1; k < count; ++k) {
    const std::string name = values[k];
    const auto value = [&] {
      return k + 1 < count ? std::string(values[++k]) : (refuse(name), "");
    };
    if (name == "--help" || name == "-h") {
      return std::nullopt;
    } else if (name == "--quick") {
      arguments.quick = true;
    } else if (name == "--out") {
      arguments.out = value();
    } else if (name == "--scene") {
      arguments.scene = value();
    } else if (name == "--only") {
      const std::string part = value();
      if (part != "rates" && part != "eyes" && part != "truth" && part != "curves" &&
          part != "figures" && part != "gather") {
        refuse(part);
      }
      arguments.rates = part == "rates";
      arguments.eyes = part == "eyes";
      arguments.truth = part == "truth" || part == "curves";
      arguments.curves = part == "curves";
      arguments.figures = part == "figures";
      arguments.gather = part == "gather";
    } else {
      refuse(name);
    }
  }
  return arguments;
}

bool benchCurves(const Arguments& arguments) {
  fmt::print("\nError against time\n");
  std::vector<SceneCurves> all;
  Summary summary;
  bool verified = true;
  for (const CurveScene& scene : curveScenes(arguments.quick)) {
    if (!arguments.scene.empty() && scene.name != arguments.scene) continue;
    const BenchScene bench = benchScene(scene.name, scene.patches);
    setThreads(0);
    const TruthRows truth = truthRows(bench.mesh, scene.truth_accuracy, arguments.truth_folder);
    if (!arguments.curves) continue;
    const auto curves = errorCurves(bench, truth, scene.truth_accuracy, arguments.quick);
    if (!curves) {
      verified = false;
      continue;
    }
    all.push_back(*curves);
    for (const RayComparison& c : compareWithRays(*curves)) summary.comparisons.push_back(c);
    // After every scene, so that an interrupted run leaves what it has.
    writeCsv(arguments.out + "/error-against-time.csv", all);
    writeComparisonsCsv(arguments.out + "/exact-against-rays.csv", summary.comparisons);
  }
  summary.growth = growth(all);
  if (arguments.curves && arguments.scene.empty() && verified) {
    summary.two_cores =
        measureTwoCores(benchScene("cornell-box-closed", arguments.quick ? 1000 : 5000).mesh);
    if (!arguments.quick) summary.whole_run = measureWholeRun(arguments.out);
  }
  printSummary(summary);
  return verified;
}

}  // namespace
}  // namespace radiosity::bench

int main(int count, char** values) try {
  using namespace radiosity::bench;
  const std::optional<Arguments> given = parse(count, values);
  if (!given) {
    fmt::print("radiosity_bench {}\n", kUsage);
    return EXIT_SUCCESS;
  }
  const Arguments& arguments = *given;
  std::filesystem::create_directories(arguments.out);
  bool verified = true;
  if (arguments.rates) {
    verified = benchRates() && verified;
    verified = benchProducts() && verified;
  }
  if (arguments.eyes) verified = benchEyes() && verified;
  if (arguments.truth) verified = benchCurves(arguments) && verified;
  if (arguments.figures && !arguments.quick) {
    benchFigures(arguments.scene, arguments.truth_folder);
  }
  if (arguments.gather) verified = benchGather(arguments.quick, arguments.out) && verified;
  return verified ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const radiosity::InputError& error) {
  fmt::print(stderr, "radiosity_bench: {}\n", error.what());
  return 2;
} catch (const std::exception& error) {
  fmt::print(stderr, "radiosity_bench: {}\n", error.what());
  return EXIT_FAILURE;
}
