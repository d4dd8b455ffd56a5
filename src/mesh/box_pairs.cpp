#include "mesh/box_pairs.h"

#include <algorithm>

#include "base/geometry/box_tree.h"
#include "base/parallel.h"

namespace radiosity {

namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

constexpr std::size_t kBoxesAtATime = 512;  // a task of a thread

/// Pairs that visit(i, found) appends for each of `count` boxes, box by box.
template <class Visit>
Pairs pairsOf(std::size_t count, const Progress* progress, const Visit& visit) {
  std::vector<Pairs> found((count + kBoxesAtATime - 1) / kBoxesAtATime);
  parallelFor(found.size(), 1, [&](std::size_t block) {
    if (progress != nullptr && progress->cancelled()) return;
    const std::size_t end = std::min(count, (block + 1) * kBoxesAtATime);
    for (std::size_t i = block * kBoxesAtATime; i < end; ++i) visit(Index(i), found[block]);
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
  return out;
}

}  // namespace

Pairs overlappingPairs(const std::vector<Box3>& boxes, const Progress* progress,
                       const PairFilter& wanted) {
  const BoxTree tree(boxes);
  return pairsOf(boxes.size(), progress, [&](Index i, Pairs& found) {
    const auto begin = std::ptrdiff_t(found.size());
    tree.query(boxes[i], [&](Index j) {
      if (i < j && (!wanted || wanted(i, j))) found.emplace_back(i, j);
      return true;
    });
    std::sort(found.begin() + begin, found.end());
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
  const BoxTree tree(some_boxes);
  Pairs pairs = pairsOf(boxes.size(), progress, [&](Index i, Pairs& found) {
    tree.query(boxes[i], [&](Index k) {
      const Index j = some[k];
      if (i == j || (is_some[i] != 0 && j < i)) return true;
      const auto [low, high] = std::minmax(i, j);
      if (!wanted || wanted(low, high)) found.emplace_back(low, high);
      return true;
    });
  });
  parallelSort(pairs);
  return pairs;
}

}  // namespace radiosity
