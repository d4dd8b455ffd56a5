#include "scene_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <vector>

#include "converged_cell.h"
#include "formfactor/exact/assembly/exact_scene.h"
#include "formfactor/exact/assembly/recorded_pairs.h"
#include "formfactor/exact/error_model.h"
#include "formfactor/exact/occluded/adaptive_integrator.h"
#include "formfactor/exact/occluded/cell_error.h"
#include "formfactor/exact/occluded/critical_lines.h"
#include "formfactor/exact/occluded/pair_sampling.h"
#include "formfactor/exact/occluded/part_error.h"

namespace radiosity::bench {
namespace {

constexpr std::uint32_t kSeed = 1;
/// About how many ranges of rows give pairs.
constexpr std::size_t kRanges = 48;
constexpr double kCellTolerances[] = {1e-1, 1e-2, 1e-3, 1e-4};
constexpr double kPartTolerances[] = {1e-4, 1e-6};
constexpr int kMostLevels = 5;

/// Partly hidden pairs with their occluders.
struct Drawn {
  std::vector<OccludedPair> pairs;
  std::vector<Index> occluder_list;
};

Drawn drawPairs(const ExactScene& scene, std::size_t wanted, std::mt19937& random) {
  std::vector<ElementRange> ranges;
  for (std::size_t t = 0; t < scene.tasks.size(); ++t) {
    ranges.insert(ranges.end(), scene.tasks[t].begin(), scene.tasks[t].end());
  }
  std::shuffle(ranges.begin(), ranges.end(), random);
  const std::size_t of_range = wanted / std::min(kRanges, ranges.size()) + 1;
  const UnoccludedKernel unoccluded(scene.elements, 1e-5, true);
  Drawn drawn;
  for (const ElementRange& range : ranges) {
    RecordedPairs recorded;
    VisibilityCounts counts;
    scene.visibility.classify(range, recorded, counts);
    std::vector<OccludedPair> some;
    std::sample(recorded.occluded_pairs.begin(), recorded.occluded_pairs.end(),
                std::back_inserter(some), of_range, random);
    for (OccludedPair pair : some) {
      pair.unoccluded = unoccluded.pair(pair.row, pair.column);
      if (!(pair.unoccluded > 0)) continue;
      const auto first = recorded.occluder_list.begin() + pair.occluders_begin;
      const auto last = recorded.occluder_list.begin() + pair.occluders_end;
      pair.occluders_begin = std::uint32_t(drawn.occluder_list.size());
      drawn.occluder_list.insert(drawn.occluder_list.end(), first, last);
      pair.occluders_end = std::uint32_t(drawn.occluder_list.size());
      drawn.pairs.push_back(pair);
    }
    if (drawn.pairs.size() >= wanted) break;
  }
  return drawn;
}

class SceneSampler {
 public:
  SceneSampler(const ExactScene& scene, std::mt19937& random)
      : elements_(scene.elements),
        distances_(scene.elements, scene.occluders, true),
        ready_(scene.elements, scene.occluders, distances_),
        random_(random) {}

  void run(const Drawn& drawn) {
    ready_.prepare(drawn.pairs, drawn.occluder_list, SampledEnd::calmer);
    for (const SampledPair& sampled : ready_.pairs) {
      if (sampled.sampled_cut || sampled.target_cut) continue;
      take(sampled);
      const OccludedPair& pair = drawn.pairs[sampled.pair];
      for (const double tolerance : kCellTolerances) {
        sampleCells(tolerance, allowedError(elements_, pair, tolerance));
      }
      for (const double tolerance : kPartTolerances) {
        sampleParts(tolerance, allowedError(elements_, pair, tolerance));
      }
      sampleFar();
    }
  }

 private:
  /// The pair of all calls below.
  void take(const SampledPair& sampled) {
    sampled_ = &sampled;
    const Vec3& normal = elements_.facets[elements_.facet[sampled.target]].normal;
    target_.setOutline(elements_.outline(sampled.target),
                       makeFrame(elements_.centroid[sampled.target], normal, axisAcross(normal)));
    target_.blockers =
        std::span<const Blocker>(ready_.blockers)
            .subspan(sampled.blockers_begin, sampled.blockers_end - sampled.blockers_begin);
    look_.take(target_, elements_.facets[elements_.facet[sampled.sampled]].normal);
    distance_ =
        (glm::distance(elements_.centroid[sampled.sampled], elements_.centroid[sampled.target]) -
         elements_.radius[sampled.sampled]) /
        elements_.radius[sampled.target];
  }

