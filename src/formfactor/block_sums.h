// Sums over blocks with the same bits for any number of threads and processes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/made.h"
#include "formfactor/row_blocks.h"
#include "radiosity/base.h"

namespace radiosity {

/// Adds up a sum a block in a tree that halves their range, whatever the order in which they come:
/// two halves are added as soon as both are there, so few sums are held at once. Thread-safe.
template <class Sum>
class BlockSums {
 public:
  explicit BlockSums(std::size_t blocks) : leaf_(blocks) {
    nodes_.reserve(2 * blocks);
    if (blocks > 0) add({0, blocks}, kNone);
  }

  void putBlock(std::size_t block, Sum sum) { put(leaf_[block], std::move(sum)); }
  /// The sum of all blocks, once they are there; nothing if there are none.
  std::optional<Sum> takeAll() { return nodes_.empty() ? std::nullopt : take(0); }

  // ---- Parts of the tree, which one process makes and another adds up.

  /// The beginnings of the largest parts of at most a `parts`-th of the blocks, and the end.
  std::vector<std::size_t> starts(std::size_t parts) const {
    const std::size_t most =
        std::max<std::size_t>(1, leaf_.size() / std::max<std::size_t>(1, parts));
    std::vector<std::size_t> starts;
    for (const Node& node : nodes_) {
      const bool is_part = sizeOf(node) <= most;
      const bool above_is = node.above != kNone && sizeOf(nodes_[node.above]) <= most;
      if (is_part && !above_is) starts.push_back(node.range.begin);
    }
    starts.push_back(leaf_.size());
    return starts;
  }
  /// Made whole by now.
  Sum takePart(BlockRange range) {
    std::optional<Sum> sum = take(nodeOf(range));
    return std::move(made(sum));
  }
  void putPart(BlockRange range, Sum sum) { put(nodeOf(range), std::move(sum)); }

 private:
  struct Node {
    BlockRange range;
    Index above;
    Index halves[2] = {kNone, kNone};
    std::optional<Sum> sum{};
  };
  static std::size_t sizeOf(const Node& node) { return node.range.end - node.range.begin; }

  Index add(BlockRange range, Index above) {
    const auto at = Index(nodes_.size());
    nodes_.push_back({range, above});
    if (range.end - range.begin == 1) {
      leaf_[range.begin] = at;
      return at;
    }
    const std::size_t middle = range.begin + (range.end - range.begin) / 2;
    const Index first = add({range.begin, middle}, at);
    const Index second = add({middle, range.end}, at);
    nodes_[at].halves[0] = first;
    nodes_[at].halves[1] = second;
    return at;
  }
  Index nodeOf(BlockRange range) const {
    Index at = leaf_[range.begin];
    while (nodes_[at].range.begin != range.begin || nodes_[at].range.end != range.end) {
      at = nodes_[at].above;
    }
    return at;
  }
  std::optional<Sum> take(Index at) {
    const std::lock_guard lock(mutex_);
    return std::exchange(nodes_[at].sum, std::nullopt);
  }
  /// Puts a sum where it waits for that of the other half, or adds both and goes on above.
  void put(Index at, Sum sum) {
    for (;;) {
      const Index above = nodes_[at].above;
      const bool is_first = above != kNone && nodes_[above].halves[0] == at;
      std::optional<Sum> other;
      {
        const std::lock_guard lock(mutex_);
        if (above != kNone) {
          other = std::exchange(nodes_[nodes_[above].halves[is_first ? 1 : 0]].sum, std::nullopt);
        }
        if (!other) {
          nodes_[at].sum.emplace(std::move(sum));
          return;
        }
      }
      if (!is_first) std::swap(sum, *other);
      sum += *other;
      at = above;
    }
  }

  std::vector<Node> nodes_;
  std::vector<Index> leaf_;
  std::mutex mutex_;
};

}  // namespace radiosity
