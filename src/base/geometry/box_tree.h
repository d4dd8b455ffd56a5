// Boxes by place.
#pragma once

#include <array>
#include <vector>

#include "base/geometry/box.h"
#include "radiosity/base.h"

namespace radiosity {

/// A binary tree over boxes; finds those that meet a box.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box3>& boxes);

  /// Calls visit(index) for every box that meets `box`, until it returns false.
  template <class Visit>
  void query(const Box3& box, const Visit& visit) const {
    search([&](const Box3& other) { return other.meets(box); }, visit);
  }

  /// Calls visit(index) for every box for which `meets` is true, until visit() returns false. If
  /// `meets` is false for a box, it must be false for every box inside it.
  template <class Meets, class Visit>
  void search(const Meets& meets, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<Index, kDepth> stack;
    std::size_t height = 1;
    stack[0] = 0;
    while (height > 0) {
      const Node& node = nodes_[stack[--height]];
      if (!meets(node.bound)) continue;
      if (node.count == 0) {
        stack[height++] = node.first + 1;
        stack[height++] = node.first;
        continue;
      }
      for (Index k = node.first; k < node.first + node.count; ++k) {
        if (meets(boxes_[k]) && !visit(order_[k])) return;
      }
    }
  }

  const Box3& bound() const { return nodes_.front().bound; }

  struct Node {
    Box3 bound;
    Index first = 0;  ///< first child (the second follows it); of a leaf, first place in order()
    Index count = 0;  ///< of a leaf; 0: inner node
    Index below = 0;  ///< boxes in it
  };
  /// The nodes, root first, for other searches than search(). Empty if there are no boxes.
  const std::vector<Node>& nodes() const { return nodes_; }
  /// The boxes, leaf by leaf, and their indices.
  const std::vector<Box3>& boxes() const { return boxes_; }
  const std::vector<Index>& order() const { return order_; }
  std::size_t bytes() const {
    return boxes_.size() * (sizeof(Box3) + sizeof(Index)) + nodes_.size() * sizeof(Node);
  }

 private:
  /// The most nodes that a search defers: one a level. Each level halves the boxes, so there are no
  /// more levels than an index has bits.
  static constexpr std::size_t kDepth = 34;
  void build(Index node, Index first, Index count, Index below, const std::vector<Box3>& boxes);

  std::vector<Box3> boxes_;   ///< leaf by leaf
  std::vector<Index> order_;  ///< the index of each
  std::vector<Node> nodes_;
};

}  // namespace radiosity
