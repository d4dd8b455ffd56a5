// The edges of one sheet by rows of its plane's image, so that a search at a place only tests the
// edges in its row.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/plane_image.h"
#include "mesh/welded_points.h"

namespace radiosity {

class EdgeRows {
 public:
  /// An edge belongs to all rows within `margin` metres. Rows are so narrow that each holds few
  /// edges, but wide enough that an edge is only in a few rows.
  EdgeRows(const WeldedPoints& points, const PlaneImage& image,
           const std::vector<std::array<Index, 2>>& edges, double margin);

  /// Numbers of the edges near a row's part of the image, ascending.
  std::span<const Index> at(double y) const;
  /// Numbers of all edges in the rows from `low` to `high`, ascending, each once.
  std::vector<Index> between(double low, double high) const;

 private:
  std::size_t row(double y) const;

  double low_ = 0;
  double rows_per_metre_ = 0;
  std::vector<std::size_t> begin_;  ///< rows + 1, into edges_
  std::vector<Index> edges_;
};

}  // namespace radiosity
