#include "mesh/cells/join_loops.h"

#include <map>
#include <set>
#include <utility>

namespace radiosity {

std::vector<Index> joinLoops(const std::vector<Index>& a, const std::vector<Index>& b) {
  std::set<std::pair<Index, Index>> edges;
  for (const std::vector<Index>* loop : {&a, &b}) {
    for (std::size_t k = 0; k < loop->size(); ++k) {
      const std::pair<Index, Index> edge((*loop)[k], (*loop)[(k + 1) % loop->size()]);
      if (edges.erase({edge.second, edge.first}) == 0) edges.insert(edge);
    }
  }
  std::map<Index, Index> next;
  for (const auto& [from, to] : edges) {
    if (!next.emplace(from, to).second) return {};
  }
  if (next.empty()) return {};
  std::vector<Index> loop{next.begin()->first};
  for (std::size_t steps = 0; steps < next.size(); ++steps) {
    const auto step = next.find(loop.back());
    if (step == next.end()) return {};
    if (step->second == loop.front()) break;
    loop.push_back(step->second);
  }
  if (loop.size() != next.size()) return {};
  return loop;
}

}  // namespace radiosity
