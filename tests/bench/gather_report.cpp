#include "gather_report.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <cmath>
#include <cstdio>

namespace radiosity::bench {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

/// The measurement with the least or the most passes.
const GatherCost& extreme(const GatherCosts& costs, const std::string& method, bool most) {
  const GatherCost* found = nullptr;
  for (const GatherCost& cost : costs.costs) {
    if (cost.method != method) continue;
    if (found == nullptr || most == (cost.passes > found->passes)) found = &cost;
  }
  return *found;
}

double seconds(const GatherCost& cost) { return cost.timing.seconds.processor(); }

/// Passes that take as long as `budget` seconds.
double passesFor(const GatherCosts& costs, const std::string& gather, double budget) {
  const GatherCost& few = extreme(costs, gather, false);
  const GatherCost& many = extreme(costs, gather, true);
  const double a_pass = (seconds(many) - seconds(few)) / (many.passes - few.passes);
  return few.passes + (budget - seconds(few)) / a_pass;
}

/// Patches at which both take the same memory.
double patchesForMemory(const std::vector<GatherCosts>& all, const std::string& matrix,
                        const std::string& gather) {
  const auto gap = [&](std::size_t k) {
    return std::log(double(extreme(all[k], matrix, true).bytes) /
                    double(extreme(all[k], gather, true).bytes));
  };
  std::size_t k = 1;
  while (k + 1 < all.size() && gap(k) < 0) ++k;
  const double before = std::log(double(all[k - 1].patches));
  const double after = std::log(double(all[k].patches));
  return std::exp(before + (after - before) * gap(k - 1) / (gap(k - 1) - gap(k)));
}

}  // namespace

void printGatherHead(const GatherCosts& costs) {
  fmt::print(
      "  {} eyes at vertices; one thread, processor time; error: of the light reflected, relL2, "
      "against\n  a tighter exact matrix; memory: the matrix alone, or all that gathering holds\n",
      costs.eyes);
  fmt::print("  {:<18} {:>6} | {:>9} {:>9} | {:>8} | {:>8}\n", "method", "passes", "seconds",
             "wall", "error", "MiB");
}

void printGatherCost(const GatherCost& cost) {
  fmt::print("  {:<18} {:>6} | {:>9.3f} {:>9.3f} | {:>8.1e} | {:>8.2f}\n", cost.method,
             cost.passes > 0 ? fmt::format("{}", cost.passes) : "-", seconds(cost),
             cost.timing.seconds.wall, cost.error, double(cost.bytes) / kMebibyte);
  std::fflush(stdout);
}

void printCrossings(const std::vector<GatherCosts>& all) {
  if (all.empty()) return;
  fmt::print("\nWhere the lines cross\n");
  for (const char* gather : {kGatherAtPatches, kGatherAtVertices}) {
    for (const char* matrix : {kHemicubeSolved, kExactSolved}) {
      fmt::print("  {} takes as long as the {}, solved, at", gather, matrix);
      for (const GatherCosts& costs : all) {
        fmt::print(" {:.1f} passes ({} patches)",
                   passesFor(costs, gather, seconds(extreme(costs, matrix, true))), costs.patches);
      }
      if (all.size() > 1) {
        fmt::print("; as much memory at about {:.0f} patches",
                   patchesForMemory(all, matrix, gather));
      }
      fmt::print("\n");
    }
  }
}

void writeGatherCsv(const std::string& path, const std::vector<GatherCosts>& all) {
  auto out = fmt::output_file(path);
  out.print(
      "scene,patches,eyes_at_vertices,method,passes,user_s,system_s,wall_s,runs,"
      "relative_l2_reflected,bytes\n");
  for (const GatherCosts& costs : all) {
    for (const GatherCost& c : costs.costs) {
      const Seconds& s = c.timing.seconds;
      out.print("{},{},{},{},{},{:.6f},{:.6f},{:.6f},{},{:.6e},{}\n", costs.scene, costs.patches,
                costs.eyes, c.method, c.passes, s.user, s.system, s.wall, c.timing.runs, c.error,
                c.bytes);
    }
  }
}

}  // namespace radiosity::bench
