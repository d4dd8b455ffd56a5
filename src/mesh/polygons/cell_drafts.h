// Polygons that are being built from visible cells.
#pragma once

#include <vector>

#include "mesh/arrangement/arrangement.h"
#include "mesh/bodies/classify.h"
#include "mesh/polygons/complex.h"

namespace radiosity {

/// The inputs of merging.
struct CellsToMerge {
  const InputFaces& input;
  const std::vector<Plane>& planes;
  const std::vector<Sheet>& sheets;
  const EdgeTable& edges;
  const Arrangement& arrangement;
  const std::vector<VisibleCell>& visible;
};

/// Two visible cells may become one polygon only if all members are equal.
struct DraftKind {
  Index surface = kNone;
  bool up = true;        ///< the polygon's front is above the plane
  bool both = false;     ///< its back is kept, too
  Index behind = kNone;  ///< surface of another polygon on the other side

  bool operator==(const DraftKind&) const = default;
};

/// A polygon that is being built.
struct Draft {
  Index plane = kNone;
  DraftKind kind;
  std::vector<Index> records;
  std::vector<Index> border;  ///< edges with the polygon on one side
  std::vector<bool> on_left;  ///< by border edge
  std::vector<Index> inner;   ///< edges with the polygon on both sides, which other planes meet
  std::vector<std::vector<Index>> loops;
};

/// All polygons that are being built. A record is one of the visible cells; a cell whose two sides
/// belong to two polygons is two records.
struct Drafts {
  std::vector<std::vector<Index>> records;  ///< by cell, into visible
  std::vector<Index> draft_of;              ///< by record
  std::vector<Draft> list;
  std::vector<Index> needed;         ///< edges of any polygon
  std::vector<Index> needed_number;  ///< by edge: place in needed

  const std::vector<Index>& recordsOf(Index cell) const {
    static const std::vector<Index> kNothing;
    return cell == kNone ? kNothing : records[cell];
  }
};

/// Makes the drafts without loops: straightenDrafts() traces those.
Drafts draftsOf(const CellsToMerge& cells);

}  // namespace radiosity