  /// As AdaptiveIntegrator, but for one quarter of each cell that is cut.
  void sampleCells(double tolerance, double allowed) {
    const std::span<const Vec3> c = elements_.outline(sampled_->sampled);
    SampleCell cell = {{c[0], c[1], c[2], c[c.size() - 1]}};
    double fraction = -1;
    const bool coarse = !sampled_->may_cross && expectedError(double(sampled_->change)) <= allowed;
    if (coarse && sampleCell(cell, 2, 0, tolerance, allowed, fraction)) return;
    for (int level = 0; level <= kMostLevels; ++level) {
      if (sampleCell(cell, 3, level, tolerance, allowed, fraction)) return;
      cell = cell.child(random_() % 4);
    }
  }

  /// True if the cell is kept. `fraction`: the first rule's; below 0: not known yet.
  bool sampleCell(const SampleCell& cell, std::size_t side, int level, double tolerance,
                  double allowed, double& fraction) {
    const SamplePoints points = cell.points(side);
    look_.at(points, cell);
    const double area = cell.area();
    const PairSum rule = look_.sum(points);
    if (!(rule.whole > 0)) return true;
    const double about = fraction < 0 ? rule.visible / rule.whole : fraction;
    CellValues values;
    values.count = points.count;
    values.whole = rule.whole / area;
    values.fraction = rule.visible / rule.whole;
    values.side = std::ldexp(1.0, -level);
    values.change = changeIn(level, double(sampled_->change));
    values.may_cross = sampled_->may_cross;
    values.one_occluder = target_.blockers.size() == 1;
    for (std::size_t q = 0; q < points.count; ++q) {
      values.residual[q] = look_.visible(q) - about * look_.whole(q);
      values.one_shape &= look_.shape(q) == look_.shape(0);
    }
    const CellError error = meanError(values);
    const double accepted = std::ldexp(allowed, level);
    const double guessed = error.cautious / values.whole;
    double outside = -1;
    double decides = guessed;
    const bool uncertain = values.one_shape || values.flat();
    if (side == 3 && uncertain && (values.may_cross || guessed > kPairDoubtful * accepted)) {
      outside = largestOutside(cell, values.fraction) / values.whole;
      const double seen = std::max(kCellReassured * guessed, kCellOutside * outside);
      if (guessed > accepted || seen > guessed) decides = seen;
    }
    const PairSum truth = convergedCell(look_, cell, values.may_cross ? 4 : 3);
    const double missed = (rule.visible - truth.visible) - about * (rule.whole - truth.whole);
    fmt::print("cell {} {} {:d} {:d} {:d} {} {} {} {} {} {} {}", tolerance, level, values.one_shape,
               values.may_cross, values.one_occluder, values.fraction, values.change,
               std::abs(missed) / rule.whole, guessed, error.stated / values.whole, accepted,
               outside);
    for (std::size_t q = 0; q < points.count; ++q) {
      fmt::print(" {}", values.residual[q] / values.whole);
    }
    fmt::print("\n");
    if (fraction < 0) fraction = about;
    return decides <= accepted;
  }

  double largestOutside(const SampleCell& cell, double fraction) {
    const SamplePoints points = cell.outerPoints();
    look_.at(points, cell);
    double largest = 0;
    for (std::size_t q = 0; q < points.count; ++q) {
      largest = std::max(largest, std::abs(look_.visible(q) - fraction * look_.whole(q)));
    }
    return largest;
  }

  /// The quadrilaterals that the sampled element is cut into; none if one has a foot, about which
  /// parts are cut otherwise.
  std::vector<SampleCell> partsOf(double most) {
    const Vec3& normal = elements_.facets[elements_.facet[sampled_->sampled]].normal;
    const auto outline = std::span(target_.corners).first(target_.corner_count);
    std::vector<SampleCell> cells;
    if (!lines_.cut(elements_.outline(sampled_->sampled), normal, outline, target_.blockers,
                    elements_.coincidence, std::size_t(most))) {
      return cells;
    }
    for (const CriticalLines::Part& part : lines_.parts()) {
      for (const Vec2& corner : part) {
        if (lines_.isFoot(corner)) return {};
      }
      const auto corner = [&](std::size_t k) {
        return lines_.lift(part[std::min(k, part.size() - 1)]);
      };
      for (std::size_t k = 1; k + 1 < part.size(); k += 2) {
        cells.push_back({{corner(0), corner(k), corner(k + 1), corner(k + 2)}});
      }
    }
    return cells;
  }

