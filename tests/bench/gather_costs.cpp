#include "gather_costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench_scenes.h"
#include "gather_report.h"
#include "lighting.h"
#include "methods.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/gather.h"

namespace radiosity::bench {
namespace {

constexpr const char* kScene = "cornell-box-closed";
constexpr int kResolution = 256;
constexpr double kMatrixTolerance = 1e-3;
constexpr double kReferenceTolerance = 1e-4;
/// Of the matrix methods' solution: the default. The reference's is far below all errors here.
const double kSolveTolerance = SolveOptions().tolerance;
constexpr double kReferenceSolveTolerance = 1e-9;

GatherOptions optionsOf(GatherAt at, int passes) {
  GatherOptions options;
  options.at = at;
  options.resolution = kResolution;
  options.passes = passes;
  options.tolerance = 1e-12;  // out of reach of floats: all passes are made
  return options;
}

Gathered gathered(const BenchScene& scene, const PatchMaterials& materials, GatherAt at,
                  int passes) {
  Progress silent;
  return gather(scene.mesh, materials, optionsOf(at, passes), silent);
}

/// Largest |gathered - Jacobi iterate| over the largest emission after three passes: rounding to
/// floats alone, 6e-8 of each value a pass.
double jacobiGap(const BenchScene& scene, const Lighting& lighting) {
  constexpr int kPasses = 3;
  const FormFactors factors = hemicube(kResolution, false).compute(scene.mesh);
  std::vector<double> b = lighting.emission();
  for (int k = 0; k < kPasses; ++k) b = lighting.bounce(pairsOf(*factors.matrix), b);
  const Gathered g = gathered(scene, lighting.materials(), GatherAt::patches, kPasses);
  double gap = 0;
  for (std::size_t k = 0; k < b.size(); ++k) gap = std::max(gap, std::abs(b[k] - g.radiosity[k]));
  return gap / *std::max_element(lighting.emission().begin(), lighting.emission().end());
}

/// Largest |B - 3/2| after one pass at vertices where E = 1 and rho = 1/2 all over.
double furnaceGap(const BenchScene& scene) {
  PatchMaterials uniform;
  uniform.bands = 1;
  uniform.reflectance.assign(scene.mesh.size(), 0.5);
  uniform.emission.assign(scene.mesh.size(), 1.0);
  const Gathered g = gathered(scene, uniform, GatherAt::vertices, 1);
  double gap = 0;
  for (const float b : g.radiosity) gap = std::max(gap, std::abs(double(b) - 1.5));
  return gap;
}

bool verify(const BenchScene& scene, const Lighting& lighting) {
  constexpr double kMost = 1e-6;
  const double jacobi = jacobiGap(scene, lighting);
  const double furnace = furnaceGap(scene);
  const bool good = jacobi <= kMost && furnace <= kMost;
  fmt::print(
      "  at patches against the matrix's Jacobi iterate {:.1e}, furnace at vertices {:.1e}{}\n",
      jacobi, furnace, good ? "" : ": NOT VERIFIED");
  return good;
}

GatherCost matrixCost(const std::string& name, const Method& method, const BenchScene& scene,
                      const Lighting& lighting, const std::vector<double>& reference) {
  GatherCost cost;
  cost.method = name;
  std::vector<double> b;
  cost.timing = leastOfRuns([&] {
    const Stopwatch watch;
    const FormFactors factors = method.compute(scene.mesh);
    b = lighting.solve(factors, kSolveTolerance);
    cost.bytes = factors.matrix->bytes();
    return watch.elapsed();
  });
  cost.error = relativeError(scene.mesh, b, reference, lighting.emission());
  return cost;
}

GatherCost gatherCost(GatherAt at, int passes, const BenchScene& scene, const Lighting& lighting,
                      const std::vector<double>& reference) {
  GatherCost cost;
  cost.method = at == GatherAt::patches ? kGatherAtPatches : kGatherAtVertices;
  cost.passes = passes;
  Gathered light;
  cost.timing = leastOfRuns([&] {
    const Stopwatch watch;
    light = gathered(scene, lighting.materials(), at, passes);
    return watch.elapsed();
  });
  cost.bytes = light.summary.bytes;
  cost.error =
      relativeError(scene.mesh, patchRadiosity(scene.mesh, light), reference, lighting.emission());
  return cost;
}

GatherCosts measure(const BenchScene& scene, const Lighting& lighting, int most_passes) {
  setThreads(0);
  const std::vector<double> reference =
      lighting.solve(exact(kReferenceTolerance).compute(scene.mesh), kReferenceSolveTolerance);
  GatherCosts all;
  all.scene = scene.name;
  all.patches = scene.mesh.size();
  all.eyes = cornerGroups(scene.mesh, GatherOptions().crease).size();
  printGatherHead(all);
  const auto add = [&](const GatherCost& cost) {
    printGatherCost(cost);
    all.costs.push_back(cost);
  };
  setThreads(1);
  add(matrixCost(kExactSolved, exact(kMatrixTolerance), scene, lighting, reference));
  add(matrixCost(kHemicubeSolved, hemicube(kResolution, false), scene, lighting, reference));
  for (const GatherAt at : {GatherAt::patches, GatherAt::vertices}) {
    for (int passes = 1; passes <= most_passes; passes *= 2) {
      add(gatherCost(at, passes, scene, lighting, reference));
    }
  }
  setThreads(0);
  return all;
}

}  // namespace

bool benchGather(bool quick, const std::string& folder) {
  fmt::print("\nGather beside matrix\n");
  std::vector<GatherCosts> all;
  bool verified = true;
  for (const std::size_t patches : {250u, 1000u, 4000u}) {
    if (quick && patches > 1000) continue;
    const BenchScene scene = benchScene(kScene, patches);
    const Lighting lighting(scene);
    fmt::print("\n{}: {} patches\n", scene.name, scene.mesh.size());
    if (!verify(scene, lighting)) {
      verified = false;
      continue;
    }
    all.push_back(measure(scene, lighting, quick ? 4 : 16));
    writeGatherCsv(folder + "/gather-costs.csv", all);
  }
  printCrossings(all);
  return verified;
}

}  // namespace radiosity::bench
