#include "formfactor/light_on_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "formfactor/patch_seed.h"
#include "formfactor/rays/aimed_light.h"
#include "formfactor/rays/sky_light.h"

namespace radiosity {

namespace {

constexpr std::uint64_t kSeedOfLights = 0x6c69676874;
constexpr std::uint64_t kSeedOfSky = 0x736b79;

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

/// Means over patches.
struct LightOnPatches::Means {
  Means(const PatchMesh& mesh, int bands)
      : irradiance(mesh.size() * std::size_t(bands), 0.0), squares(mesh.size(), 0.0) {}
  std::vector<double> irradiance;
  std::vector<double> squares;  ///< of the standard error, summed over the bands
  std::vector<std::string> lost;
};

LightFall LightOnPatches::fallOf(Means means) const {
  const std::size_t width = mesh_.size() == 0 ? 1 : means.irradiance.size() / mesh_.size();
  double off = 0;
  double whole = 0;
  for (std::size_t k = 0; k < means.irradiance.size(); ++k) {
    whole += mesh_.area[k / width] * means.irradiance[k] * means.irradiance[k];
  }
  for (std::size_t i = 0; i < mesh_.size(); ++i) off += mesh_.area[i] * means.squares[i];
  return {std::move(means.irradiance), whole > 0 ? std::sqrt(off / whole) : 0.0,
          std::move(means.lost)};
}

LightOnPatches::Means LightOnPatches::meansFromAround(std::span<const Light> lights,
                                                      std::span<const double> open, int bands,
                                                      Progress& progress) {
  if (open.size() != mesh_.size()) {
    throw InputError(fmt::format("lights: {} shares of the sky where the mesh takes {}",
                                 open.size(), mesh_.size()));
  }
  const auto width = std::size_t(bands);
  const auto openOf = [&](std::size_t patch) { return std::max(0.0, open[patch]); };
  Means means(mesh_, bands);
  for (const Light& light : lights) {
    if (!light.isUniform()) continue;
    for (std::size_t k = 0; k < means.irradiance.size(); ++k) {
      means.irradiance[k] += light.fromAround(k % width, openOf(k / width));
    }
  }
  if (unevenSkies(lights).empty()) return means;
  const SkyLight sky(mesh_, rays().rays, lights, bands);
  progress.begin("light of the sky", mesh_.size(), "patches");
  parallelFor(mesh_.size(), 16, [&](std::size_t i) {
    progress.advance();
    if (progress.cancelled()) return;
    means.squares[i] = sky.overPatch(i, openOf(i), patchSeed(mesh_, i, kSeedOfSky),
                                     std::span(means.irradiance).subspan(i * width, width));
  });
  progress.check();
  progress.end();
  return means;
}

LightOnPatches::Means LightOnPatches::meansOfAimed(std::span<const Light> lights, int bands,
                                                   Progress& progress) {
  const auto width = std::size_t(bands);
  Means means(mesh_, bands);
  if (aimedLights(lights).empty()) return means;
  const AimedLight light(mesh_, rays().rays, lights);
  const SharpShadows sharp(mesh_, rays().rays);
  std::vector<std::atomic<bool>> reaches(light.lights().size());
  progress.begin("light of lamps", mesh_.size(), "patches");
  parallelFor(mesh_.size(), 16, [&](std::size_t i) {
    progress.advance();
    if (progress.cancelled()) return;
    std::vector<AimedLight::Share> shares(light.lights().size());
    light.overPatch(i, sharp, patchSeed(mesh_, i, kSeedOfLights), shares);
    for (std::size_t b = 0; b < width; ++b) {
      for (std::size_t l = 0; l < shares.size(); ++l) {
        const double strength = light.lights()[l].strength[b];
        const double error = shares[l].error * strength;
        if (shares[l].value > 0) reaches[l].store(true, std::memory_order_relaxed);
        means.irradiance[i * width + b] += shares[l].value * strength;
        means.squares[i] += error * error;
      }
    }
  });
  progress.check();
  progress.end();
  for (std::size_t l = 0; l < reaches.size(); ++l) {
    const Light& of = light.lights()[l];
    if (!reaches[l] && !of.isAllRound()) means.lost.push_back(of.name);
  }
  return means;
}

LightFall LightOnPatches::aimed(std::span<const Light> lights, int bands, Progress& progress) {
  return fallOf(meansOfAimed(lights, bands, progress));
}

LightFall LightOnPatches::all(std::span<const Light> lights, std::span<const double> open,
                              int bands, Progress& progress) {
  Means means = meansOfAimed(lights, bands, progress);
  const Means around = meansFromAround(lights, open, bands, progress);
  for (std::size_t k = 0; k < around.irradiance.size(); ++k) {
    means.irradiance[k] += around.irradiance[k];
  }
  for (std::size_t i = 0; i < mesh_.size(); ++i) means.squares[i] += around.squares[i];
  return fallOf(std::move(means));
}

std::vector<double> LightOnPatches::aimedAt(std::span<const Light> lights,
                                            std::span<const Place> places, int bands,
                                            Progress& progress) {
  const auto width = std::size_t(bands);
  std::vector<double> irradiance(places.size() * width, 0.0);
  const bool any_sky = !unevenSkies(lights).empty();
  if (aimedLights(lights).empty() && !any_sky) return irradiance;
  const AimedLight light(mesh_, rays().rays, lights);
  const SkyLight sky(mesh_, rays().rays, lights, bands);
  progress.begin("light of lamps", places.size(), "points");
  parallelFor(places.size(), 16, [&](std::size_t k) {
    progress.advance();
    if (progress.cancelled()) return;
    const Place& place = places[k];
    const RaySource from{
        place.position, place.normal, {&place.own, std::size_t(place.own != kNone)}};
    const std::span<double> here = std::span(irradiance).subspan(k * width, width);
    light.add(from, here);
    if (any_sky) sky.add(from, here);
  });
  progress.check();
  progress.end();
  return irradiance;
}

}  // namespace radiosity
