#include "formfactor/exact/visibility/visibility.h"

#include <algorithm>

#include "formfactor/exact/visibility/descent.h"

namespace radiosity {
namespace {

ShapeCorners shapeOf(const std::array<Vec3, 4>& corners) {
  ShapeCorners shape{};
  for (std::size_t k = 0; k < 4; ++k) {
    shape.x[k] = corners[k].x;
    shape.y[k] = corners[k].y;
    shape.z[k] = corners[k].z;
  }
  return shape;
}

/// The largest clusters below `cluster` that lie in `rows`.
template <class Visit>
void forClusters(const ElementSet& elements, Index cluster, ElementRange rows, const Visit& visit) {
  const Cluster& node = elements.clusters[cluster];
  if (node.elements.end <= rows.first || node.elements.first >= rows.end) return;
  if (rows.first <= node.elements.first && node.elements.end <= rows.end) {
    visit(cluster);
    return;
  }
  for (Index c = 0; c < node.child_count; ++c) {
    forClusters(elements, node.first_child + c, rows, visit);
  }
}

}  // namespace

VisibilityCounts& VisibilityCounts::operator+=(const VisibilityCounts& other) {
  no_exchange += other.no_exchange;
  unoccluded += other.unoccluded;
  hidden += other.hidden;
  occluded += other.occluded;
  facet_pairs += other.facet_pairs;
  facet_pairs_no_exchange += other.facet_pairs_no_exchange;
  facet_pairs_unoccluded += other.facet_pairs_unoccluded;
  shaft_tests += other.shaft_tests;
  return *this;
}

Visibility::Visibility(const ElementSet& elements, const OccluderSet& occluders, bool simd)
    : elements_(elements),
      occluders_(occluders),
      tree_(occluders.occluders),
      kernels_(visibilityKernels(simd)),
      own_(elements.facets.size()) {
  for (const Cluster& cluster : elements.clusters) {
    const bool leaf = cluster.child_count == 0;
    shapes_.push_back(shapeOf(leaf ? elements.corners[cluster.elements.first] : cluster.bounds));
  }
  for (Index f = 0; f < elements.facets.size(); ++f) {
    if (!occluders.hidden_facets[f]) open_facets_.push_back(f);
  }
  for (Index o = 0; o < occluders.occluders.size(); ++o) {
    for (const Index f : occluders.occluders[o].facets) own_[f].push_back(o);
  }
  open_after_.resize(open_facets_.size() + 1);
  large_after_ = open_after_;
  for (std::size_t k = open_facets_.size(); k > 0; --k) {
    const Facet& facet = elements.facets[open_facets_[k - 1]];
    const auto added = [&](const Open& to) {
      return Open{to.facets + 1, to.elements + facet.elements.size()};
    };
    open_after_[k - 1] = added(open_after_[k]);
    large_after_[k - 1] = isLarge(facet) ? added(large_after_[k]) : large_after_[k];
  }
}

void Visibility::classify(ElementRange rows, VisibilitySink& sink, VisibilityCounts& counts) const {
  if (rows.size() == 0) return;
  const Index facet = elements_.facet[rows.first];
  const ElementRange own = elements_.facets[facet].elements;
  for (Index r = rows.first; r < rows.end; ++r) counts.no_exchange += own.end - 1 - r;
  const std::size_t columns = elements_.size() - own.end;
  const std::size_t facets = elements_.facets.size() - 1 - facet;
  if (occluders_.hidden_facets[facet]) {
    counts.no_exchange += rows.size() * columns;
    counts.facet_pairs += facets;
    counts.facet_pairs_no_exchange += facets;
    return;
  }
  // Sealed facets are settled without a look at each.
  const std::size_t closed = facets - openFacetsAfter(rows);
  counts.no_exchange += rows.size() * columns - openPairs(rows);
  counts.facet_pairs += closed;
  counts.facet_pairs_no_exchange += closed;
  VisibilityDescent descent(*this, sink, counts);
  forClusters(elements_, elements_.facets[facet].root, rows,
              [&](Index cluster) { descent.run(facet, cluster); });
}

VisibilityOfFacets Visibility::classifySome(ElementRange rows, const VisibilitySample& sample,
                                            VisibilitySink& sink, VisibilityCounts& counts) const {
  if (openFacetsAfter(rows) == 0) return {};
  const Index facet = elements_.facet[rows.first];
  VisibilityDescent descent(*this, sink, counts, sample);
  forClusters(elements_, elements_.facets[facet].root, rows,
              [&](Index cluster) { descent.run(facet, cluster); });
  return descent.ofFacets();
}

Visibility::Open Visibility::openAfter(ElementRange rows, FacetSize size) const {
  const Index facet = elements_.facet[rows.first];
  if (occluders_.hidden_facets[facet]) return {};
  const auto next = std::upper_bound(open_facets_.begin(), open_facets_.end(), facet);
  const auto k = std::size_t(next - open_facets_.begin());
  const Open& any = open_after_[k];
  const Open& large = large_after_[k];
  if (size == FacetSize::any) return any;
  if (size == FacetSize::large) return large;
  return {any.facets - large.facets, any.elements - large.elements};
}

std::size_t Visibility::openFacetsAfter(ElementRange rows, FacetSize size) const {
  return openAfter(rows, size).facets;
}

std::size_t Visibility::openPairs(ElementRange rows, FacetSize size) const {
  return rows.size() * openAfter(rows, size).elements;
}

}  // namespace radiosity
