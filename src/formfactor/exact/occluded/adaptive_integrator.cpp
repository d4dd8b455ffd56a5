#include "formfactor/exact/occluded/adaptive_integrator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

#include "formfactor/exact/error_model.h"

namespace radiosity {
namespace {

/// The most halvings of a cell: an end if an estimate does not fall.
constexpr int kMostLevels = 10;

}  // namespace

double expectedError(double change) { return kPairExpected4 * changeIn(0, change); }

double VisibleFraction::error() const {
  if (!(whole > 0)) return 0;
  // The kernel leaves out the same share of the visible part and of the whole where they are one.
  const double seen = fraction();
  return std::hypot(std::sqrt(error2) / whole, 4 * seen * (1 - seen) * far_error);
}

template <class T>
void AdaptiveIntegrator<T>::setTargets(std::span<const SampledPair> group,
                                       std::span<const Blocker> blockers) {
  targets_.resize(group.size());
  // Targets of one facet stand together, and their frames differ in the origin only.
  PlaneFrame frame;
  Index facet = kNone;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const SampledPair& pair = group[k];
    GroupTarget& target = targets_[k];
    target.blockers =
        blockers.subspan(pair.blockers_begin, pair.blockers_end - pair.blockers_begin);
    if (elements_.facet[pair.target] != facet) {
      facet = elements_.facet[pair.target];
      const Vec3& normal = elements_.facets[facet].normal;
      frame = makeFrame(Vec3(0.0), normal, axisAcross(normal));
    }
    if (!pair.target_cut) {
      frame.origin = elements_.centroid[pair.target];
      target.setOutline(elements_.outline(pair.target), frame);
      continue;
    }
    const Facet& horizon = elements_.facets[elements_.facet[pair.sampled]];
    const std::vector<Vec3> part = partInFront(elements_, pair.target, horizon);
    frame.origin = std::accumulate(part.begin(), part.end(), Vec3(0.0)) / double(part.size());
    target.setOutline(part, frame);
  }
}

template <class T>
void AdaptiveIntegrator<T>::integrate(std::span<const SampledPair> group,
                                      std::span<const Blocker> blockers,
                                      std::span<VisibleFraction> fractions) {
  const SampledPair& any = group[0];
  normal_ = elements_.facets[elements_.facet[any.sampled]].normal;
  setTargets(group, blockers);
  const auto outline = elements_.outline(any.sampled);
  std::vector<Vec3> c(outline.begin(), outline.end());
  if (any.sampled_cut) {
    c = partInFront(elements_, any.sampled, elements_.facets[elements_.facet[any.target]]);
  }
  for (const bool far : {false, true}) {
    far_ = far;
    Members coarse;
    Members fine;
    for (Index k = 0; k < group.size(); ++k) {
      const double distance = distanceInRadii(group[k]);
      if ((distance >= far_reach_) != far) continue;
      fractions[k].change = double(group[k].change);
      if (far) fractions[k].far_error = kFarShare * kFarError / (distance * distance * distance);
      fractions[k].near = distance < kPairNear;
      fractions[k].may_cross = group[k].may_cross;
      fractions[k].one_occluder = group[k].blockers_end - group[k].blockers_begin == 1;
      fractions[k].refined =
          group[k].may_cross || expectedError(fractions[k].change) > fractions[k].allowed;
      (fractions[k].refined ? fine : coarse).index.push_back(k);
    }
    cutAtLines(c, fine, fractions);
    // A quadrilateral cut by a plane may have five corners: a quadrilateral and a triangle.
    for (std::size_t first = 0; first + 2 < c.size(); first += 2) {
      const SampleCell cell = {
          {c[0], c[first + 1], c[first + 2], c[std::min(first + 3, c.size() - 1)]}};
      const Members again = integrateCell(cell, 2, 0, coarse, fractions);
      Members others = fine;
      others.index.insert(others.index.end(), again.index.begin(), again.index.end());
      cutCell(cell, others, 0, fractions);
    }
  }
}

