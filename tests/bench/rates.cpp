// Verifies, then times: hemicubes by our item buffer beside Embree tracing the same pixels.
//
// Both see the same planar polygons (Embree triangulated) from the same eyes, one core each, in
// turn, so that a busy machine slows both. Ours does the whole job: culling, drawing, depth test,
// patch look-up, weighting and sums by patch. Embree's traces and notes the polygon, no more.
#include "rates.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "bench_eyes.h"
#include "bench_scenes.h"
#include "clocks.h"
#include "embree_view.h"
#include "formfactor/hemicube/row_builder.h"
#include "radiosity/form_factors.h"

namespace radiosity::bench {
namespace {

constexpr int kRounds = 15;

/// Share of pixels in which both see the same polygon.
double agreement(const PatchMesh& mesh, int resolution) {
  const RowBuilder rows(mesh, optionsFor(resolution));
  Hemicube hemicube = rows.makeHemicube();
  EmbreeView embree(rows.scene(), mesh);
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

/// The patches of `fine` nearest to those of `coarse`, on planes that face alike: two meshes of one
/// scene are compared from the same places.
std::vector<std::size_t> nearestPatches(const PatchMesh& coarse,
                                        const std::vector<std::size_t>& patches,
                                        const PatchMesh& fine) {
  std::vector<std::size_t> nearest;
  for (const std::size_t patch : patches) {
    const auto distance = [&](std::size_t i) {
      const bool alike = fine.surface[i] == coarse.surface[patch] &&
                         glm::dot(fine.normal[i], coarse.normal[patch]) > 0.999;
      return alike ? glm::distance(fine.centroid[i], coarse.centroid[patch]) : HUGE_VAL;
    };
    std::size_t best = 0;
    for (std::size_t i = 1; i < fine.size(); ++i) {
      if (distance(i) < distance(best)) best = i;
    }
    nearest.push_back(best);
  }
  return nearest;
}

/// Seconds a hemicube: ours, ours with a finer mesh, Embree's.
struct Times {
  double ours;
  double fine;
  double embree;
};

/// In turn, so that a busy machine slows all alike.
Times timeHemicubes(const RateScene& scene, int resolution) {
  const RowBuilder rows(scene.mesh, optionsFor(resolution));
  const RowBuilder fine_rows(scene.fine_mesh, optionsFor(resolution));
  Hemicube hemicube = rows.makeHemicube();
  Hemicube fine_hemicube = fine_rows.makeHemicube();
  EmbreeView embree(rows.scene(), scene.mesh);
  const std::vector<std::size_t> eyes = chooseEyes(scene.mesh, rows);
  const std::vector<std::size_t> fine_eyes = nearestPatches(scene.mesh, eyes, scene.fine_mesh);
  std::vector<std::uint8_t> hidden;
  std::array<std::vector<double>, 3> times;
  for (int round = 0; round < kRounds; ++round) {
    double start = threadSeconds();
    const auto note = [&](std::vector<double>& list) {
      const double now = threadSeconds();
      list.push_back((now - start) / double(eyes.size()));
      start = now;
    };
    for (const std::size_t patch : eyes) rows.look(patch, hemicube, hidden);
    note(times[0]);
    for (const std::size_t patch : fine_eyes) fine_rows.look(patch, fine_hemicube, hidden);
    note(times[1]);
    for (const std::size_t patch : eyes) embree.trace(frameOf(scene.mesh, rows, patch), resolution);
    note(times[2]);
  }
  return {least(times[0]), least(times[1]), least(times[2])};
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
      const double start = threadSeconds();
      for (int k = 0; k < kRepeats; ++k) hemicube.redraw();
      total += threadSeconds() - start;
    }
    times.push_back(total / double(kRepeats * eyes.size()));
  }
  return double(pixelsOf(resolution)) / least(times);
}

/// Rows a second of the whole computation on one thread: looked up, summed and stored in the
/// matrix, the set-up and the reciprocity residual included.
double rowRate(const PatchMesh& mesh, int resolution) {
  Progress silent;
  const double start = threadSeconds();
  const FormFactors f = computeFormFactors(mesh, optionsFor(resolution), silent);
  return double(f.report.hemicube.hemicubes) / (threadSeconds() - start);
}

bool benchRate(const RateScene& scene) {
  const RowBuilder rows(scene.mesh, optionsFor(64));
  fmt::print("\n{}: {} polygons ({} triangles for Embree), {} patches ({}), {}\n", scene.name,
             scene.mesh.polygons.size(), EmbreeView(rows.scene(), scene.mesh).triangles(),
             scene.mesh.size(), scene.fine_mesh.size(), rows.kernels().target);
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
    const Times times = timeHemicubes(scene, resolution);
    const double pixels = double(pixelsOf(resolution));
    const double fill = fillRate(scene.mesh, resolution);
    const double traced = pixels / times.embree;
    fmt::print(
        "  {:>6} | {:>13.0f} {:>13.1f} {:>5.1f}x | {:>11.1f} {:>9.0f} {:>5.1f}x {:>9.2f}x | "
        "{:>8.0f}\n",
        resolution, 1e-6 * fill, 1e-6 * traced, fill / traced, 1e6 * times.ours,
        1e-6 * pixels / times.ours, times.embree / times.ours, times.fine / times.ours,
        rowRate(scene.mesh, resolution));
  }
  return true;
}

}  // namespace

bool benchRates() {
  fmt::print(
      "Left: the polygon in every pixel, drawn and traced. Middle: whole hemicubes, patches "
      "looked\n"
      "up and summed, beside Embree that stops at the polygon; and the same with 4 times as many\n"
      "patches. Right: rows of the matrix. One thread; processor time, the least of 15 rounds of "
      "one run.\n");
  setThreads(1);
  bool verified = true;
  for (const RateScene& scene : rateScenes()) verified = benchRate(scene) && verified;
  return verified;
}

}  // namespace radiosity::bench
