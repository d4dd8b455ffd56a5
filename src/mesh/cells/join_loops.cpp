#include "mesh/cells/join_loops.h"

#include <algorithm>
#include <utility>

namespace radiosity {

namespace {

using LoopEdges = std::vector<std::pair<Index, Index>>;

/// The directed edges of both loops but for those that run in opposite directions, ascending.
LoopEdges edgesOfUnion(const std::vector<Index>& a, const std::vector<Index>& b) {
  LoopEdges edges;
  edges.reserve(a.size() + b.size());
  for (const std::vector<Index>* loop : {&a, &b}) {
    for (std::size_t k = 0; k < loop->size(); ++k) {
      edges.emplace_back((*loop)[k], (*loop)[(k + 1) % loop->size()]);
    }
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const LoopEdges all = edges;
  std::erase_if(edges, [&](const auto& edge) {
    return std::ranges::binary_search(all, std::pair(edge.second, edge.first));
  });
  return edges;
}

}  // namespace

std::vector<Index> joinLoops(const std::vector<Index>& a, const std::vector<Index>& b) {
  const LoopEdges edges = edgesOfUnion(a, b);
  const auto sameStart = [](const auto& x, const auto& y) { return x.first == y.first; };
  if (edges.empty() || std::ranges::adjacent_find(edges, sameStart) != edges.end()) return {};
  std::vector<Index> loop{edges.front().first};
  loop.reserve(edges.size());
  for (std::size_t steps = 0; steps < edges.size(); ++steps) {
    const auto step =
        std::ranges::lower_bound(edges, loop.back(), {}, &LoopEdges::value_type::first);
    if (step == edges.end() || step->first != loop.back()) return {};
    if (step->second == loop.front()) break;
    loop.push_back(step->second);
  }
  if (loop.size() != edges.size()) return {};
  return loop;
}

}  // namespace radiosity