/// Integrates over a polygon for the members whose critical lines are so few that this takes fewer
/// points than halving cells; removes them from `members`.
template <class T>
void AdaptiveIntegrator<T>::cutAtLines(std::span<const Vec3> polygon, Members& members,
                                       std::span<VisibleFraction> out) {
  // Single precision is not used where so many points are needed.
  if constexpr (std::is_same_v<T, double>) {
    std::erase_if(members.index, [&](Index m) {
      const double misses = expectedError(out[m].change) / out[m].allowed;
      const double parts =
          std::min(misses / kPartWorth, double(CriticalLineQuadrature::kMostParts));
      return parts >= 1 &&
             between_lines_.integrate(polygon, normal_, targets_[m], far_, elements_.coincidence,
                                      std::size_t(parts), out[m]);
    });
  }
}

/// Distance from the sampled element's nearest point to the target's middle, in the target's radii.
/// It decides whether all of the element is far enough for the kernels that expand about that
/// middle. A target that is cut has another middle: it is never far.
template <class T>
double AdaptiveIntegrator<T>::distanceInRadii(const SampledPair& pair) const {
  if (pair.target_cut) return 0;
  const double distance =
      glm::distance(elements_.centroid[pair.sampled], elements_.centroid[pair.target]) -
      elements_.radius[pair.sampled];
  return distance / elements_.radius[pair.target];
}

/// Integrates over one cell. Returns the members whose error is too large; it adds nothing to
/// these.
template <class T>
typename AdaptiveIntegrator<T>::Members AdaptiveIntegrator<T>::integrateCell(
    const SampleCell& cell, std::size_t side, int level, const Members& members,
    std::span<VisibleFraction> out) {
  if (members.index.empty()) return {};
  if (progress_ != nullptr) progress_->check();
  sumCell(cell, side, level, members, out);
  // Squares of errors add up: a quarter of a cell, whose integral is a quarter, may have half the
  // error.
  const double share = std::ldexp(1.0, level);
  lookOutside(cell, side, share, members, out);
  Members failed;
  for (std::size_t k = 0; k < members.index.size(); ++k) {
    VisibleFraction& sum = out[members.index[k]];
    const CellSum& found = sums_[k];
    if (!(found.whole > 0)) continue;
    if (found.error.cautious > share * sum.allowed * found.whole) {
      if (level < kMostLevels && !isSpent(members.index[k], sum)) {
        failed.index.push_back(members.index[k]);
        failed.fraction.push_back(found.fraction);
        continue;
      }
      sum.cut_short = true;
    }
    sum.visible += found.visible;
    sum.whole += found.whole;
    sum.error2 += found.error.stated * found.error.stated;
  }
  return failed;
}

template <class T>
bool AdaptiveIntegrator<T>::isSpent(Index member, const VisibleFraction& so_far) const {
  constexpr bool kMany = std::is_same_v<T, double>;
  const std::size_t most = kMany && looks_ < most_looks_ ? kMostLooks : kMostSingleLooks;
  return so_far.points > most / blockersOf(member);
}

/// Fills sums_ by a rule of side x side points.
template <class T>
void AdaptiveIntegrator<T>::sumCell(const SampleCell& cell, std::size_t side, int level,
                                    const Members& members, std::span<VisibleFraction> out) {
  const SamplePoints points = cell.points(side);
  chosen_.clear();
  for (const Index m : members.index) chosen_.push_back(&targets_[m]);
  view_.look(points.all(), cell.middle(), normal_, chosen_, far_);
  const double area = cell.area();
  sums_.assign(members.index.size(), CellSum());
  for (std::size_t k = 0; k < members.index.size(); ++k) {
    VisibleFraction& pair = out[members.index[k]];
    pair.points += points.count;
    looks_ += points.count * blockersOf(members.index[k]);
    CellSum& sum = sums_[k];
    for (std::size_t q = 0; q < points.count; ++q) {
      sum.visible += points.point[q].weight * double(view_.visible(q)[k]);
      sum.whole += points.point[q].weight * double(view_.whole(q)[k]);
    }
    if (!(area > 0)) sum.whole = 0;  // it stands for nothing
    if (!(sum.whole > 0)) continue;
    sum.fraction = members.fraction.empty() ? sum.visible / sum.whole : members.fraction[k];
    CellValues values;
    values.count = points.count;
    values.whole = sum.whole / area;
    values.fraction = sum.visible / sum.whole;
    values.may_cross = pair.may_cross;
    values.one_occluder = pair.one_occluder;
    values.side = std::ldexp(1.0, -level);
    values.change = changeIn(level, pair.change);
    for (std::size_t q = 0; q < points.count; ++q) {
      values.residual[q] = double(view_.visible(q)[k]) - sum.fraction * double(view_.whole(q)[k]);
      values.one_shape &= view_.shape(q)[k] == view_.shape(0)[k];
    }
    const CellError mean = meanError(values);
    sum.error = {area * mean.cautious, area * mean.stated};
    sum.uncertain = values.one_shape || values.flat();
  }
}

