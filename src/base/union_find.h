// Disjoint sets over 0 .. n-1; the representative of a set is its smallest element.
#pragma once

#include <numeric>
#include <utility>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count), sets_(count) {
    std::iota(parent_.begin(), parent_.end(), Index(0));
  }
  Index find(Index x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    if (b < a) std::swap(a, b);
    parent_[b] = a;
    --sets_;
  }
  /// The number of sets.
  std::size_t sets() const { return sets_; }

 private:
  std::vector<Index> parent_;
  std::size_t sets_;
};

}  // namespace radiosity
