// Rows and columns of the matrix cut into pieces of work.
#pragma once

#include <span>
#include <vector>

#include "visibility/elements/elements.h"

namespace radiosity {

/// Consecutive ranges of elements, each a cluster's of one facet that carries patches, grouped into
/// tasks of similar size. All elements of a patch are in one task. Depends on the elements alone.
class RowTasks {
 public:
  explicit RowTasks(const ElementSet& elements);
  std::size_t size() const { return offset_.size() - 1; }
  std::span<const ElementRange> operator[](std::size_t task) const {
    return {ranges_.data() + offset_[task], offset_[task + 1] - offset_[task]};
  }
  /// Bytes that one task's rows take while they are made, at most.
  std::size_t panelBytes(const ElementSet& elements) const;

 private:
  std::vector<ElementRange> ranges_;
  std::vector<std::size_t> offset_;  ///< tasks + 1, into ranges_
};

/// The elements cut into short runs of neighbours, each of one facet: closed forms are asked for by
/// whole runs.
struct ColumnChunks {
  explicit ColumnChunks(const ElementSet& elements);
  std::vector<ElementRange> ranges;
  std::vector<Index> of_element;  ///< E, into ranges
};

}  // namespace radiosity
