#include "formfactor/exact/pair_group.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace radiosity {
namespace {

/// Halvings of a cell: an end where an estimate does not fall.
constexpr int kMostLevels = 10;

/// Root mean square of the error of a visible fraction by 2 x 2 points, in changes (measured on the
/// closed Cornell box, 1,000 to 5,000 patches, where it is proportional to the change).
constexpr double kExpected4 = 0.016;

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
  Members coarse;
  Members fine;
  for (Index k = 0; k < group.size(); ++k) {
    fractions[k].change = double(group[k].change);
    fractions[k].refined = kExpected4 * fractions[k].change > fractions[k].allowed;
    (fractions[k].refined ? fine : coarse).index.push_back(k);
  }
  // Of a quadrilateral cut by a plane there may be five corners: a quadrilateral and a triangle.
  for (std::size_t first = 0; first + 2 < c.size(); first += 2) {
    const SampleCell cell = {
        {c[0], c[first + 1], c[first + 2], c[std::min(first + 3, c.size() - 1)]}};
    const Members again = integrateCell(cell, 2, 0, coarse, fractions);
    Members others = fine;
    others.index.insert(others.index.end(), again.index.begin(), again.index.end());
    cutCell(cell, others, 0, fractions);
  }
}

/// Integrates over one cell. Returns the members whose error is too large; to them nothing is
/// added.
template <class T>
typename PairGroups<T>::Members PairGroups<T>::integrateCell(const SampleCell& cell,
                                                             std::size_t side, int level,
                                                             const Members& members,
                                                             std::span<VisibleFraction> out) {
  if (members.index.empty()) return {};
  const SamplePoints points = cell.points(side);
  chosen_.clear();
  for (const Index m : members.index) chosen_.push_back(&targets_[m]);
  view_.look(points.all(), cell.middle(), normal_, chosen_);
  const double area = cell.area();
  // Squares of errors add up: a quarter of a cell, whose integral is a quarter, may have half the
  // error. What slips between points there is smaller, and rarer.
  const double share = std::ldexp(1.0, level);
  const double unseen = std::ldexp(1.0, -2 * level);
  Members failed;
  for (std::size_t k = 0; k < members.index.size(); ++k) {
    VisibleFraction& sum = out[members.index[k]];
    sum.points += points.count;
    sum.sampled |= view_.sampled(k);
    double visible = 0;
    double whole = 0;
    for (std::size_t q = 0; q < points.count; ++q) {
      visible += points.point[q].weight * double(view_.visible(q)[k]);
      whole += points.point[q].weight * double(view_.whole(q)[k]);
    }
    if (!(whole > 0)) continue;
    const double fraction = members.fraction.empty() ? visible / whole : members.fraction[k];
    CellValues values;
    for (std::size_t q = 0; q < points.count; ++q) {
      values.residual[q] = double(view_.visible(q)[k]) - fraction * double(view_.whole(q)[k]);
      values.one_shape &= view_.shape(q)[k] == view_.shape(0)[k];
      values.no_edge &= view_.seesNoEdge(q, k);
    }
    const double error =
        area * (side == 2 ? meanError4 : meanError9)(values, unseen * sum.change, whole / area);
    if (error > share * sum.allowed * whole && level < kMostLevels) {
      failed.index.push_back(members.index[k]);
      failed.fraction.push_back(fraction);
      continue;
    }
    sum.visible += visible;
    sum.whole += whole;
    sum.error2 += error * error;
  }
  return failed;
}

/// Integrates over one cell by 3 x 3 points, or over its four parts for those who need it.
template <class T>
void PairGroups<T>::cutCell(const SampleCell& cell, const Members& members, int level,
                            std::span<VisibleFraction> out) {
  for (const Index m : members.index) out[m].refined = true;
  const Members again = integrateCell(cell, 3, level, members, out);
  if (again.index.empty()) return;
  for (std::size_t c = 0; c < 4; ++c) cutCell(cell.child(c), again, level + 1, out);
}

template class PairGroups<float>;
template class PairGroups<double>;

}  // namespace radiosity
