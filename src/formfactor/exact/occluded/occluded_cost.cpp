#include "formfactor/exact/occluded/occluded_cost.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "formfactor/exact/error_model.h"
#include "formfactor/exact/occluded/adaptive_integrator.h"
#include "formfactor/exact/occluded/critical_lines.h"
#include "formfactor/exact/occluded/pair_sampling.h"
#include "formfactor/foreseen_work.h"

namespace radiosity {
namespace {

/// Points of the first rule.
constexpr double kFirst = 4;

/// If double precision is asked for and bodies have few edges, elements are cut along critical
/// lines instead, if that pays: into parts of 13 points.
constexpr double kCutFrom = kPointsParts * kPartWorth;
constexpr double kPartPoints = kPointsParts * 13;

/// The exchange from middle to middle, at most that of a target that fills the view.
double guessedExchange(const ElementSet& elements, const OccludedPair& pair) {
  const Vec3 way = elements.centroid[pair.column] - elements.centroid[pair.row];
  const double up = glm::dot(way, elements.facets[elements.facet[pair.row]].normal);
  const double down = -glm::dot(way, elements.facets[elements.facet[pair.column]].normal);
  if (!(up > 0 && down > 0)) return 0;
  const double both = elements.area[pair.row] * elements.area[pair.column];
  const double way2 = glm::dot(way, way);
  const double free = up * down / (way2 * way2) * both / std::numbers::pi;
  return std::min(free, std::min(elements.area[pair.row], elements.area[pair.column]));
}

double edgesOf(std::span<const Blocker> blockers) {
  double edges = 0;
  for (const Blocker& blocker : blockers) edges += double(blocker.body->edges.size());
  return edges;
}

}  // namespace

OccludedCost& OccludedCost::operator+=(const OccludedCost& other) {
  points += other.points;
  work += other.work;
  refining += other.refining;
  return *this;
}

OccludedCost OccludedCost::operator*(double share) const {
  return {share * points, share * work, share * refining};
}

OccludedCost occludedCost(const ElementSet& elements, const OccluderSet& occluders,
                          std::span<const OccludedPair> pairs, std::span<const Index> occluder_list,
                          double tolerance) {
  const EdgeDistances distances(elements, occluders, true);
  PairPreparation ready(elements, occluders, distances);
  ready.prepare(pairs, occluder_list, SampledEnd::calmer);
  OccludedCost cost;
  for (const SampledPair& sampled : ready.pairs) {
    OccludedPair pair = pairs[sampled.pair];
    pair.unoccluded = guessedExchange(elements, pair);
    const double allowed = allowedError(elements, pair, tolerance);
    const double misses = expectedError(double(sampled.change)) / allowed;
    const auto blockers =
        std::span<const Blocker>(ready.blockers)
            .subspan(sampled.blockers_begin, sampled.blockers_end - sampled.blockers_begin);
    const double edges = edgesOf(blockers);
    const bool cut = tolerance < kSinglePrecision && misses > kCutFrom &&
                     edges <= double(CriticalLines::kMostEdges);
    const double more = cut ? kPartPoints : kPointsMore * misses;
    const double rate =
        kClipWork * std::min(double(blockers.size()), kMostClips) + kEdgeWork * edges;
    cost +=
        {kFirst + more, rate * (kFirst + (cut ? kPartPointWork : 1) * more), cut ? 0 : rate * more};
  }
  return cost;
}

}  // namespace radiosity
