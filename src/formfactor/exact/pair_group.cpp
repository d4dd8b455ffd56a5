#include "formfactor/exact/pair_group.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace radiosity {
namespace {

/// Halvings of a cell: an end where an estimate does not fall.
constexpr int kMostLevels = 7;

}  // namespace

double VisibleFraction::error() const { return whole > 0 ? std::sqrt(error2) / whole : 0; }

template <class T>
void PairGroups<T>::setTargets(std::span<const SampledPair> group,
                               std::span<const Blocker> blockers) {
  targets_.resize(group.size());
  for (std::size_t k = 0; k < group.size(); ++k) {
    const SampledPair& pair = group[k];
    GroupTarget& target = targets_[k];
    target.blockers =
        blockers.subspan(pair.blockers_begin, pair.blockers_end - pair.blockers_begin);
    if (!pair.target_cut) {
      const auto outline = elements_.outline(pair.target);
      std::copy(outline.begin(), outline.end(), target.corners.begin());
      target.corner_count = outline.size();
      target.middle = elements_.centroid[pair.target];
      continue;
    }
    const Facet& horizon = elements_.facets[elements_.facet[pair.sampled]];
    const std::vector<Vec3> part = partInFront(elements_, pair.target, horizon);
    std::copy(part.begin(), part.end(), target.corners.begin());
    target.corner_count = part.size();
    target.middle = std::accumulate(part.begin(), part.end(), Vec3(0.0)) / double(part.size());
  }
}

template <class T>
void PairGroups<T>::integrate(std::span<const SampledPair> group, std::span<const Blocker> blockers,
                              std::span<VisibleFraction> fractions) {
  const SampledPair& any = group[0];
  normal_ = elements_.facets[elements_.facet[any.sampled]].normal;
  setTargets(group, blockers);
  const auto outline = elements_.outline(any.sampled);
  std::vector<Vec3> c(outline.begin(), outline.end());
  if (any.sampled_cut) {
    c = partInFront(elements_, any.sampled, elements_.facets[elements_.facet[any.target]]);
  }
  std::vector<Index> members(group.size());
  std::iota(members.begin(), members.end(), 0);
  // Of a quadrilateral cut by a plane there may be five corners: a quadrilateral and a triangle.
  for (std::size_t first = 0; first + 2 < c.size(); first += 2) {
    const SampleCell cell = {
        {c[0], c[first + 1], c[first + 2], c[std::min(first + 3, c.size() - 1)]}};
    cutCell(cell, members, 0, {}, fractions);
  }
}

/// Integrates over one cell, or over its four parts for those members that need it. `fractions`:
/// of each member, what the error is measured about; empty: the cell's own.
template <class T>
void PairGroups<T>::cutCell(const SampleCell& cell, std::span<const Index> members, int level,
                            std::span<const double> fractions, std::span<VisibleFraction> out) {
  std::vector<const GroupTarget*> targets;
  targets.reserve(members.size());
  for (const Index m : members) targets.push_back(&targets_[m]);
  std::vector<CellValues> values(members.size());
  view_.look(cell, normal_, targets, values);
  std::array<double, SampleCell::kPoints> weights;
  for (std::size_t q = 0; q < weights.size(); ++q) weights[q] = cell.point(q).weight;
  const double area = cell.area();
  std::vector<Index> again;
  std::vector<double> about;
  for (std::size_t k = 0; k < members.size(); ++k) {
    VisibleFraction& sum = out[members[k]];
    sum.points += SampleCell::kPoints;
    sum.sampled |= values[k].sampled;
    double visible = 0;
    double whole = 0;
    for (std::size_t q = 0; q < weights.size(); ++q) {
      visible += weights[q] * values[k].visible[q];
      whole += weights[q] * values[k].whole[q];
    }
    if (!(whole > 0)) continue;
    const double fraction = fractions.empty() ? visible / whole : fractions[k];
    const double error = area * values[k].error(fraction);
    // Squares of errors add up: a quarter of the cell may have half the error.
    if (error > sum.allowed * whole * std::ldexp(1.0, level) && level < kMostLevels) {
      sum.subdivided = true;
      again.push_back(members[k]);
      about.push_back(fraction);
      continue;
    }
    sum.visible += visible;
    sum.whole += whole;
    sum.error2 += error * error;
  }
  if (again.empty()) return;
  for (std::size_t c = 0; c < 4; ++c) cutCell(cell.child(c), again, level + 1, about, out);
}

template class PairGroups<float>;
template class PairGroups<double>;

}  // namespace radiosity
