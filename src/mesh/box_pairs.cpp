#include "mesh/box_pairs.h"

#include <algorithm>

#include "base/geometry/box_tree.h"
#include "base/parallel.h"

namespace radiosity {

namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

constexpr std::size_t kAtATime = 256;  // for each task of a thread
constexpr std::size_t kFew = 32;       // boxes that need no tree

/// Pairs that visit(k, found) appends for each k below `count`, in ascending order.
template <class Visit>
Pairs pairsOf(std::size_t count, const Progress* progress, const Visit& visit) {
  std::vector<Pairs> found((count + kAtATime - 1) / kAtATime);
  parallelFor(found.size(), 1, [&](std::size_t block) {
    if (progress != nullptr && progress->cancelled()) return;
    const std::size_t end = std::min(count, (block + 1) * kAtATime);
    for (std::size_t k = block * kAtATime; k < end; ++k) visit(Index(k), found[block]);
  });
  if (progress != nullptr) progress->check();
  std::size_t total = 0;
  for (const Pairs& some : found) total += some.size();
  Pairs out;
  out.reserve(total);
  for (Pairs& some : found) {
    out.insert(out.end(), some.begin(), some.end());
    some = {};
  }
  parallelSort(out);
  return out;
}

/// Calls visit(i, j) for the overlapping boxes i of a leaf and j, with j after i in the tree's
/// order, so that every pair is visited in one leaf.
template <class Visit>
void forPairsOfLeaf(const BoxTree& tree, const BoxTree::Node& leaf, const Visit& visit) {
  struct Step {
    Index node;
    Index first;  // of the tree's order
  };
  std::vector<Step> stack;
  stack.reserve(64);
  stack.push_back({0, 0});
  const auto& boxes = tree.boxes();
  while (!stack.empty()) {
    const auto [at, first] = stack.back();
    stack.pop_back();
    const BoxTree::Node& node = tree.nodes()[at];
    if (first + node.below <= leaf.first || !node.bound.meets(leaf.bound)) continue;
    if (node.count == 0) {
      const Index left = node.first;
      stack.push_back({left + 1, first + tree.nodes()[left].below});
      stack.push_back({left, first});
      continue;
    }
    for (Index a = leaf.first; a < leaf.first + leaf.count; ++a) {
      for (Index b = std::max(node.first, a + 1); b < node.first + node.count; ++b) {
        if (boxes[a].meets(boxes[b])) visit(tree.order()[a], tree.order()[b]);
      }
    }
  }
}

/// The overlapping pairs of a few boxes for which wanted(i, j), i < j, is true, ascending.
template <class Wanted>
Pairs pairsOfFew(const std::vector<Box3>& boxes, const Wanted& wanted) {
  Pairs found;
  for (Index i = 0; i < boxes.size(); ++i) {
    for (Index j = i + 1; j < boxes.size(); ++j) {
      if (boxes[i].meets(boxes[j]) && wanted(i, j)) found.emplace_back(i, j);
    }
  }
  return found;
}

}  // namespace

Pairs overlappingPairs(const std::vector<Box3>& boxes, const Progress* progress,
                       const PairFilter& wanted) {
  if (boxes.size() <= kFew) {
    return pairsOfFew(boxes, [&](Index i, Index j) { return !wanted || wanted(i, j); });
  }
  const BoxTree tree(boxes);
  return pairsOf(tree.nodes().size(), progress, [&](Index node, Pairs& found) {
    if (tree.nodes()[node].count == 0) return;
    forPairsOfLeaf(tree, tree.nodes()[node], [&](Index i, Index j) {
      const auto [low, high] = std::minmax(i, j);
      if (!wanted || wanted(low, high)) found.emplace_back(low, high);
    });
  });
}

Pairs overlappingPairs(const std::vector<Box3>& boxes, const std::vector<Index>& some,
                       const Progress* progress, const PairFilter& wanted) {
  if (some.size() == boxes.size()) return overlappingPairs(boxes, progress, wanted);
  std::vector<Box3> some_boxes;
  some_boxes.reserve(some.size());
  std::vector<char> is_some(boxes.size(), 0);
  for (const Index i : some) {
    some_boxes.push_back(boxes[i]);
    is_some[i] = 1;
  }
  if (boxes.size() <= kFew) {
    return pairsOfFew(boxes, [&](Index i, Index j) {
      return (is_some[i] != 0 || is_some[j] != 0) && (!wanted || wanted(i, j));
    });
  }
  const BoxTree tree(some_boxes);
  return pairsOf(boxes.size(), progress, [&](Index i, Pairs& found) {
    tree.query(boxes[i], [&](Index k) {
      const Index j = some[k];
      if (i == j || (is_some[i] != 0 && j < i)) return true;
      const auto [low, high] = std::minmax(i, j);
      if (!wanted || wanted(low, high)) found.emplace_back(low, high);
      return true;
    });
  });
}

}  // namespace radiosity
