// Putting things together that lie near each other and face alike, the cheapest pair first.
#pragma once

#include <span>
#include <vector>

#include "base/union_find.h"
#include "radiosity/base.h"

namespace radiosity {

/// A planar piece of a surface, and what pieces put together are: sums over pieces.
struct Agglomerate {
  double area = 0;
  Vec3 moment{0.0};   ///< area times centroid
  Vec3 normals{0.0};  ///< area times normal

  Agglomerate& operator+=(const Agglomerate& other) {
    area += other.area;
    moment += other.moment;
    normals += other.normals;
    return *this;
  }
};

/// Greedy agglomeration by Ward's criterion ("Hierarchical Grouping to Optimize an Objective
/// Function", J. Am. Stat. Assoc. 58, 1963) in six dimensions, centroid and `bend` times normal,
/// with areas as weights: what putting I and J together adds to the area-weighted squares is
///
///     A_I A_J / (A_I + A_J) * (|c_I - c_J|^2 + bend^2 |n_I - n_J|^2).
///
/// Pairs stand in a heap by this cost. One whose cost has risen since is put back; one whose cost
/// has fallen is taken when its turn comes. No lists of neighbours are kept: where run() is called
/// for half as many each time, pairs are as many as wholes, and all takes n log n. Ties go by
/// number: the first, then the second of the pair.
class Agglomeration {
 public:
  /// `unit`: a length that costs are of the order of, so that they fit into 32 bits.
  Agglomeration(std::vector<Agglomerate> pieces, double bend, double unit);

  /// Two that may be put together; numbers of pieces.
  void offer(Index a, Index b);
  /// Puts together what was offered, the cheapest pair first, until `wanted` are left or no pair
  /// is. What is not used up waits for another run. Throws Cancelled.
  void run(std::size_t wanted, Progress& progress);

  std::size_t size() const { return size_; }
  /// The smallest piece of what piece k is part of: it stands for the whole.
  Index of(Index k) { return parts_.find(k); }
  /// Of a piece that stands for a whole.
  const Agglomerate& at(Index k) const { return sums_[k]; }
  /// |c_I - c_J|^2 + bend^2 |n_I - n_J|^2 of two that stand for wholes, with any `bend`.
  double distance2(Index a, Index b, double bend) const;

 private:
  struct Offer {
    float cost;
    Index a, b;  ///< a < b
    bool operator>(const Offer& other) const {
      if (cost != other.cost) return cost > other.cost;
      return a != other.a ? a > other.a : b > other.b;
    }
  };
  float cost(Index a, Index b) const;
  /// Each pair once, at its cost now: clusters meet along many edges.
  void renew();

  std::vector<Agglomerate> sums_;
  UnionFind parts_;
  double bend_;
  double scale_;
  std::size_t size_;
  std::vector<Offer> offers_;
};

}  // namespace radiosity
