#include "formfactor/cut/trial_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "base/hash.h"
#include "base/parallel.h"
#include "formfactor/rays/patch_points.h"
#include "formfactor/rays/ray_model.h"

namespace radiosity {
namespace {

constexpr std::size_t kMostRows = 512;
/// Of so many lights the kTrials are tried that reach most of the area: one between two faces that
/// nearly touch says nothing of the rest.
constexpr std::size_t kCandidates = 16;
/// A shadow ray that comes this near to its lamp has reached it.
constexpr float kReached = 1 - 1e-4F;

/// Rays of a patch to what emits, or to the sky, and what is taken to be reflected of what they
/// bring.
constexpr std::size_t kRaysToEmitters = 16;
constexpr std::size_t kRaysToSky = 16;
constexpr double kReflected = 0.5;
/// Patches that are lit at once.
constexpr std::size_t kAtOnce = 4 * kRayLanes;

/// A number from 0 to 1.
double uniform(std::uint64_t seed, std::uint64_t number) {
  return double(mixed(mixed(seed) ^ number) >> 11U) * 0x1p-53;
}

/// A sun, a lamp in mid-air, or an even sky.
struct Trial {
  enum class Kind { sun, lamp, sky };
  Kind kind = Kind::sky;
  glm::vec3 at{0};  ///< the direction to the sun, or the place of the lamp
  float size = 0;   ///< of a lamp: within this distance it is hardly brighter
};

glm::vec3 placeOf(const PatchTree::Patch& patch) { return {patch.at[0], patch.at[1], patch.at[2]}; }

glm::vec3 normalOf(const PatchTree::Patch& patch) {
  return {patch.at[3], patch.at[4], patch.at[5]};
}

/// The lengths of some rays, infinite where they meet nothing.
void traceLengths(const EmbreeScene& embree, std::span<const glm::vec3> from,
                  std::span<const glm::vec3> along, std::span<float> lengths) {
  RTCRayHit16 packet;
  for (std::size_t begin = 0; begin < from.size(); begin += kRayLanes) {
    const int lanes = int(std::min<std::size_t>(kRayLanes, from.size() - begin));
    initPacket(packet);
    for (int k = 0; k < lanes; ++k) {
      setRay(packet, k, from[begin + std::size_t(k)], along[begin + std::size_t(k)]);
    }
    embree.trace(packet, lanes, Coherence::incoherent);
    for (int k = 0; k < lanes; ++k) lengths[begin + std::size_t(k)] = packet.ray.tfar[k];
  }
}

/// A cosine-distributed direction (Malley's method); x and y in [0, 1).
glm::vec3 directionFrom(const PatchTree::Patch& patch, double x, double y) {
  const glm::vec3 z = normalOf(patch);
  const glm::vec3 aside = std::abs(z.x) < 0.5F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 across = glm::normalize(glm::cross(aside, z));
  const auto radius = float(std::sqrt(x));
  const auto turn = float(2 * std::numbers::pi * y);
  return radius * std::cos(turn) * across + radius * std::sin(turn) * glm::cross(z, across) +
         std::sqrt(std::max(0.0F, 1 - radius * radius)) * z;
}

/// A lamp half-way along a ray that leaves some patch, or a sun where that meets nothing.
Trial makeTrial(const RayScene& scene, const PatchTree& tree, std::uint64_t seed) {
  const auto patches = tree.patches();
  const auto chosen = std::size_t(uniform(seed, 0) * double(patches.size()));
  const PatchTree::Patch& patch = patches[std::min(chosen, patches.size() - 1)];
  const glm::vec3 along = directionFrom(patch, uniform(seed, 1), uniform(seed, 2));
  const glm::vec3 from = placeOf(patch) + kRayLift * normalOf(patch);
  float length = 0;
  traceLengths(scene.caster().embree(), {&from, 1}, {&along, 1}, {&length, 1});
  if (std::isinf(length)) return {Trial::Kind::sun, along, 0};
  return {Trial::Kind::lamp, from + 0.5F * length * along, 0.5F * length};
}

/// The share of the view of some patches that meets nothing.
void shineFromSky(const RayScene& scene, std::span<const PatchTree::Patch> patches,
                  std::uint64_t seed, std::span<double> light) {
  std::vector<glm::vec3> from(patches.size());
  std::vector<glm::vec3> along(patches.size());
  std::vector<float> lengths(patches.size());
  std::ranges::fill(light, 0.0);
  for (std::size_t ray = 0; ray < kRaysToSky; ++ray) {
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const std::uint64_t number = std::uint64_t(patches[k].patch) * 2 * kRaysToSky + 2 * ray;
      const double x = (double(ray) + uniform(seed, number)) / double(kRaysToSky);
      from[k] = placeOf(patches[k]) + kRayLift * normalOf(patches[k]);
      along[k] = directionFrom(patches[k], x, uniform(seed, number + 1));
    }
    traceLengths(scene.caster().embree(), from, along, lengths);
    for (std::size_t k = 0; k < patches.size(); ++k) {
      light[k] += std::isinf(lengths[k]) ? 1.0 / double(kRaysToSky) : 0.0;
    }
  }
}

/// What a sun or a lamp gives to some patches, with its shadows.
void shine(const RayScene& scene, std::span<const PatchTree::Patch> patches, const Trial& trial,
           std::span<double> light) {
  const bool is_sun = trial.kind == Trial::Kind::sun;
  std::vector<glm::vec3> from(patches.size());
  std::vector<glm::vec3> along(patches.size());
  std::vector<float> distance(patches.size());
  std::vector<float> lengths(patches.size());
  for (std::size_t k = 0; k < patches.size(); ++k) {
    from[k] = placeOf(patches[k]) + kRayLift * normalOf(patches[k]);
    const glm::vec3 to = is_sun ? trial.at : trial.at - from[k];
    distance[k] = glm::length(to);
    along[k] = distance[k] > 0 ? to / distance[k] : normalOf(patches[k]);
  }
  traceLengths(scene.caster().embree(), from, along, lengths);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const float reach = is_sun ? std::numeric_limits<float>::infinity() : kReached * distance[k];
    const float cosine = glm::dot(along[k], normalOf(patches[k]));
    light[k] = 0;
    if (cosine <= 0 || lengths[k] < reach) continue;
    const double square = double(trial.size) * trial.size;
    const double spread = is_sun ? 1.0 : square / (square + double(distance[k]) * distance[k]);
    light[k] = cosine * spread;
  }
}

