#include "formfactor/cut/cut_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/cut/row_cutter.h"
#include "formfactor/rays/ray_model.h"
#include "formfactor/rays/ray_rounds.h"

namespace radiosity {
namespace {

constexpr int kTrials = 4;
/// Of so many lights the kTrials are tried that reach most of the area: one between two faces that
/// nearly touch says nothing of the rest.
constexpr std::size_t kCandidates = 16;
constexpr std::size_t kMostRows = 512;
constexpr std::uint32_t kFirstRays = 128;
/// A step gives rows at most this many times the rays that they have.
constexpr double kMostGrowth = 16;
/// Shares of the tolerance for rays and for cutting: together they are 1.
constexpr double kNoiseShare = 0.8;
constexpr double kBiasShare = 0.6;
constexpr std::array<double, 7> kOpenings{1, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125};
/// A shadow ray that comes this near to its lamp has reached it.
constexpr float kReached = 1 - 1e-4F;

/// A number from 0 to 1.
double uniform(std::uint64_t seed, std::uint64_t number) {
  return double(mixed(mixed(seed) ^ number) >> 11U) * 0x1p-53;
}

/// A sun, or a lamp in mid-air.
struct Trial {
  bool is_sun = false;
  glm::vec3 at{0};  ///< the direction to the sun, or the place of the lamp
  float size = 0;   ///< of a lamp: within this distance it is hardly brighter
};

glm::vec3 placeOf(const PatchTree::Patch& patch) { return {patch.at[0], patch.at[1], patch.at[2]}; }

/// Of a bent cluster the mean is shorter.
glm::vec3 normalOf(const PatchTree::Patch& patch) {
  const glm::vec3 mean(patch.at[3], patch.at[4], patch.at[5]);
  const float length = glm::length(mean);
  return length > 0 ? mean / length : glm::vec3(0, 0, 1);
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

/// A lamp half-way along a ray that leaves some patch, or a sun where that meets nothing.
Trial makeTrial(const RayScene& scene, const PatchTree& tree, std::uint64_t seed) {
  const auto patches = tree.patches();
  const auto chosen = std::size_t(uniform(seed, 0) * double(patches.size()));
  const PatchTree::Patch& patch = patches[std::min(chosen, patches.size() - 1)];
  const glm::vec3 z = normalOf(patch);
  const glm::vec3 aside = std::abs(z.x) < 0.5F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 x = glm::normalize(glm::cross(aside, z));
  const auto radius = float(std::sqrt(uniform(seed, 1)));
  const auto turn = float(2 * std::numbers::pi * uniform(seed, 2));
  const glm::vec3 along = radius * std::cos(turn) * x + radius * std::sin(turn) * glm::cross(z, x) +
                          std::sqrt(std::max(0.0F, 1 - radius * radius)) * z;
  const glm::vec3 from = placeOf(patch) + kRayLift * z;
  float length = 0;
  traceLengths(scene.caster().embree(), {&from, 1}, {&along, 1}, {&length, 1});
  if (std::isinf(length)) return {true, along, 0};
  return {false, from + 0.5F * length * along, 0.5F * length};
}

/// What a trial gives to some patches, with its shadows.
void shine(const RayScene& scene, std::span<const PatchTree::Patch> patches, const Trial& trial,
           std::span<double> light) {
  std::vector<glm::vec3> from(patches.size());
  std::vector<glm::vec3> along(patches.size());
  std::vector<float> distance(patches.size());
  std::vector<float> lengths(patches.size());
  for (std::size_t k = 0; k < patches.size(); ++k) {
    from[k] = placeOf(patches[k]) + kRayLift * normalOf(patches[k]);
    const glm::vec3 to = trial.is_sun ? trial.at : trial.at - from[k];
    distance[k] = glm::length(to);
    along[k] = distance[k] > 0 ? to / distance[k] : normalOf(patches[k]);
  }
  traceLengths(scene.caster().embree(), from, along, lengths);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const float reach =
        trial.is_sun ? std::numeric_limits<float>::infinity() : kReached * distance[k];
    const float cosine = glm::dot(along[k], normalOf(patches[k]));
    light[k] = 0;
    if (cosine <= 0 || lengths[k] < reach) continue;
    const double square = double(trial.size) * trial.size;
    const double spread =
        trial.is_sun ? 1.0 : square / (square + double(distance[k]) * distance[k]);
    light[k] = cosine * spread;
  }
}

/// About kMostRows patches of a tree.
std::vector<std::size_t> someOf(const PatchTree& tree) {
  const std::size_t n = tree.patches().size();
  std::vector<std::size_t> places(std::min(n, kMostRows));
  for (std::size_t k = 0; k < places.size(); ++k) {
    places[k] = (2 * k + 1) * n / (2 * places.size());
  }
  return places;
}

std::array<Trial, kTrials> chooseTrials(const RayScene& scene, const PatchTree& tree,
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
  return trials;
}

/// What all trials give to all unknowns, kTrials values each.
std::vector<double> trialLight(const RayScene& scene, const PatchTree& tree, std::uint64_t seed,
                               Progress& progress) {
  constexpr std::size_t kPatches = 4 * kRayLanes;
  const auto patches = tree.patches();
  std::vector<double> light(scene.size() * kTrials, 0.0);
  const std::array<Trial, kTrials> trials = chooseTrials(scene, tree, seed);
  for (std::size_t t = 0; t < kTrials; ++t) {
    const Trial& trial = trials[t];
    parallelFor(patches.size() / kPatches + 1, 1, [&](std::size_t part) {
      if (progress.cancelled()) return;
      const std::size_t begin = std::min(part * kPatches, patches.size());
      const auto some = patches.subspan(begin, std::min(kPatches, patches.size() - begin));
      std::array<double, kPatches> of{};
      const FlushDenormals flush;
      shine(scene, some, trial, std::span(of).first(some.size()));
      for (std::size_t k = 0; k < some.size(); ++k) light[some[k].patch * kTrials + t] = of[k];
    });
    progress.check();
  }
  return light;
}

using OfTrials = std::array<double, kTrials>;

struct SampleRow {
  std::size_t place = 0;
  double area = 0;
  RayRow row;
  OfTrials whole{};       ///< irradiance by its rays
  OfTrials difference{};  ///< half of that between the replicates
  OfTrials off{};         ///< by which the cut differs
};

void measureRays(const RayScene& scene, std::span<const double> light, SampleRow& sample) {
  sample.whole = {};
  sample.difference = {};
  const RayRow& row = sample.row;
  if (!(row.counted() > 0)) return;
  for (std::size_t e = 0; e < row.columns.size() && row.columns[e] < scene.size(); ++e) {
    const double* of = &light[scene.order()[row.columns[e]] * kTrials];
    const auto [first, second] = row.hits[e];
    for (std::size_t t = 0; t < kTrials; ++t) {
      sample.whole[t] += (double(first) + double(second)) / row.counted() * of[t];
      sample.difference[t] += (double(first) - double(second)) / row.counted() * of[t];
    }
  }
}

/// The root mean square over the trials of what rows are off by, relative to all of each trial.
double relativeError(std::span<const SampleRow> rows, OfTrials SampleRow::*off) {
  double sum = 0;
  int lit = 0;
  for (std::size_t t = 0; t < kTrials; ++t) {
    double squares = 0;
    double norm = 0;
    for (const SampleRow& row : rows) {
      squares += row.area * (row.*off)[t] * (row.*off)[t];
      norm += row.area * row.whole[t] * row.whole[t];
    }
    if (!(norm > 0)) continue;
    ++lit;
    sum += squares / norm;
  }
  return lit > 0 ? std::sqrt(sum / lit) : 0.0;
}

class Trials {
 public:
  Trials(const RayScene& scene, const PatchTree& tree, std::uint64_t seed, Progress& progress)
      : scene_(scene), tree_(tree), progress_(progress) {
    for (const std::size_t place : someOf(tree)) {
      rows_.emplace_back();
      rows_.back().place = place;
      rows_.back().area = tree.patches()[place].area;
    }
    light_ = trialLight(scene, tree, seed, progress);
  }

