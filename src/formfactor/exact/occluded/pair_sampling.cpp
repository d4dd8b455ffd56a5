#include "formfactor/exact/occluded/pair_sampling.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "formfactor/exact/error_model.h"
#include "formfactor/exact/occluded/occluded_pairs.h"

namespace radiosity {
namespace {

/// Entries of EdgeDistances' table: 64 MiB.
constexpr std::size_t kMostDistances = std::size_t(1) << 24;

/// Squares of changes that differ by less are alike: in symmetric scenes many are equal, and which
/// end is sampled must not depend on how distances, in single precision, are rounded.
constexpr double kAlike = 1 + 1e-5;

/// Bodies with more faces than these are not tested for being thin.
constexpr std::size_t kMostThinPlanes = 16;

struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
};

template <class Plane>
Extent heightsOver(std::span<const Vec3> points, const Plane& plane) {
  Extent h;
  for (const Vec3& p : points) {
    const double d = glm::dot(plane.normal, p) - plane.offset;
    h.least = std::min(h.least, d);
    h.most = std::max(h.most, d);
  }
  return h;
}

/// Adds the part of a segment within `width` of a plane to its extent along a direction.
template <class Plane>
void addPartNear(const Plane& plane, double width, const Vec3& a, const Vec3& b, const Vec3& along,
                 Extent& extent) {
  const double from = glm::dot(plane.normal, a) - plane.offset;
  const double rise = glm::dot(plane.normal, b) - plane.offset - from;
  if (rise == 0 && std::abs(from) > width) return;
  const double lower = rise == 0 ? 0.0 : (-width - from) / rise;
  const double upper = rise == 0 ? 1.0 : (width - from) / rise;
  const double first = std::max(0.0, std::min(lower, upper));
  const double last = std::min(1.0, std::max(lower, upper));
  if (first > last) return;
  for (const double t : {first, last}) {
    const double place = glm::dot(along, a + t * (b - a));
    extent.least = std::min(extent.least, place);
    extent.most = std::max(extent.most, place);
  }
}

double edgeDistance2(const Occluder& body, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Occluder::Edge& edge : body.edges) {
    const Vec3 a = p - body.corners[edge.from];
    const Vec3 along = body.corners[edge.to] - body.corners[edge.from];
    const double t = std::clamp(glm::dot(a, along) / glm::dot(along, along), 0.0, 1.0);
    const Vec3 d = a - along * t;
    least = std::min(least, glm::dot(d, d));
  }
  return least;
}

/// The middle plane of a body that is thin; a normal of 0 for others.
Occluder::Plane middleOfThin(const Occluder& body) {
  Occluder::Plane best;
  if (body.planes.size() > kMostThinPlanes) return best;
  double least = kPairThin * body.radius;
  for (const Occluder::Plane& plane : body.planes) {
    double low = plane.offset;
    for (const Vec3& v : body.corners) low = std::min(low, glm::dot(plane.normal, v));
    if (plane.offset - low < least) {
      least = plane.offset - low;
      best = {plane.normal, 0.5 * (plane.offset + low)};
    }
  }
  return best;
}

}  // namespace

EdgeDistances::EdgeDistances(const ElementSet& elements, const OccluderSet& occluders, bool few)
    : elements_(elements), occluders_(occluders) {
  for (const Occluder& body : occluders.occluders) thin_.push_back(middleOfThin(body));
  const std::size_t count = elements.size() * occluders.occluders.size();
  if (!few && count <= kMostDistances) table_ = std::vector<std::atomic<float>>(count);
}

bool EdgeDistances::seesEdgeOn(Index element, Index occluder) const {
  const Occluder::Plane& plane = thin_[occluder];
  if (plane.normal == Vec3(0.0)) return false;
  const double height = glm::dot(plane.normal, elements_.centroid[element]) - plane.offset;
  if (std::abs(height) >= elements_.radius[element]) return false;
  const Extent h = heightsOver(elements_.outline(element), plane);
  return h.least < elements_.coincidence && h.most > -elements_.coincidence &&
         h.most - h.least > elements_.coincidence;
}

