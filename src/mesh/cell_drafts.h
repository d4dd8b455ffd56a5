// Planar polygons in the making: visible cells that go together.
#pragma once

#include <vector>

#include "mesh/arrangement.h"
#include "mesh/classify.h"
#include "mesh/complex.h"

namespace radiosity {

/// What polygons are made of.
struct CellsToMerge {
  const InputFaces& input;
  const std::vector<Plane>& planes;
  const std::vector<Sheet>& sheets;
  const EdgeTable& edges;
  const Arrangement& arrangement;
  const std::vector<VisibleCell>& visible;
};

/// Two visible cells may become one polygon only if they are equal in all of this.
struct DraftKind {
  Index surface = kNone;
  bool up = true;        ///< the polygon's front is above the plane
  bool both = false;     ///< and its back is kept too
  Index behind = kNone;  ///< surface of another polygon on the other side

  bool operator==(const DraftKind&) const = default;
};

/// A polygon in the making.
struct Draft {
  Index plane = kNone;
  DraftKind kind;
  std::vector<Index> records;
  std::vector<Index> border;  ///< edges with the polygon on one side
  std::vector<bool> on_left;  ///< by border edge
  std::vector<Index> inner;   ///< edges with the polygon on both sides, met by another plane's
  std::vector<std::vector<Index>> loops;
};

/// All of them. A record is one of the visible cells; a cell whose two sides are of two polygons is
/// two records.
struct Drafts {
  std::vector<std::vector<Index>> records;  ///< by cell, into visible
  std::vector<Index> draft_of;              ///< by record
  std::vector<Draft> list;
  std::vector<Index> needed;         ///< edges of some polygon
  std::vector<Index> needed_number;  ///< by edge: place in needed

  const std::vector<Index>& recordsOf(Index cell) const {
    static const std::vector<Index> kNothing;
    return cell == kNone ? kNothing : records[cell];
  }
};

/// Without loops: straightenDrafts() traces them.
Drafts draftsOf(const CellsToMerge& cells);

}  // namespace radiosity
