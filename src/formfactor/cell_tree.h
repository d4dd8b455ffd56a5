// The part of patches inside one grid cell, and the tree of lines that tells them apart.
#pragma once

#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A line in a grid's coordinates: points with a u + b v + c >= 0 go on to `inside`, others to
/// `outside`. A child >= 0 is an item, a child < 0 is the node ~child.
struct CellNode {
  double a, b, c;
  std::int32_t inside;
  std::int32_t outside;
};

/// The part of a convex piece inside a cell, in the grid's coordinates.
struct CellPart {
  std::vector<Vec2> corners;
  std::int32_t item;
};

/// Keeps the part of a convex polygon where a x + b y + c >= 0.
std::vector<Vec2> clipConvex(const std::vector<Vec2>& polygon, double a, double b, double c);

/// Appends to `nodes` a tree that tells the parts (one or more) apart and returns its root: an
/// item, or ~(index of a node). Where parts overlap, the first wins.
std::int32_t buildCellTree(std::vector<CellPart> parts, std::vector<CellNode>& nodes);

}  // namespace radiosity
