#include "formfactor/light_on_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "formfactor/patch_seed.h"
#include "formfactor/rays/aimed_light.h"

namespace radiosity {

namespace {

constexpr std::uint64_t kSeedOfLights = 0x6c69676874;

}  // namespace

struct LightOnPatches::Rays {
  explicit Rays(const PatchMesh& mesh) : rays(mesh) {}
  PointRays rays;
};

LightOnPatches::LightOnPatches(const PatchMesh& mesh) : mesh_(mesh) {}
LightOnPatches::~LightOnPatches() = default;

const LightOnPatches::Rays& LightOnPatches::rays() {
  if (!rays_) rays_ = std::make_unique<Rays>(mesh_);
  return *rays_;
}

std::vector<double> LightOnPatches::fromAround(std::span<const Light> lights,
                                               std::span<const double> open, int bands) const {
  if (open.size() != mesh_.size()) {
    throw InputError(fmt::format("lights: {} shares of the sky where the mesh takes {}",
                                 open.size(), mesh_.size()));
  }
  const auto width = std::size_t(bands);
  std::vector<double> irradiance(mesh_.size() * width, 0.0);
  for (const Light& light : lights) {
    if (!light.isAllRound()) continue;
    for (std::size_t k = 0; k < irradiance.size(); ++k) {
      irradiance[k] += light.fromAround(k % width, std::max(0.0, open[k / width]));
    }
  }
  return irradiance;
}

LightFall LightOnPatches::aimed(std::span<const Light> lights, int bands, Progress& progress) {
  const auto width = std::size_t(bands);
  LightFall fall;
  fall.irradiance.assign(mesh_.size() * width, 0.0);
  if (aimedLights(lights).empty()) return fall;
  const AimedLight light(mesh_, rays().rays, lights);
  std::vector<double> squares(mesh_.size(), 0.0);
  std::vector<std::atomic<bool>> reaches(light.lights().size());
  progress.begin("light of lamps", mesh_.size(), "patches");
  parallelFor(mesh_.size(), 16, [&](std::size_t i) {
    progress.advance();
    if (progress.cancelled()) return;
    std::vector<AimedLight::Share> shares(light.lights().size());
    light.overPatch(i, patchSeed(mesh_, i, kSeedOfLights), shares);
    for (std::size_t b = 0; b < width; ++b) {
      for (std::size_t l = 0; l < shares.size(); ++l) {
        const double strength = light.lights()[l].strength[b];
        const double error = shares[l].error * strength;
        if (shares[l].value > 0) reaches[l].store(true, std::memory_order_relaxed);
        fall.irradiance[i * width + b] += shares[l].value * strength;
        squares[i] += error * error;
      }
    }
  });
  progress.check();
  progress.end();
  for (std::size_t l = 0; l < reaches.size(); ++l) {
    if (!reaches[l]) fall.lost.push_back(light.lights()[l].name);
  }
  double off = 0;
  double whole = 0;
  for (std::size_t k = 0; k < fall.irradiance.size(); ++k) {
    whole += mesh_.area[k / width] * fall.irradiance[k] * fall.irradiance[k];
  }
  for (std::size_t i = 0; i < mesh_.size(); ++i) off += mesh_.area[i] * squares[i];
  fall.error = whole > 0 ? std::sqrt(off / whole) : 0.0;
  return fall;
}

LightFall LightOnPatches::all(std::span<const Light> lights, std::span<const double> open,
                              int bands, Progress& progress) {
  LightFall fall = aimed(lights, bands, progress);
  const std::vector<double> around = fromAround(lights, open, bands);
  for (std::size_t k = 0; k < around.size(); ++k) fall.irradiance[k] += around[k];
  return fall;
}

std::vector<double> LightOnPatches::aimedAt(std::span<const Light> lights,
                                            std::span<const Place> places, int bands,
                                            Progress& progress) {
  const auto width = std::size_t(bands);
  std::vector<double> irradiance(places.size() * width, 0.0);
  if (aimedLights(lights).empty()) return irradiance;
  const AimedLight light(mesh_, rays().rays, lights);
  progress.begin("light of lamps", places.size(), "points");
  parallelFor(places.size(), 16, [&](std::size_t k) {
    progress.advance();
    if (progress.cancelled()) return;
    const Place& place = places[k];
    light.add({place.position, place.normal, {&place.own, std::size_t(place.own != kNone)}},
              std::span(irradiance).subspan(k * width, width));
  });
  progress.check();
  progress.end();
  return irradiance;
}

}  // namespace radiosity
