// Greedy agglomeration of pieces that are near each other and face alike, the cheapest pair first.
#pragma once

#include <span>
#include <vector>

#include "base/union_find.h"
#include "radiosity/base.h"

namespace radiosity {

/// A planar piece of a surface, or a whole of several pieces: sums over pieces.
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
/// with areas as weights. The union of I and J adds to the area-weighted squares
///
///     A_I A_J / (A_I + A_J) * (|c_I - c_J|^2 + bend^2 |n_I - n_J|^2).
///
/// Pairs are taken in the order of this cost. A pair whose cost has risen since is put back; a pair
/// whose cost has fallen is taken when its turn comes. There are no lists of neighbours: if each
/// run() halves the number, there are as many pairs as wholes, and all takes O(n log n). Ties are
/// broken by the number of the first, then of the second of the pair.
class Agglomeration {
 public:
  /// `unit`: a typical length of the costs, so that they fit into 32 bits.
  Agglomeration(std::vector<Agglomerate> pieces, double bend, double unit);

  /// Offers a pair that may be joined, by the numbers of two pieces.
  void offer(Index a, Index b);
  /// Joins offered pairs, the cheapest first, until `wanted` wholes or no pairs are left. Unused
  /// pairs stay for the next run. Throws Cancelled.
  void run(std::size_t wanted, Progress& progress);

  std::size_t size() const { return size_; }
  /// The lowest piece of the whole that has piece k: it represents the whole.
  Index of(Index k) { return parts_.find(k); }
  /// The sums of a whole, by the piece that represents it.
  const Agglomerate& at(Index k) const { return sums_[k]; }

 private:
  void join(Index a, Index b);
  struct Offer {
    float cost;
    Index a, b;  ///< a < b
    bool operator>(const Offer& other) const {
      if (cost != other.cost) return cost > other.cost;
      return a != other.a ? a > other.a : b > other.b;
    }
  };
  float cost(Index a, Index b) const;
  Offer takeCheapest(std::size_t& next, std::vector<Offer>& dearer);
  /// Keeps each pair once, with its present cost: clusters meet along many edges.
  void renew();

  std::vector<Agglomerate> sums_;
  UnionFind parts_;
  double bend_;
  double scale_;
  std::size_t size_;
  std::vector<Offer> offers_;
};

}  // namespace radiosity