bool EdgeDistances::isStoodOn(Index element, Index occluder) const {
  const Occluder::Plane& plane = thin_[occluder];
  if (plane.normal == Vec3(0.0)) return false;
  const double height = glm::dot(plane.normal, elements_.centroid[element]) - plane.offset;
  if (std::abs(height) >= elements_.radius[element]) return false;
  const auto outline = elements_.outline(element);
  const Extent h = heightsOver(outline, plane);
  const double narrower = std::min(-h.least, h.most);
  if (narrower <= elements_.coincidence) return false;
  const Facet& facet = elements_.facets[elements_.facet[element]];
  const Vec3 along = glm::cross(facet.normal, plane.normal);
  Extent cut;  // of the element, along the line where the planes meet
  for (std::size_t k = 0; k < outline.size(); ++k) {
    addPartNear(plane, 0, outline[k], outline[(k + 1) % outline.size()], along, cut);
  }
  Extent foot;  // of the body, as far from the element as its narrower side is wide
  const Occluder& body = occluders_.occluders[occluder];
  for (const Occluder::Edge& edge : body.edges) {
    addPartNear(facet, narrower, body.corners[edge.from], body.corners[edge.to], along, foot);
  }
  const double common = std::min(cut.most, foot.most) - std::max(cut.least, foot.least);
  return common > elements_.coincidence * glm::length(along);
}

double EdgeDistances::squared(Index element, Index occluder) const {
  // Rounded with and without a table, so that the choice does not depend on its size.
  const auto compute = [&] {
    return float(edgeDistance2(occluders_.occluders[occluder], elements_.centroid[element]));
  };
  if (table_.empty()) return compute();
  // Threads that meet here store the same value.
  std::atomic<float>& known = table_[occluder * elements_.size() + element];
  float distance = known.load(std::memory_order_relaxed);
  if (distance == 0) {
    distance = compute();
    known.store(distance, std::memory_order_relaxed);
  }
  return distance;
}

PairPreparation::PairPreparation(const ElementSet& elements, const OccluderSet& occluders,
                                 const EdgeDistances& distances)
    : elements_(elements),
      occluders_(occluders),
      distances_(distances),
      change_(elements),
      between_(occluders.occluders.size()) {}

const PairPreparation::Between& PairPreparation::between(Index occluder, Index row_facet,
                                                         Index column_facet) {
  if (row_facet != row_facet_ || column_facet != column_facet_) {
    row_facet_ = row_facet;
    column_facet_ = column_facet;
    ++stamp_;
  }
  Between& found = between_[occluder];
  if (found.stamp != stamp_) {
    const Occluder& body = occluders_.occluders[occluder];
    const Extent first = heightsOver(body.corners, elements_.facets[row_facet]);
    const Extent second = heightsOver(body.corners, elements_.facets[column_facet]);
    const double touching = elements_.coincidence;
    found = {stamp_, first.most > touching && second.most > touching, first.least < -touching,
             second.least < -touching};
  }
  return found;
}

/// Keeps the blockers of a pair, with how their shadows change; returns the least squares of the
/// distances from both ends to their edges.
BothEnds PairPreparation::addBlockers(const OccludedPair& given,
                                      std::span<const Index> occluder_list) {
  constexpr double kNoEdge = std::numeric_limits<double>::infinity();
  BothEnds nearest{kNoEdge, kNoEdge};
  const Index row_facet = elements_.facet[given.row];
  const Index column_facet = elements_.facet[given.column];
  change_.begin(given.row, given.column);
  for (std::uint32_t o = given.occluders_begin; o < given.occluders_end; ++o) {
    const Index id = occluder_list[o];
    if (!between(id, row_facet, column_facet).blocks) continue;
    const Occluder& body = occluders_.occluders[id];
    blockers.push_back({&body, id, false});
    const BothEnds near{distances_.squared(given.row, id), distances_.squared(given.column, id)};
    change_.add(body, near);
    nearest.row = std::min(nearest.row, near.row);
    nearest.column = std::min(nearest.column, near.column);
  }
  return nearest;
}

/// Squares of how shadows change over both ends of a pair, past its blockers from a number on. A
/// body seen edge-on counts before the calmer end is chosen: along that end the view dips, maybe
/// between all points, and from the other end the body is broad. (A sliver past two fins, 1e-3: all
/// points missed a dip that was 7% of the pair, with 0.1% stated.)
BothEnds PairPreparation::changes(const OccludedPair& given, std::uint32_t blockers_begin) const {
  BothEnds change2 = change_.squared();
  const auto own = std::span<const Blocker>(blockers).subspan(blockers_begin);
  if (own.size() > kPairFewBlockers) return change2;
  const auto worth = [&](Index element) {
    const auto edge_on = [&](const Blocker& b) { return distances_.seesEdgeOn(element, b.id); };
    return std::ranges::any_of(own, edge_on) ? kPairEdgeOn * kPairEdgeOn : 1;
  };
  change2.row *= worth(given.row);
  change2.column *= worth(given.column);
  return change2;
}

