// Verifies, then times: hemicubes by our item buffer beside Embree tracing the same pixels.
//
// Both see the same planar polygons (Embree triangulated) from the same eyes, one core each, in
// turn, so that a busy machine slows both. Ours does the whole job: culling, drawing, depth test,
// patch look-up, weighting and sums by patch. Embree's traces and notes the polygon, no more.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cstdio>

#include "bench_scenes.h"
#include "embree_view.h"
#include "formfactor/row_builder.h"
#include "radiosity/form_factors.h"

namespace radiosity::bench {
namespace {

constexpr int kRounds = 15;
constexpr std::size_t kEyes = 24;

/// Seconds this thread has had the processor: on a machine that others use, too, waiting does not
/// count.
double seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// The median of several timings: another job's burst does not count.
double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

std::size_t pixelsOf(int resolution) {
  return 3 * std::size_t(resolution) * std::size_t(resolution);
}

FormFactorOptions optionsFor(int resolution) {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  return options;
}

/// Eyes spread evenly over the patches.
std::vector<std::size_t> chooseEyes(const PatchMesh& mesh, const RowBuilder& rows) {
  std::vector<std::size_t> eyes;
  for (std::size_t k = 0; k < kEyes; ++k) {
    const std::size_t patch = (2 * k + 1) * mesh.size() / (2 * kEyes);
    if (!rows.isEmpty(patch)) eyes.push_back(patch);
  }
  return eyes;
}

EyeFrame frameOf(const PatchMesh& mesh, const RowBuilder& rows, std::size_t patch) {
  return eyeFrame(mesh.centroid[patch] * rows.scene().scale, mesh.normal[patch],
                  turnAngle(mesh, patch, 1));
}

/// Share of pixels in which both see the same polygon.
double agreement(const PatchMesh& mesh, int resolution) {
  const RowBuilder rows(mesh, optionsFor(resolution));
  Hemicube hemicube = rows.makeHemicube();
  EmbreeView embree(rows.scene());
  std::vector<std::uint8_t> hidden;
  std::size_t same = 0;
  std::size_t all = 0;
  for (const std::size_t patch : chooseEyes(mesh, rows)) {
    rows.look(patch, hemicube, hidden);
    auto traced = embree.trace(frameOf(mesh, rows, patch), resolution).begin();
    for (int face = 0; face < kFaces; ++face) {
      for (const Index polygon : hemicube.picture(face)) same += polygon == *traced++;
    }
    all += pixelsOf(resolution);
  }
  return double(same) / double(all);
}

/// Seconds a hemicube, ours and Embree's.
struct Times {
  double ours;
  double embree;
};

Times timeHemicubes(const PatchMesh& mesh, int resolution) {
  const RowBuilder rows(mesh, optionsFor(resolution));
  Hemicube hemicube = rows.makeHemicube();
  EmbreeView embree(rows.scene());
  const std::vector<std::size_t> eyes = chooseEyes(mesh, rows);
  std::vector<std::uint8_t> hidden;
  std::vector<double> ours;
  std::vector<double> theirs;
  for (int round = 0; round < kRounds; ++round) {
    const double start = seconds();
    for (const std::size_t patch : eyes) rows.look(patch, hemicube, hidden);
    const double middle = seconds();
    for (const std::size_t patch : eyes) embree.trace(frameOf(mesh, rows, patch), resolution);
    ours.push_back((middle - start) / double(eyes.size()));
    theirs.push_back((seconds() - middle) / double(eyes.size()));
  }
  return {median(ours), median(theirs)};
}

/// Pixels of the finished picture a second, for drawing alone: clear, clip, scan conversion, depth
/// test and write of depth and polygon. Pixels drawn over count once. This is what Embree's rate is
/// to be set against: both then know the polygon in every pixel and no more.
double fillRate(const PatchMesh& mesh, int resolution) {
  const RowBuilder rows(mesh, optionsFor(resolution));
  Hemicube hemicube = rows.makeHemicube();
  std::vector<std::uint8_t> hidden;
  constexpr int kRepeats = 10;
  const std::vector<std::size_t> eyes = chooseEyes(mesh, rows);
  std::vector<double> times;
  for (int round = 0; round < kRounds; ++round) {
    double total = 0;
    for (const std::size_t patch : eyes) {
      rows.look(patch, hemicube, hidden);
      const double start = seconds();
      for (int k = 0; k < kRepeats; ++k) hemicube.redraw();
      total += seconds() - start;
    }
    times.push_back(total / double(kRepeats * eyes.size()));
  }
  return double(pixelsOf(resolution)) / median(times);
}

/// Rows a second of the whole computation on one thread: looked up, summed and stored in the
/// matrix, the set-up and the reciprocity residual included.
double rowRate(const PatchMesh& mesh, int resolution) {
  Progress silent;
  const double start = seconds();
  const FormFactors f = computeFormFactors(mesh, optionsFor(resolution), silent);
  return double(f.report.hemicubes) / (seconds() - start);
}

bool benchScene(const BenchScene& scene) {
  const RowBuilder rows(scene.mesh, optionsFor(64));
  fmt::print("\n{}: {} polygons ({} triangles for Embree), {} patches ({}), {}\n", scene.name,
             scene.mesh.polygons.size(), EmbreeView(rows.scene()).triangles(), scene.mesh.size(),
             scene.fine_mesh.size(), rows.kernels().target);
  const double same = agreement(scene.mesh, 256);
  fmt::print("  verified: the same polygon in {:.4f}% of pixels\n", 100 * same);
  if (same < 0.999) {
    fmt::print("  NOT VERIFIED: nothing is timed\n");
    return false;
  }
  fmt::print("  {:>6} | {:>13} {:>13} {:>6} | {:>11} {:>9} {:>6} {:>10} | {:>8}\n", "pixels",
             "draw Mpixel/s", "Embree Mray/s", "ratio", "us/hemicube", "Mpixel/s", "ratio",
             "4x patches", "rows/s");
  for (const int resolution : {64, 128, 256, 512}) {
    const Times coarse = timeHemicubes(scene.mesh, resolution);
    const Times fine = timeHemicubes(scene.fine_mesh, resolution);
    const double pixels = double(pixelsOf(resolution));
    const double fill = fillRate(scene.mesh, resolution);
    const double traced = pixels / coarse.embree;
    fmt::print(
        "  {:>6} | {:>13.0f} {:>13.1f} {:>5.1f}x | {:>11.1f} {:>9.0f} {:>5.1f}x {:>9.2f}x | "
        "{:>8.0f}\n",
        resolution, 1e-6 * fill, 1e-6 * traced, fill / traced, 1e6 * coarse.ours,
        1e-6 * pixels / coarse.ours, coarse.embree / coarse.ours, fine.ours / coarse.ours,
        rowRate(scene.mesh, resolution));
  }
  return true;
}

}  // namespace
}  // namespace radiosity::bench

int main() {
  fmt::print(
      "Left: the polygon in every pixel, drawn and traced. Middle: whole hemicubes, patches "
      "looked\n"
      "up and summed, beside Embree that stops at the polygon; and the same with 4 times as many\n"
      "patches. Right: rows of the matrix. One thread; processor time, medians of one run.\n");
  using namespace radiosity::bench;
  radiosity::setThreads(1);
  bool verified = true;
  for (const BenchScene& scene : benchScenes()) verified = benchScene(scene) && verified;
  return verified ? 0 : 1;
}
