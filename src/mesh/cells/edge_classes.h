// Classes of edges that are cut alike, so that quadrilaterals between them can become grids.
#pragma once

#include <vector>

#include "base/union_find.h"

namespace radiosity {

/// Classes of edges. Every edge has a direction of its own; within a class each runs the same way
/// as the class or the opposite way.
class EdgeClasses {
 public:
  explicit EdgeClasses(const std::vector<double>& lengths)
      : sets_(lengths.size()),
        joined_(lengths.size()),
        shortest_(lengths),
        longest_(lengths),
        opposed_(lengths.size(), 0),
        twisted_(lengths.size(), 0) {}

  /// Puts two edges into one class, unless lengths in the class would then differ by more than a
  /// factor of two: along a chain of narrowing quadrilaterals (the rings of a sphere) one end would
  /// become far too fine.
  void join(Index a, Index b, bool opposed);

  /// Finds directions. Call once, after all joins.
  void orient();

  Index of(Index edge) { return sets_.find(edge); }
  double longest(Index cls) const { return longest_[cls]; }
  bool opposed(Index edge) const { return opposed_[edge] != 0; }
  /// Whether an edge is joined to itself in reverse (a Moebius strip): then cuts must be symmetric.
  bool twisted(Index cls) const { return twisted_[cls] != 0; }

 private:
  struct Join {
    Index edge;
    bool opposed;
  };
  UnionFind sets_;
  std::vector<std::vector<Join>> joined_;
  std::vector<double> shortest_;  ///< by class
  std::vector<double> longest_;   ///< by class
  std::vector<char> opposed_;
  std::vector<char> twisted_;  ///< by class
};

}  // namespace radiosity
