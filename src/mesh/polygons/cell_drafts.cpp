#include "mesh/polygons/cell_drafts.h"

#include <algorithm>

#include "base/union_find.h"

namespace radiosity {

namespace {

class DraftMaker {
 public:
  explicit DraftMaker(const CellsToMerge& cells) : cells_(cells) {}
  Drafts run() {
    indexRecords();
    joinRecords();
    sortEdges();
    return std::move(drafts_);
  }

 private:
  void indexRecords();
  void joinRecords();
  void sortEdges();

  const CellsToMerge& cells_;
  std::vector<DraftKind> kind_;  ///< by record
  Drafts drafts_;
};

void DraftMaker::indexRecords() {
  drafts_.records.resize(cells_.arrangement.cells.size());
  for (std::size_t r = 0; r < cells_.visible.size(); ++r)
    drafts_.records[cells_.visible[r].cell].push_back(Index(r));
  for (const VisibleCell& v : cells_.visible) {
    DraftKind kind;
    kind.surface = cells_.sheets[v.sheet].surface;
    kind.both = v.above && v.below;
    kind.up = kind.both ? cells_.sheets[v.sheet].facing > 0 : v.above;
    for (const Index other : drafts_.records[v.cell]) {
      if (&cells_.visible[other] != &v)
        kind.behind = cells_.sheets[cells_.visible[other].sheet].surface;
    }
    kind_.push_back(kind);
  }
}

void DraftMaker::joinRecords() {
  UnionFind joined(cells_.visible.size());
  for (const auto& at_edge : cells_.arrangement.sides) {
    for (const EdgeSides& s : at_edge) {
      for (const Index l : drafts_.recordsOf(s.left)) {
        for (const Index r : drafts_.recordsOf(s.right)) {
          if (kind_[l] == kind_[r]) joined.unite(l, r);
        }
      }
    }
  }
  drafts_.draft_of.assign(cells_.visible.size(), kNone);
  for (std::size_t r = 0; r < cells_.visible.size(); ++r) {
    const Index root = joined.find(Index(r));
    if (root == r) {
      drafts_.draft_of[r] = Index(drafts_.list.size());
      drafts_.list.emplace_back();
      drafts_.list.back().plane = cells_.arrangement.cells[cells_.visible[r].cell].plane;
      drafts_.list.back().kind = kind_[r];
    }
    drafts_.draft_of[r] = drafts_.draft_of[root];
    drafts_.list[drafts_.draft_of[r]].records.push_back(Index(r));
  }
}

void DraftMaker::sortEdges() {
  drafts_.needed_number.assign(cells_.edges.size(), kNone);
  std::vector<Index> left;
  std::vector<Index> right;
  for (std::size_t e = 0; e < cells_.edges.size(); ++e) {
    std::size_t planes_here = 0;
    for (const EdgeSides& s : cells_.arrangement.sides[e]) {
      if (!drafts_.recordsOf(s.left).empty() || !drafts_.recordsOf(s.right).empty()) ++planes_here;
    }
    bool needed = false;
    for (const EdgeSides& s : cells_.arrangement.sides[e]) {
      left.clear();
      right.clear();
      for (const Index r : drafts_.recordsOf(s.left)) left.push_back(drafts_.draft_of[r]);
      for (const Index r : drafts_.recordsOf(s.right)) right.push_back(drafts_.draft_of[r]);
      const auto has = [](const std::vector<Index>& list, Index d) {
        return std::find(list.begin(), list.end(), d) != list.end();
      };
      const auto border = [&](Index d, bool on_left) {
        drafts_.list[d].border.push_back(Index(e));
        drafts_.list[d].on_left.push_back(on_left);
        needed = true;
      };
      for (const Index d : left) {
        if (!has(right, d)) {
          border(d, true);
        } else if (planes_here > 1) {
          drafts_.list[d].inner.push_back(Index(e));
          needed = true;
        }
      }
      for (const Index d : right) {
        if (!has(left, d)) border(d, false);
      }
    }
    if (!needed) continue;
    drafts_.needed_number[e] = Index(drafts_.needed.size());
    drafts_.needed.push_back(Index(e));
  }
}

}  // namespace

Drafts draftsOf(const CellsToMerge& cells) { return DraftMaker(cells).run(); }

}  // namespace radiosity
