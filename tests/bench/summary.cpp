#include "summary.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "radiosity/results.h"

namespace radiosity::bench {
namespace {

constexpr double kDefaultTolerance = 1e-3;
constexpr int kCoreRounds = 5;
constexpr std::ptrdiff_t kLawPoints = 3;

PowerLaw fit(const std::vector<Measurement>& points) {
  double x = 0;
  double y = 0;
  double xx = 0;
  double xy = 0;
  for (const Measurement& m : points) {
    const double time = std::log(m.seconds.processor());
    const double error = std::log(m.factors.relative_l2);
    x += time;
    y += error;
    xx += time * time;
    xy += time * error;
  }
  const auto n = double(points.size());
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return {std::exp((y - slope * x) / n), slope};
}

std::vector<Measurement> curve(const SceneCurves& curves, const std::string& method) {
  std::vector<Measurement> points;
  for (const Measurement& m : curves.measurements) {
    if (m.method == method) points.push_back(m);
  }
  std::sort(points.begin(), points.end(), [](const Measurement& a, const Measurement& b) {
    return a.seconds.processor() < b.seconds.processor();
  });
  return points;
}

const Measurement* defaultExact(const SceneCurves& curves) {
  for (const Measurement& m : curves.measurements) {
    if (m.method == "exact" && m.value == kDefaultTolerance) return &m;
  }
  return nullptr;
}

}  // namespace

double PowerLaw::secondsAt(double error) const { return std::pow(error / factor, 1 / slope); }

std::vector<RayComparison> compareWithRays(const SceneCurves& curves) {
  const std::vector<Measurement> exact = curve(curves, "exact");
  std::vector<RayComparison> comparisons;
  std::vector<Measurement> rays = curve(curves, kRays);
  // The cheapest points pay for setting up and trace small, incoherent batches: the law is that
  // of the dearest.
  if (std::ssize(rays) > kLawPoints) rays.erase(rays.begin(), rays.end() - kLawPoints);
  if (rays.size() < 2) return comparisons;
  for (const double error : {1e-2, 1e-3}) {
    const auto reached = std::find_if(exact.begin(), exact.end(), [&](const Measurement& m) {
      return m.factors.relative_l2 <= error;
    });
    if (reached == exact.end()) continue;
    RayComparison c;
    c.scene = curves.scene;
    c.patches = curves.patches;
    c.curve = kRays;
    c.error = error;
    c.exact_seconds = reached->seconds.processor();
    c.exact_tolerance = reached->value;
    c.exact_error = reached->factors.relative_l2;
    c.rays = fit(rays);
    c.ray_seconds = c.rays.secondsAt(error);
    c.extrapolated = error < rays.back().factors.relative_l2;
    comparisons.push_back(c);
  }
  return comparisons;
}

std::optional<Growth> growth(const std::vector<SceneCurves>& curves) {
  Growth growth;
  for (const SceneCurves& c : curves) {
    const Measurement* m = defaultExact(c);
    if (c.scene != "cornell-box-closed" || m == nullptr) continue;
    if (c.patches > 800 && c.patches < 1200) {
      growth.from = c.patches;
      growth.from_seconds = m->seconds.processor();
    } else if (c.patches > 16000 && c.patches < 24000) {
      growth.to = c.patches;
      growth.to_seconds = m->seconds.processor();
    }
  }
  if (growth.from == 0 || growth.to == 0) return std::nullopt;
  growth.exponent = std::log(growth.to_seconds / growth.from_seconds) /
                    std::log(double(growth.to) / double(growth.from));
  return growth;
}

TwoCores measureTwoCores(const PatchMesh& mesh) {
  const Method method = exact(kDefaultTolerance);
  std::vector<double> one;
  TwoCores result;
  result.patches = mesh.size();
  result.two = HUGE_VAL;
  for (int round = 0; round < kCoreRounds; ++round) {
    setThreads(1);
    const Stopwatch alone;
    method.compute(mesh);
    one.push_back(alone.elapsed().wall);
    setThreads(2);
    const Stopwatch both;
    method.compute(mesh);
    const Seconds seconds = both.elapsed();
    if (seconds.wall < result.two) {
      result.two = seconds.wall;
      result.busy = seconds.processor() / seconds.wall;
    }
  }
  setThreads(0);
  result.one = least(one);
  return result;
}

WholeRun measureWholeRun(const std::string& folder) {
  const std::string scene = RADIOSITY_SOURCE_DIR "/data/cluttered.obj";
  const std::string file = folder + "/cluttered-20000.h5";
  const Stopwatch watch;
  const pid_t child = fork();
  if (child == 0) {
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);
    execl(RADIOSITY_PROGRAM, "radiosity", "factors", scene.c_str(), "--patches", "20000",
          "--method", "exact", "--threads", "2", "-o", file.c_str(), nullptr);
    _exit(127);
  }
  WholeRun run;
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) < 0) throw RunError("cannot run the program");
  run.wall = watch.elapsed().wall;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  run.processor = double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                  1e-6 * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  run.peak_mebibytes = double(usage.ru_maxrss) / 1024;
  if (run.exit_code == 0) {
    run.file_bytes = std::filesystem::file_size(file);
    run.patches = readResults(file, false).mesh->mesh.size();
    std::filesystem::remove(file);
  }
  return run;
}

}  // namespace radiosity::bench
