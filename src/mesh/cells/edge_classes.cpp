#include "mesh/cells/edge_classes.h"

#include <algorithm>

namespace radiosity {

namespace {

constexpr double kLargestRatio = 2.0;

}  // namespace

void EdgeClasses::join(Index a, Index b, bool opposed) {
  const Index p = sets_.find(a);
  const Index q = sets_.find(b);
  const double shortest = std::min(shortest_[p], shortest_[q]);
  const double longest = std::max(longest_[p], longest_[q]);
  if (longest > kLargestRatio * shortest) return;
  sets_.unite(p, q);
  shortest_[sets_.find(p)] = shortest;
  longest_[sets_.find(p)] = longest;
  joined_[a].push_back({b, opposed});
  joined_[b].push_back({a, opposed});
}

void EdgeClasses::orient() {
  std::vector<char> seen(joined_.size(), 0);
  std::vector<Index> stack;
  for (Index first = 0; first < joined_.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = 1;
    stack.push_back(first);
    while (!stack.empty()) {
      const Index e = stack.back();
      stack.pop_back();
      for (const Join& join : joined_[e]) {
        const char wanted = char(opposed_[e] ^ char(join.opposed));
        if (seen[join.edge] && opposed_[join.edge] != wanted) twisted_[sets_.find(e)] = 1;
        if (seen[join.edge]) continue;
        seen[join.edge] = 1;
        opposed_[join.edge] = wanted;
        stack.push_back(join.edge);
      }
    }
  }
}

}  // namespace radiosity
