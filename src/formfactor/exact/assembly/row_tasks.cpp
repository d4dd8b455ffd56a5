#include "formfactor/exact/assembly/row_tasks.h"

#include <algorithm>

namespace radiosity {
namespace {

/// A task's rows, dense, take no more bytes than this, if they are more than 8.
constexpr std::size_t kPanelBytes = std::size_t(1) << 24;
/// A task has no more rows than this. It has many, because one answer of the descent serves all
/// rows of a cluster, and clipping is fastest with pairs by the thousand; both gain more than rows
/// kept in the second-level cache would.
constexpr std::size_t kMostRows = 64;
/// Long enough to fill vectors, short enough that few values are computed for nothing.
constexpr Index kChunk = 32;

/// Even a small scene is to give every thread several tasks.
constexpr std::size_t kLeastTasks = 48;
/// The same for rows that lead, which may be all that are asked for: there are often few.
constexpr std::size_t kLeastLeadingTasks = 16;

std::size_t rowsPerTask(const ElementSet& elements) {
  const std::size_t held = kPanelBytes / (sizeof(double) * (elements.size() + 1));
  return std::clamp<std::size_t>(std::min(elements.patch_elements / kLeastTasks, held), 8,
                                 kMostRows);
}

/// The most rows of a task that begins with this element.
std::size_t mostRows(const ElementSet& elements, Index first, std::size_t most) {
  if (first >= elements.leading_elements) return most;
  return std::clamp<std::size_t>(elements.leading_elements / kLeastLeadingTasks, 1, most);
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
  const std::size_t most = rowsPerTask(elements);
  for (const Facet& facet : elements.facets) {
    if (facet.black) continue;
    appendRanges(elements, facet.root, mostRows(elements, facet.elements.first, most), ranges_);
  }
  offset_.push_back(0);
  std::size_t rows = 0;
  for (std::size_t r = 0; r < ranges_.size(); ++r) {
    rows += ranges_[r].size();
    const Index end = ranges_[r].end;
    const bool last = r + 1 == ranges_.size();
    // A patch of several elements may lie in several clusters.
    const bool cuts_patch = !last && elements.patch[end - 1] == elements.patch[end];
    // Rows that lead share no task with others, which nobody may have asked for.
    const bool full = last || end == elements.leading_elements ||
                      rows + ranges_[r + 1].size() > mostRows(elements, ranges_[r].first, most);
    if (full && !cuts_patch) {
      offset_.push_back(r + 1);
      rows = 0;
    }
  }
}

std::size_t RowTasks::panelBytes(const ElementSet& elements) const {
  std::size_t rows = 0;
  for (std::size_t t = 0; t < size(); ++t) {
    rows = std::max<std::size_t>(rows, (*this)[t].back().end - (*this)[t].front().first);
  }
  return rows * elements.size() * (sizeof(double) + 1);
}

ColumnChunks::ColumnChunks(const ElementSet& elements) : of_element(elements.size()) {
  for (const Facet& facet : elements.facets) {
    for (Index e = facet.elements.first; e < facet.elements.end; ++e) {
      if ((e - facet.elements.first) % kChunk == 0) {
        ranges.push_back({e, std::min(e + kChunk, facet.elements.end)});
      }
      of_element[e] = Index(ranges.size() - 1);
    }
  }
}

}  // namespace radiosity