std::array<Trial, kTrials> chooseTrials(const RayScene& scene, const PatchTree& tree, bool with_sky,
                                        std::uint64_t seed) {
  std::vector<PatchTree::Patch> some;
  for (const std::size_t place : someOf(tree)) some.push_back(tree.patches()[place]);
  std::vector<double> light(some.size());
  std::vector<std::pair<double, Trial>> candidates;
  for (std::size_t c = 0; c < kCandidates; ++c) {
    const Trial trial = makeTrial(scene, tree, mixed(seed + c));
    shine(scene, some, trial, light);
    double lit = 0;
    for (std::size_t k = 0; k < some.size(); ++k) lit += light[k] > 0 ? some[k].area : 0.0;
    candidates.emplace_back(lit, trial);
  }
  std::ranges::stable_sort(candidates, std::ranges::greater(), &std::pair<double, Trial>::first);
  std::array<Trial, kTrials> trials;
  for (std::size_t t = 0; t < trials.size(); ++t) trials[t] = candidates[t].second;
  const bool is_open = std::ranges::any_of(
      candidates, [](const auto& one) { return one.second.kind == Trial::Kind::sun; });
  if (with_sky && is_open) trials.back() = {};
  return trials;
}

/// Calls part(some) for all patches of a tree, some at a time, on all threads.
template <class Part>
void forParts(const PatchTree& tree, Progress& progress, const Part& part) {
  const auto patches = tree.patches();
  parallelFor(patches.size() / kAtOnce + 1, 1, [&](std::size_t p) {
    if (progress.cancelled()) return;
    const std::size_t begin = std::min(p * kAtOnce, patches.size());
    const FlushDenormals flush;
    part(patches.subspan(begin, std::min(kAtOnce, patches.size() - begin)));
  });
  progress.check();
}

TrialLights lightOf(std::span<const Trial> trials, const RayScene& scene, const PatchTree& tree,
                    bool of_all, std::uint64_t seed, Progress& progress) {
  TrialLights light;
  light.direct.assign(scene.size() * kTrials, 0.0);
  light.radiosity = light.direct;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const bool is_sky = trials[t].kind == Trial::Kind::sky;
    light.sky[t] = is_sky ? 1.0 : 0.0;
    forParts(tree, progress, [&](std::span<const PatchTree::Patch> some) {
      std::array<double, kAtOnce> all{};
      const std::span<double> of = std::span(all).first(some.size());
      is_sky ? shineFromSky(scene, some, seed, of) : shine(scene, some, trials[t], of);
      for (std::size_t k = 0; k < some.size(); ++k) {
        light.radiosity[some[k].patch * kTrials + t] = kReflected * of[k];
        if (of_all && !is_sky) light.direct[some[k].patch * kTrials + t] = of[k];
      }
    });
  }
  return light;
}

