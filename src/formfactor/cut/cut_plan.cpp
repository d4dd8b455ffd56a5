#include "formfactor/cut/cut_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/cut/row_cutter.h"
#include "formfactor/cut/trial_lights.h"
#include "formfactor/rays/ray_model.h"
#include "formfactor/rays/ray_rounds.h"

namespace radiosity {
namespace {

constexpr std::uint32_t kFirstRays = 128;
/// A step gives rows at most this many times the rays that they have.
constexpr double kMostGrowth = 16;
/// Shares of the tolerance for rays and for cutting: together they are 1.
constexpr double kNoiseShare = 0.8;
constexpr double kBiasShare = 0.6;
/// The last cuts nothing: each patch that was hit has an entry.
constexpr std::array<double, 10> kOpenings{1, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125, 0.06, 0.03, 0};
/// Nodes are opened beyond what the tolerance asks for while that takes no more than this many
/// times the entries: where each ray of a row ends elsewhere, cutting saves next to nothing.
constexpr double kFewEntries = 1.25;
/// The least light, as a share of the mean, to which the error of a row is compared.
constexpr double kLeastLight = 0.1;
using OfTrials = std::array<double, kTrials>;

struct SampleRow {
  std::size_t place = 0;
  double area = 0;
  RayRow row;
  OfTrials direct{};      ///< irradiance that its rays do not bring
  OfTrials sky{};         ///< by rays that meet nothing
  OfTrials whole{};       ///< by rays that end on patches
  OfTrials difference{};  ///< of both: half of that between the replicates
  OfTrials off{};         ///< by which the cut differs from `whole`
};

void measureRays(const RayScene& scene, const TrialLights& lights, SampleRow& sample) {
  sample.whole = {};
  sample.difference = {};
  const RayRow& row = sample.row;
  if (!(row.counted() > 0)) return;
  for (std::size_t t = 0; t < kTrials; ++t) {
    sample.sky[t] = lights.sky[t] * row.skyShare();
    sample.difference[t] =
        lights.sky[t] * (double(row.sky[0]) - double(row.sky[1])) / row.counted();
  }
  for (std::size_t e = 0; e < row.columns.size() && row.columns[e] < scene.size(); ++e) {
    const double* of = &lights.radiosity[scene.order()[row.columns[e]] * kTrials];
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
      const double all = row.direct[t] + row.sky[t] + row.whole[t];
      norm += row.area * all * all;
    }
    if (!(norm > 0)) continue;
    ++lit;
    sum += squares / norm;
  }
  return lit > 0 ? std::sqrt(sum / lit) : 0.0;
}

/// The same with the error of each row relative to its own light: what cuts are off by is alike
/// from row to row, and a dim room gets all of its light from the same few nodes. Light below
/// kLeastLight of the mean counts as that.
double relativeErrorOfRows(std::span<const SampleRow> rows, OfTrials SampleRow::*off) {
  double sum = 0;
  int lit = 0;
  for (std::size_t t = 0; t < kTrials; ++t) {
    const auto lightOf = [t](const SampleRow& row) {
      return row.direct[t] + row.sky[t] + row.whole[t];
    };
    double area = 0;
    double light = 0;
    for (const SampleRow& row : rows) {
      area += row.area;
      light += row.area * lightOf(row);
    }
    if (!(light > 0)) continue;
    ++lit;
    const double least = kLeastLight * light / area;
    for (const SampleRow& row : rows) {
      const double share = (row.*off)[t] / std::max(lightOf(row), least);
      sum += row.area / area * share * share;
    }
  }
  return lit > 0 ? std::sqrt(sum / lit) : 0.0;
}

class Trials {
 public:
  Trials(const RayScene& scene, const PatchTree& tree, TrialLights lights, Progress& progress)
      : scene_(scene), tree_(tree), progress_(progress), lights_(std::move(lights)) {
    for (const std::size_t place : someOf(tree)) {
      SampleRow& sample = rows_.emplace_back();
      const PatchTree::Patch& patch = tree.patches()[place];
      sample.place = place;
      sample.area = patch.area;
      std::copy_n(&lights_.direct[patch.patch * kTrials], kTrials, sample.direct.begin());
    }
  }

  CutPlan plan(double tolerance) {
    CutPlan plan;
    castAll(kFirstRays, plan);
    while (plan.noise > kNoiseShare * tolerance && plan.rays < RowCutter::kMostRays) {
      const double wanted = std::pow(plan.noise / (kNoiseShare * tolerance), 2 / kUsualOrder);
      const double growth = std::clamp(wanted, 1.25, kMostGrowth);
      castAll(std::min(roundedRays(plan.rays * growth), RowCutter::kMostRays), plan);
    }
    fields_ = nodeFields(tree_, lights_.radiosity, kTrials);
    openNodes(tolerance, plan);
    plan.seconds = taken_.ratio() * taken_.processor / rays_taken_ * plan.rays;
    plan.is_lit = std::ranges::any_of(rows_, [](const SampleRow& row) {
      return std::ranges::any_of(row.whole, [](double h) { return h > 0; });
    });
    return plan;
  }

 private:
  void openNodes(double tolerance, CutPlan& plan) {
    double most_entries = std::numeric_limits<double>::infinity();
    for (const double opening : kOpenings) {
      const CutPlan before = plan;
      plan.opening = opening;
      const double of_rows = cutAll(plan);
      if (plan.entries > most_entries) {
        plan = before;
        return;
      }
      if (of_rows <= kBiasShare * tolerance) {
        most_entries = std::min(most_entries, kFewEntries * plan.entries);
      }
    }
  }

  void castAll(std::uint32_t rays, CutPlan& plan) {
    std::vector<BothClocks> taken(rows_.size());
    const std::uint32_t before = plan.rays;
    parallelFor(rows_.size(), 1, [&](std::size_t k) {
      SampleRow& sample = rows_[k];
      const BothWatches watches;
      scene_.cast(scene_.position()[tree_.patches()[sample.place].patch], rays, sample.row,
                  progress_);
      taken[k] = watches.elapsed();
      if (!progress_.cancelled()) measureRays(scene_, lights_, sample);
    });
    progress_.check();
    for (const BothClocks& of_row : taken) taken_ += of_row;
    rays_taken_ += double(rays - before) * double(rows_.size());
    plan.rays = rays;
    plan.noise = relativeError(rows_, &SampleRow::difference);
  }

  /// Returns the error of cutting relative to the light of rows.
  double cutAll(CutPlan& plan) {
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
    return relativeErrorOfRows(rows_, &SampleRow::off);
  }

  const RayScene& scene_;
  const PatchTree& tree_;
  Progress& progress_;
  TrialLights lights_;
  std::vector<SampleRow> rows_;
  std::vector<NodeField> fields_;
  BothClocks taken_;
  double rays_taken_ = 0;
};

}  // namespace

CutPlan planCuts(const PatchMesh& mesh, const RayScene& scene, const PatchTree& tree,
                 const FormFactorOptions& options, Progress& progress) {
  if (tree.patches().empty()) return {};
  TrialLights lights = trialLights(mesh, scene, tree, options.exact_rows, options.onlyForSources(),
                                   options.seed, progress);
  return Trials(scene, tree, std::move(lights), progress)
      .plan(options.toleranceOf(FormFactorMethod::cut));
}

}  // namespace radiosity