  CutPlan plan(double tolerance) {
    CutPlan plan;
    castAll(kFirstRays, plan);
    while (plan.noise > kNoiseShare * tolerance && plan.rays < RowCutter::kMostRays) {
      const double wanted = std::pow(plan.noise / (kNoiseShare * tolerance), 2 / kUsualOrder);
      const double growth = std::clamp(wanted, 1.25, kMostGrowth);
      castAll(std::min(roundedRays(plan.rays * growth), RowCutter::kMostRays), plan);
    }
    fields_ = nodeFields(tree_, light_, kTrials);
    for (const double opening : kOpenings) {
      plan.opening = opening;
      cutAll(plan);
      if (plan.bias <= kBiasShare * tolerance) break;
    }
    plan.seconds = taken_.ratio() * taken_.processor / rays_taken_ * plan.rays;
    plan.is_lit = std::ranges::any_of(rows_, [](const SampleRow& row) {
      return std::ranges::any_of(row.whole, [](double h) { return h > 0; });
    });
    return plan;
  }

 private:
  void castAll(std::uint32_t rays, CutPlan& plan) {
    std::vector<BothClocks> taken(rows_.size());
    const std::uint32_t before = plan.rays;
    parallelFor(rows_.size(), 1, [&](std::size_t k) {
      SampleRow& sample = rows_[k];
      const BothWatches watches;
      scene_.cast(scene_.position()[tree_.patches()[sample.place].patch], rays, sample.row,
                  progress_);
      taken[k] = watches.elapsed();
      if (!progress_.cancelled()) measureRays(scene_, light_, sample);
    });
    progress_.check();
    for (const BothClocks& of_row : taken) taken_ += of_row;
    rays_taken_ += double(rays - before) * double(rows_.size());
    plan.rays = rays;
    plan.noise = relativeError(rows_, &SampleRow::difference);
  }

