#include "formfactor/exact/visibility/descent.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {

VisibilityDescent::VisibilityDescent(const Visibility& visibility, VisibilitySink& sink,
                                     VisibilityCounts& counts, const VisibilitySample& sample)
    : visibility_(visibility),
      elements_(visibility.elements_),
      sink_(sink),
      counts_(counts),
      sample_(sample) {}

std::size_t VisibilityDescent::pairs(Index row, Index column) const {
  return std::size_t(elements_.clusters[row].elements.size()) *
         elements_.clusters[column].elements.size();
}

VisibilityDescent::Horizon VisibilityDescent::horizon(const Facet& facet, Index cluster) const {
  const ShapeCorners& shape = visibility_.shapes_[cluster];
  double lowest = 0;
  double highest = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double h = facet.normal.x * shape.x[k] + facet.normal.y * shape.y[k] +
                     facet.normal.z * shape.z[k] - facet.offset;
    lowest = k == 0 ? h : std::min(lowest, h);
    highest = k == 0 ? h : std::max(highest, h);
  }
  if (highest <= elements_.coincidence) return Horizon::kBelow;
  return lowest >= -elements_.coincidence ? Horizon::kAbove : Horizon::kAcross;
}

void VisibilityDescent::run(Index facet, Index cluster) {
  facet_ = facet;
  top_ = cluster;
  items_.clear();
  dropCandidates(0);
  const std::vector<Index>& open = visibility_.open_facets_;
  const auto after = std::upper_bound(open.begin(), open.end(), facet) - open.begin();
  const VisibilityCounts before = counts_;
  std::size_t left = sample_.first_facet;  // until the next
  for (auto k = std::size_t(after); k < open.size() && !enough(); ++k) {
    const bool large = isLarge(elements_.facets[open[k]]);
    if (sample_.size == (large ? FacetSize::small : FacetSize::large)) continue;
    if (left-- > 0) continue;
    addFacet(open[k]);
    left = sample_.facet_stride - 1;
  }
  noteFacets(before);
  settled_before_ = counts_.settled();
  descend(cluster, 0, 0, items_.size());
}

void VisibilityDescent::noteFacets(const VisibilityCounts& before) {
  VisibilityCounts& settled = of_facets_.settled;
  settled.no_exchange += counts_.no_exchange - before.no_exchange;
  settled.unoccluded += counts_.unoccluded - before.unoccluded;
  settled.shaft_tests += counts_.shaft_tests - before.shaft_tests;
  for (const Item& item : items_) of_facets_.left += pairs(top_, item.cluster);
}

/// Settles a facet by the planes, or if nothing is in between; else it becomes an item.
void VisibilityDescent::addFacet(Index facet) {
  sink_.poll();
  ++counts_.facet_pairs;
  const Facet& own = elements_.facets[facet_];
  const Facet& other = elements_.facets[facet];
  const Horizon column = horizon(own, other.root);
  const Horizon row = column == Horizon::kBelow ? Horizon::kBelow : horizon(other, top_);
  if (column == Horizon::kBelow || row == Horizon::kBelow) {
    ++counts_.facet_pairs_no_exchange;
    counts_.no_exchange += pairs(top_, other.root);
    return;
  }
  const Cluster& a = elements_.clusters[top_];
  const Cluster& b = elements_.clusters[other.root];
  Item item{other.root, Index(candidates_.size()), 0, column == Horizon::kAbove,
            row == Horizon::kAbove};
  visibility_.tree_.query(
      {a.centre, a.radius}, {b.centre, b.radius}, {own.normal, own.offset + elements_.coincidence},
      {other.normal, other.offset + elements_.coincidence}, candidates_, counts_.shaft_tests);
  const auto first = candidates_.begin() + item.first_candidate;
  const auto lies_on = [&](Index o) {
    const std::vector<Index>& mine = visibility_.own_[facet_];
    const std::vector<Index>& its = visibility_.own_[facet];
    return std::binary_search(mine.begin(), mine.end(), o) ||
           std::binary_search(its.begin(), its.end(), o);
  };
  candidates_.erase(std::remove_if(first, candidates_.end(), lies_on), candidates_.end());
  std::sort(candidates_.begin() + item.first_candidate, candidates_.end());
  item.end_candidate = Index(candidates_.size());
  open_planes_.resize(candidates_.size(), ShadowPlanes::kAllPlanes);
  if (item.first_candidate == item.end_candidate) {
    ++counts_.facet_pairs_unoccluded;
    counts_.unoccluded += pairs(top_, other.root);
    sink_.unoccluded(a.elements, b.elements);
    return;
  }
  items_.push_back(item);
}