  PartValues valuesOf(const SampleCell& cell) {
    PartValues values;
    values.area = cell.area();
    SamplePoints points = cell.points(2);
    const SamplePoints more = cell.points(3);
    for (const SamplePoint& p : more.all()) points.point[points.count++] = p;
    look_.at(points, cell);
    for (std::size_t q = 0; q < points.count; ++q) {
      values.weight[q] = points.point[q].weight;
      values.visible[q] = look_.visible(q);
      values.whole[q] = look_.whole(q);
      values.one_shape &= look_.shape(q) == look_.shape(0);
      values.overlap |= look_.overlapping(q);
    }
    return values;
  }

  void sampleParts(double tolerance, double allowed) {
    const double misses = expectedError(double(sampled_->change)) / allowed;
    const double most = std::min(misses / kPartWorth, double(CriticalLineQuadrature::kMostParts));
    if (!(most >= 1)) return;
    std::vector<SampleCell> cells = partsOf(most);
    std::erase_if(cells, [](const SampleCell& cell) { return !(cell.area() > 0); });
    std::vector<PartValues> parts;
    PairSum all;
    for (const SampleCell& cell : cells) {
      parts.push_back(valuesOf(cell));
      all.visible += parts.back().integral(parts.back().visible);
      all.whole += parts.back().integral(parts.back().whole);
    }
    if (!(all.whole > 0)) return;
    for (std::size_t k = 0; k < cells.size(); ++k)
      printPart(tolerance, allowed, cells[k], parts[k], all);
  }

  void printPart(double tolerance, double allowed, const SampleCell& cell, const PartValues& part,
                 const PairSum& all) {
    const double fraction = all.visible / all.whole;
    const bool near = distance_ < kPairNear;
    double largest = 0;
    double coarse = 0;
    double fine = 0;
    double middle = 0;
    for (std::size_t q = 0; q < PartValues::kPoints; ++q) {
      const double residual = part.visible[q] - fraction * part.whole[q];
      largest = std::max(largest, std::abs(residual));
      (q < PartValues::kCoarse ? coarse : fine) += part.weight[q] * residual;
      // The point in the middle is the fifth of nine, of weight (4/9)^2.
      if (q == PartValues::kCoarse + 4) middle = residual * part.weight[q] * 81 / 16;
    }
    const PairSum truth = convergedCell(look_, cell, part.overlap ? 3 : 2);
    const double missed = fine - (truth.visible - fraction * truth.whole);
    const double estimate = part.error(fraction, near);
    const double part_whole = std::max(part.integral(part.whole), 0.0);
    fmt::print("part {} {:d} {:d} {:d} {} {} {} {} {} {:d}\n", tolerance, part.one_shape, near,
               part.overlap, std::abs(fine - coarse) / all.whole,
               std::abs(coarse - middle) / all.whole, largest * part.area / all.whole,
               std::abs(missed) / all.whole, estimate / all.whole,
               estimate <= allowed * std::sqrt(all.whole * part_whole));
  }

  void sampleFar() {
    if (distance_ < 2 || distance_ > 4) return;
    const std::span<const Vec3> c = elements_.outline(sampled_->sampled);
    const SampleCell cell = {{c[0], c[1], c[2], c[c.size() - 1]}};
    const SamplePoints points = cell.points(2);
    look_.at(points, cell);
    const PairSum near = look_.sum(points);
    look_.at(points, cell, true);
    const PairSum far = look_.sum(points);
    if (!(near.whole > 0 && far.whole > 0)) return;
    const double fraction = near.visible / near.whole;
    fmt::print("far {} {} {}\n", distance_, fraction, far.visible / far.whole - fraction);
  }

  const ElementSet& elements_;
  EdgeDistances distances_;
  PairPreparation ready_;
  std::mt19937& random_;
  const SampledPair* sampled_ = nullptr;
  GroupTarget target_;
  double distance_ = 0;  ///< of the target, in its radii: see AdaptiveIntegrator
  CriticalLines lines_;
  TargetLook look_;
};

}  // namespace

void sampleScene(const PatchMesh& mesh, std::size_t pairs) {
  Progress silent;
  const ExactScene scene(mesh, silent);
  std::mt19937 random(kSeed);
  const Drawn drawn = drawPairs(scene, pairs, random);
  SceneSampler(scene, random).run(drawn);
}

}  // namespace radiosity::bench