  void cutAll(CutPlan& plan) {
    const RowCutter cutter(scene_, tree_, plan.opening);
    std::vector<std::size_t> entries(rows_.size());
    parallelFor(rows_.size(), 1, [&](std::size_t k) {
      SampleRow& sample = rows_[k];
      CutRows rows;
      cutter.cut(sample.place, sample.row, rows);
      entries[k] = rows.nodes.size();
      const OfTrials cut = sumOfCut<kTrials>(rows, 0, fields_.data(), kTrials, CutRows::both);
      for (std::size_t t = 0; t < kTrials; ++t) {
        const double each = sample.row.counted() > 0 ? 1 / sample.row.counted() : 0.0;
        sample.off[t] = each * cut[t] - sample.whole[t];
      }
    });
    progress_.check();
    double sum = 0;
    for (const std::size_t of_row : entries) sum += double(of_row);
    plan.entries = sum / double(rows_.size());
    plan.bias = relativeError(rows_, &SampleRow::off);
  }

  const RayScene& scene_;
  const PatchTree& tree_;
  Progress& progress_;
  std::vector<SampleRow> rows_;
  std::vector<double> light_;
  std::vector<NodeField> fields_;
  BothClocks taken_;
  double rays_taken_ = 0;
};

}  // namespace

CutPlan planCuts(const RayScene& scene, const PatchTree& tree, double tolerance, std::uint64_t seed,
                 Progress& progress) {
  if (tree.patches().empty()) return {};
  return Trials(scene, tree, seed, progress).plan(tolerance);
}

}  // namespace radiosity
