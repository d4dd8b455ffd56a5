// Verifies, then times: hemicubes by the processor, by OpenGL and by Embree, from the same eyes.
//
// The first two do the whole job, rows of the matrix included; OpenGL's are read back. Embree
// traces and notes the polygon, no more. By the clock; the processor's eye and Embree on all
// threads.
#include "eye_rates.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstdio>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "bench_eyes.h"
#include "bench_scenes.h"
#include "embree_view.h"
#include "formfactor/hemicube/gpu_rows.h"

namespace radiosity::bench {
namespace {

constexpr int kRounds = 3;
constexpr double kRoundSeconds = 0.3;

/// Of eyes a second; look(k) looks from eyes 0 to k - 1, over and over.
template <class Look>
double rateOf(const Look& look) {
  std::size_t eyes = kEyes;
  double best = 0;
  look(eyes);
  for (int round = 0; round < kRounds;) {
    const double start = clockSeconds();
    look(eyes);
    const double seconds = clockSeconds() - start;
    if (seconds < kRoundSeconds && eyes < 4096 * kEyes) {
      eyes *= 2;
      continue;
    }
    best = std::max(best, double(eyes) / seconds);
    ++round;
  }
  return best;
}

class Eyes {
 public:
  Eyes(const PatchMesh& mesh, int resolution)
      : mesh_(mesh),
        resolution_(resolution),
        rows_(mesh, optionsFor(resolution)),
        gpu_(openGpuEye(EyeChoice::gl, rows_.scene(), mesh, rows_.weights())) {
    for (const std::size_t patch : chooseEyes(mesh, rows_)) patches_.push_back(Index(patch));
  }

  /// Shares of pixels in which OpenGL and Embree see the processor's polygon.
  std::pair<double, double> agreement() {
    Hemicube hemicube = rows_.makeHemicube();
    EmbreeView embree(rows_.scene(), mesh_);
    std::vector<std::uint8_t> hidden;
    std::size_t by_gpu = 0;
    std::size_t by_embree = 0;
    std::size_t all = 0;
    for (const Index patch : patches_) {
      const PlacedEye eye = rows_.eyeOf(patch, hidden);
      hemicube.look(eye.frame, eye.own, hidden.data());
      const auto describe = [&](std::size_t, GpuView& view, std::span<std::uint32_t> words) {
        describeEye(eye, hidden, view, words);
      };
      const std::vector<Index> drawn = gpu_->pictures(describe);
      const std::vector<std::uint32_t>& traced = embree.trace(eye.frame, resolution_);
      std::size_t at = 0;
      for (int face = 0; face < kFaces; ++face) {
        for (const Index polygon : hemicube.picture(face)) {
          by_gpu += drawn[at] == polygon;
          by_embree += traced[at++] == polygon;
        }
      }
      all += at;
    }
    return {double(by_gpu) / double(all), double(by_embree) / double(all)};
  }

  double cpuRate() const {
    struct Worker {
      Hemicube hemicube;
      std::vector<std::uint8_t> hidden;
      PackedRow row;
    };
    tbb::enumerable_thread_specific<Worker> workers([&] {
      return Worker{rows_.makeHemicube(), {}, {}};
    });
    return rateOf([&](std::size_t count) {
      parallelFor(count, 1, [&](std::size_t k) {
        Worker& worker = workers.local();
        const Index patch = patches_[k % patches_.size()];
        worker.row.pack(rows_.look(patch, worker.hemicube, worker.hidden), mesh_.size());
      });
    });
  }

  double gpuRate() const {
    tbb::enumerable_thread_specific<PackedRow> packed;
    Progress silent;
    return rateOf([&](std::size_t count) {
      std::vector<Index> from(count);
      for (std::size_t k = 0; k < count; ++k) from[k] = patches_[k % patches_.size()];
      lookFromPatches(
          *gpu_, rows_, from,
          [&](std::size_t, const HemicubeView& view, const HemicubeReport&) {
            packed.local().pack(view, mesh_.size());
          },
          silent);
    });
  }

  double embreeRate() const {
    tbb::enumerable_thread_specific<std::unique_ptr<EmbreeView>> views(
        [&] { return std::make_unique<EmbreeView>(rows_.scene(), mesh_); });
    return rateOf([&](std::size_t count) {
      parallelFor(count, 1, [&](std::size_t k) {
        views.local()->trace(frameOf(mesh_, rows_, patches_[k % patches_.size()]), resolution_);
      });
    });
  }

  const EyeDevice& device() const { return gpu_->device(); }

 private:
  const PatchMesh& mesh_;
  int resolution_;
  RowBuilder rows_;
  std::unique_ptr<GpuEye> gpu_;
  std::vector<Index> patches_;
};

bool benchScene(const RateScene& scene) {
  const auto [by_gpu, by_embree] = Eyes(scene.mesh, 256).agreement();
  if (std::min(by_gpu, by_embree) < 0.999) {
    fmt::print(
        "  {}: NOT VERIFIED: OpenGL sees the same polygon in {:.4f}% of pixels, Embree in "
        "{:.4f}%; nothing is timed\n",
        scene.name, 100 * by_gpu, 100 * by_embree);
    return false;
  }
  for (const int resolution : {64, 128, 256, 512}) {
    const Eyes eyes(scene.mesh, resolution);
    const double cpu = eyes.cpuRate();
    const double gpu = eyes.gpuRate();
    fmt::print("  {:<20} {:>8} {:>6} | {:>10.0f} {:>10.0f} {:>10.0f} | {:>8.2f}x | {:>8.4f}%\n",
               scene.name, scene.mesh.polygons.size(), resolution, cpu, gpu, eyes.embreeRate(),
               gpu / cpu, 100 * by_gpu);
    std::fflush(stdout);
  }
  return true;
}

}  // namespace

bool benchEyes() {
  const EyeDevices found = eyeDevices();
  if (found.devices.empty()) {
    fmt::print("\nHemicubes by OpenGL: NOT TIMED: {}\n", found.problem);
    return false;
  }
  const EyeDevice& device = found.devices.front();
  setThreads(0);
  fmt::print(
      "\nHemicubes a second, by the clock: the processor's eye on {} threads, OpenGL, rows read "
      "back, and\n"
      "Embree on as many threads, which stops at the polygon. OpenGL by {}, {}.\n",
      allowedThreads(), device.name, device.hardware ? "hardware" : "in software");
  fmt::print("  {:<20} {:>8} {:>6} | {:>10} {:>10} {:>10} | {:>9} | {:>9}\n", "scene", "polygons",
             "pixels", "processor", "OpenGL", "Embree", "GL / proc", "same");
  bool verified = true;
  for (const RateScene& scene : rateScenes()) verified = benchScene(scene) && verified;
  return verified;
}

}  // namespace radiosity::bench
