#include "formfactor/exact/row_tasks.h"

#include <algorithm>

namespace radiosity {
namespace {

/// Rows of a task: many enough that what a cluster is asked once serves many rows, few enough that
/// even a small scene gives every thread several.
std::size_t rowsPerTask(std::size_t elements) {
  return std::clamp<std::size_t>(elements / 48, 8, 64);
}

void appendRanges(const ElementSet& elements, Index node, std::size_t most,
                  std::vector<ElementRange>& ranges) {
  const Cluster& cluster = elements.clusters[node];
  if (cluster.elements.size() <= most || cluster.child_count == 0) {
    ranges.push_back(cluster.elements);
    return;
  }
  for (Index k = 0; k < cluster.child_count; ++k) {
    appendRanges(elements, cluster.first_child + k, most, ranges);
  }
}

}  // namespace

RowTasks::RowTasks(const ElementSet& elements) {
  const std::size_t most = rowsPerTask(elements.patch_elements);
  for (const Facet& facet : elements.facets) {
    if (!facet.bare) appendRanges(elements, facet.root, most, ranges_);
  }
  offset_.push_back(0);
  std::size_t rows = 0;
  for (std::size_t r = 0; r < ranges_.size(); ++r) {
    rows += ranges_[r].size();
    const Index end = ranges_[r].end;
    const bool last = r + 1 == ranges_.size();
    // A patch of several elements may lie in several clusters.
    const bool cuts_patch = !last && elements.patch[end - 1] == elements.patch[end];
    const bool full = last || rows + ranges_[r + 1].size() > most;
    if (full && !cuts_patch) {
      offset_.push_back(r + 1);
      rows = 0;
    }
  }
}

}  // namespace radiosity