void PairPreparation::addPair(std::uint32_t number, const OccludedPair& given,
                              std::span<const Index> occluder_list, SampledEnd end) {
  const Index row_facet = elements_.facet[given.row];
  const Index column_facet = elements_.facet[given.column];
  const Extent row = heightsOver(elements_.outline(given.row), elements_.facets[column_facet]);
  const Extent column = heightsOver(elements_.outline(given.column), elements_.facets[row_facet]);
  const double touching = elements_.coincidence;
  if (row.most <= touching || column.most <= touching) return;
  SampledPair pair;
  pair.pair = number;
  pair.blockers_begin = std::uint32_t(blockers.size());
  const BothEnds nearest = addBlockers(given, occluder_list);
  pair.blockers_end = std::uint32_t(blockers.size());
  const double row_size = elements_.radius[given.row];
  const double column_size = elements_.radius[given.column];
  const BothEnds change2 = changes(given, pair.blockers_begin);
  const bool row_is_calmer = change2.row <= kAlike * change2.column;
  const bool at_row_end = row_is_calmer == (end == SampledEnd::calmer);
  pair.change = float(std::sqrt(at_row_end ? change2.row : change2.column));
  const double reach = at_row_end ? row_size : column_size;
  const Index sampled = at_row_end ? given.row : given.column;
  pair.may_cross = (at_row_end ? nearest.row : nearest.column) <= reach * reach;
  pair.sampled = sampled;
  const auto own = std::span<const Blocker>(blockers).subspan(pair.blockers_begin);
  pair.stood_on = std::ranges::any_of(
      own, [&](const Blocker& b) { return distances_.isStoodOn(sampled, b.id); });
  pair.target = at_row_end ? given.column : given.row;
  const bool row_cut = row.least < -touching;
  const bool column_cut = column.least < -touching;
  pair.sampled_cut = at_row_end ? row_cut : column_cut;
  pair.target_cut = at_row_end ? column_cut : row_cut;
  for (std::uint32_t b = pair.blockers_begin; b < pair.blockers_end; ++b) {
    const Between& where = between(blockers[b].id, row_facet, column_facet);
    blockers[b].cuts_target = at_row_end ? where.cuts_second : where.cuts_first;
  }
  pairs.push_back(pair);
}

/// One word a pair: comparing fields in three arrays would take longer than clipping.
void PairPreparation::sortPairs() {
  order_.clear();
  for (std::uint32_t k = 0; k < pairs.size(); ++k) {
    const SampledPair& p = pairs[k];
    order_.push_back({std::uint64_t(p.sampled) << 32 | std::uint64_t(p.sampled_cut) << 31, k});
    // Uncut ones first; cut ones by target, and so by its facet.
    order_.back().key |= p.target;
  }
  std::sort(order_.begin(), order_.end(),
            [](const SortedPair& a, const SortedPair& b) { return a.key < b.key; });
  sorted_.clear();
  for (const SortedPair& place : order_) sorted_.push_back(pairs[place.pair]);
  pairs.swap(sorted_);
}

void PairPreparation::prepare(std::span<const OccludedPair> batch,
                              std::span<const Index> occluder_list, SampledEnd end) {
  pairs.clear();
  blockers.clear();
  for (std::uint32_t k = 0; k < batch.size(); ++k) addPair(k, batch[k], occluder_list, end);
  sortPairs();
}

std::vector<Vec3> partInFront(const ElementSet& elements, Index element, const Facet& facet) {
  const std::span<const Vec3> outline = elements.outline(element);
  // A corner that touches the plane is on it: a cut beside it would leave a sliver as wide as
  // rounding, over which no rule can average.
  const auto height = [&](const Vec3& p) {
    const double d = glm::dot(facet.normal, p) - facet.offset;
    return std::abs(d) <= elements.coincidence ? 0.0 : d;
  };
  std::vector<Vec3> part;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec3& p = outline[k];
    const Vec3& q = outline[(k + 1) % outline.size()];
    const double at_p = height(p);
    const double at_q = height(q);
    if (at_p >= 0) part.push_back(p);
    if (at_p * at_q < 0) part.push_back(p + (q - p) * (at_p / (at_p - at_q)));
  }
  return part;
}

}  // namespace radiosity