/// Places of all that emits, alike by area.
class EmitterPlaces {
 public:
  EmitterPlaces(const PatchMesh& mesh, std::span<const Index> emitters) : mesh_(mesh) {
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (!(mesh.area[i] > 0) || !std::ranges::binary_search(emitters, i)) continue;
      patch_.push_back(Index(i));
      area_.emplace_back(mesh, i);
      end_.push_back((end_.empty() ? 0.0 : end_.back()) + mesh.area[i]);
    }
  }
  bool empty() const { return patch_.empty(); }
  double area() const { return end_.back(); }
  /// A place, and the normal there.
  std::pair<Vec3, Vec3> at(double x, double y) const {
    x *= end_.back();
    const auto found = std::size_t(std::ranges::upper_bound(end_, x) - end_.begin());
    const std::size_t k = std::min(found, end_.size() - 1);
    const double begin = k == 0 ? 0.0 : end_[k - 1];
    const double within = std::clamp((x - begin) / (end_[k] - begin), 0.0, 1.0);
    return {area_[k].at(within, y), mesh_.normal[patch_[k]]};
  }

 private:
  const PatchMesh& mesh_;
  std::vector<Index> patch_;
  std::vector<PatchArea> area_;
  std::vector<double> end_;
};

/// What shines on some patches from emitters of exitance 1.
void shineFrom(const EmitterPlaces& emitters, const RayScene& scene,
               std::span<const PatchTree::Patch> patches, std::uint64_t seed,
               std::span<double> light) {
  const auto scale = float(scene.caster().scale());
  const double area = emitters.area() * double(scale) * double(scale);
  std::vector<glm::vec3> from(patches.size());
  std::vector<glm::vec3> along(patches.size());
  std::vector<double> share(patches.size());
  std::vector<float> distance(patches.size());
  std::vector<float> lengths(patches.size());
  std::ranges::fill(light, 0.0);
  for (std::size_t ray = 0; ray < kRaysToEmitters; ++ray) {
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const std::uint64_t number = std::uint64_t(patches[k].patch) * 2 * kRaysToEmitters + 2 * ray;
      const double x = (double(ray) + uniform(seed, number)) / double(kRaysToEmitters);
      const auto [end, facing] = emitters.at(x, uniform(seed, number + 1));
      const glm::vec3 normal = normalOf(patches[k]);
      from[k] = placeOf(patches[k]) + kRayLift * normal;
      const glm::vec3 way = scene.caster().place(end) - from[k];
      distance[k] = glm::length(way);
      along[k] = distance[k] > 0 ? way / distance[k] : normal;
      const double cosines = std::max(0.0, double(glm::dot(along[k], normal))) *
                             std::max(0.0, -glm::dot(Vec3(along[k]), facing));
      const double square = double(distance[k]) * double(distance[k]);
      // Near points of a small patch would count for more than its whole view.
      share[k] = cosines * area / (std::numbers::pi * square + area);
    }
    traceLengths(scene.caster().embree(), from, along, lengths);
    for (std::size_t k = 0; k < patches.size(); ++k) {
      if (lengths[k] < kReached * distance[k]) continue;
      light[k] += share[k] / double(kRaysToEmitters);
    }
  }
}

/// Nothing if they shine on nothing.
TrialLights ownLight(const PatchMesh& mesh, const RayScene& scene, const PatchTree& tree,
                     std::span<const Index> emitters, std::uint64_t seed, Progress& progress) {
  const EmitterPlaces places(mesh, emitters);
  if (places.empty()) return {};
  TrialLights light;
  light.direct.assign(scene.size() * kTrials, 0.0);
  forParts(tree, progress, [&](std::span<const PatchTree::Patch> some) {
    std::array<double, kAtOnce> of{};
    shineFrom(places, scene, some, seed, std::span(of).first(some.size()));
    for (std::size_t k = 0; k < some.size(); ++k) light.direct[some[k].patch * kTrials] = of[k];
  });
  if (std::ranges::all_of(light.direct, [](double h) { return h == 0; })) return {};
  light.radiosity = light.direct;
  for (double& b : light.radiosity) b *= kReflected;
  return light;
}

}  // namespace

std::vector<std::size_t> someOf(const PatchTree& tree) {
  const std::size_t n = tree.patches().size();
  std::vector<std::size_t> places(std::min(n, kMostRows));
  for (std::size_t k = 0; k < places.size(); ++k) {
    places[k] = (2 * k + 1) * n / (2 * places.size());
  }
  return places;
}

TrialLights trialLights(const PatchMesh& mesh, const RayScene& scene, const PatchTree& tree,
                        std::span<const Index> emitters, bool sources, std::uint64_t seed,
                        Progress& progress) {
  TrialLights light = ownLight(mesh, scene, tree, emitters, seed, progress);
  if (!light.radiosity.empty()) return light;
  return lightOf(chooseTrials(scene, tree, sources, seed), scene, tree, sources, seed, progress);
}

}  // namespace radiosity