ShadowPlanes& VisibilityDescent::shadow(Index row, std::size_t depth, Index occluder) {
  Level& level = levels_[depth];
  Index& slot = level.slot[occluder];
  if (slot == kNone) {
    slot = Index(level.used.size());
    level.used.push_back(occluder);
    if (level.shadows.size() <= slot) level.shadows.emplace_back();
    level.shadows[slot].build(visibility_.shapes_[row], visibility_.occluders_.occluders[occluder],
                              elements_.coincidence);
  }
  return level.shadows[slot];
}

/// Settles the items that can be settled at this row cluster; the rest is for its children.
void VisibilityDescent::descend(Index row, std::size_t depth, std::size_t first_item,
                                std::size_t end_item) {
  if (first_item == end_item) return;
  if (levels_.size() <= depth) {
    levels_.emplace_back();
    levels_.back().slot.assign(visibility_.occluders_.occluders.size(), kNone);
  }
  const std::size_t first_left = items_.size();
  const std::size_t first_candidate = candidates_.size();
  for (std::size_t k = first_item; k < end_item; ++k) settle(row, depth, items_[k]);
  for (const Index o : levels_[depth].used) levels_[depth].slot[o] = kNone;
  levels_[depth].used.clear();
  const Cluster& cluster = elements_.clusters[row];
  const std::size_t end_left = items_.size();
  for (Index c = 0; c < cluster.child_count; ++c) {
    descend(cluster.first_child + c, depth + 1, first_left, end_left);
  }
  items_.resize(first_left);
  dropCandidates(first_candidate);
}

/// Settles an item by the horizon, then by candidates. Columns larger than the rows are split,
/// others left to the row's children.
void VisibilityDescent::settle(Index row, std::size_t depth, Item item) {
  if (enough() && hasSettledSome()) return;
  sink_.poll();
  const Cluster& rows = elements_.clusters[row];
  const Cluster& columns = elements_.clusters[item.cluster];
  if (!meets(row, item)) {
    counts_.no_exchange += pairs(row, item.cluster);
    return;
  }
  if (!thinOut(row, depth, item)) return;
  if (item.first_candidate == item.end_candidate) {
    counts_.unoccluded += pairs(row, item.cluster);
    sink_.unoccluded(rows.elements, columns.elements);
    return;
  }
  const bool row_is_leaf = rows.child_count == 0;
  const bool column_is_leaf = columns.child_count == 0;
  if (row_is_leaf && column_is_leaf) {
    ++counts_.occluded;
    sink_.occluded(rows.elements.first, columns.elements.first,
                   {candidates_.data() + item.first_candidate,
                    std::size_t(item.end_candidate - item.first_candidate)});
    return;
  }
  if (!column_is_leaf && (row_is_leaf || columns.radius > rows.radius)) {
    for (Index c = 0; c < columns.child_count; ++c) {
      Item child = item;
      child.cluster = columns.first_child + c;
      settle(row, depth, child);
    }
    return;
  }
  // Each child of the row cluster has planes of its own.
  std::fill(open_planes_.begin() + item.first_candidate, open_planes_.begin() + item.end_candidate,
            ShadowPlanes::kAllPlanes);
  items_.push_back(item);
}

/// False if the pair is below one or the other horizon.
bool VisibilityDescent::meets(Index row, Item& item) {
  if (!item.column_above) {
    const Horizon column = horizon(elements_.facets[facet_], item.cluster);
    if (column == Horizon::kBelow) return false;
    item.column_above = column == Horizon::kAbove;
  }
  if (!item.row_above) {
    const Index first = elements_.clusters[item.cluster].elements.first;
    const Horizon rows = horizon(elements_.facets[elements_.facet[first]], row);
    if (rows == Horizon::kBelow) return false;
    item.row_above = rows == Horizon::kAbove;
  }
  return true;
}

bool VisibilityDescent::thinOut(Index row, std::size_t depth, Item& item) {
  const ShapeCorners& columns = visibility_.shapes_[item.cluster];
  const Index first_kept = Index(candidates_.size());
  for (Index k = item.first_candidate; k < item.end_candidate; ++k) {
    const Index o = candidates_[k];
    ShadowPlanes::Planes open = open_planes_[k];
    ++counts_.shaft_tests;
    const ShadowRelation relation =
        shadow(row, depth, o).relation(visibility_.kernels_, columns, open);
    if (relation == ShadowRelation::kInside) {
      counts_.hidden += pairs(row, item.cluster);
      dropCandidates(first_kept);
      return false;
    }
    if (relation == ShadowRelation::kUnclear) addCandidate(o, open);
  }
  item.first_candidate = first_kept;
  item.end_candidate = Index(candidates_.size());
  return true;
}

}  // namespace radiosity