/// Whether shadows may come and go as a step within a whole element: what hides all of the target
/// from a strip of it fits between all points, those near the corners included. Its quarters are
/// looked from, too, before any are believed. (Crossing sheets and columns, 100 to 150 patches,
/// 1e-3: 13 points missed 7% and 13% of pairs and stated .7% and 1.7%. It takes .4 to 2% more
/// points, and 12% past columns.)
template <class T>
bool AdaptiveIntegrator<T>::isStep(const VisibleFraction& sum, std::size_t side, double share) {
  return side == 3 && share == 1 && sum.change > kMostChange;
}

/// Looks from near a cell's corners, too, for members of which something may have slipped between
/// its points. 2 x 2: near targets. (Between columns, an element's four points saw all of a near
/// target, of which its corner saw nothing: 31% of the pair.) 3 x 3: those whose error nears or
/// exceeds what is accepted or whose shadows may end in a step.
template <class T>
void AdaptiveIntegrator<T>::lookOutside(const SampleCell& cell, std::size_t side, double share,
                                        const Members& members, std::span<VisibleFraction> out) {
  uncertain_.clear();
  chosen_.clear();
  const auto exceeds = [&](Index k, double part) {
    const CellSum& sum = sums_[k];
    return sum.error.cautious > part * share * out[members.index[k]].allowed * sum.whole;
  };
  for (Index k = 0; k < members.index.size(); ++k) {
    const VisibleFraction& sum = out[members.index[k]];
    const bool doubtful = side == 2 ? sum.near : sum.may_cross || exceeds(k, kPairDoubtful);
    if (!sums_[k].uncertain || !doubtful) continue;
    if (exceeds(k, 1) && isStep(sum, side, share)) continue;
    uncertain_.push_back(k);
    chosen_.push_back(&targets_[members.index[k]]);
  }
  if (uncertain_.empty()) return;
  const SamplePoints points = cell.outerPoints();
  view_.look(points.all(), cell.middle(), normal_, chosen_, far_);
  const double area = cell.area();
  for (std::size_t u = 0; u < uncertain_.size(); ++u) {
    CellSum& sum = sums_[uncertain_[u]];
    out[members.index[uncertain_[u]]].points += points.count;
    double largest = 0;
    for (std::size_t q = 0; q < points.count; ++q) {
      const double whole = double(view_.whole(q)[u]);
      const double residual = double(view_.visible(q)[u]) - sum.visible / sum.whole * whole;
      largest = std::max(largest, std::abs(residual));
    }
    const CellError seen = meanErrorOutside(sum.error, area * largest);
    // An error that was accepted is only ever raised.
    if (exceeds(uncertain_[u], 1) || seen.cautious > sum.error.cautious) sum.error = seen;
  }
}

/// Integrates over one cell by 3 x 3 points, or over its four parts for members that need it.
template <class T>
void AdaptiveIntegrator<T>::cutCell(const SampleCell& cell, const Members& members, int level,
                                    std::span<VisibleFraction> out) {
  for (const Index m : members.index) out[m].refined = true;
  const Members again = integrateCell(cell, 3, level, members, out);
  if (again.index.empty()) return;
  for (std::size_t c = 0; c < 4; ++c) cutCell(cell.child(c), again, level + 1, out);
}

template class AdaptiveIntegrator<float>;
template class AdaptiveIntegrator<double>;

}  // namespace radiosity
