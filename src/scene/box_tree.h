// Boxes, and a tree that finds those which touch another.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <numeric>
#include <utility>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

struct Box {
  Vec3 lower, upper;
  bool touches(const Box& other) const {
    return lower.x <= other.upper.x && other.lower.x <= upper.x && lower.y <= other.upper.y &&
           other.lower.y <= upper.y && lower.z <= other.upper.z && other.lower.z <= upper.z;
  }
};

/// A binary tree of boxes over faces, halved at the median of the longest side.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t(0));
    if (!order_.empty()) build(0, order_.size());
  }

  /// Calls visit(i) for every box that touches `box`.
  template <class Visit>
  void query(const Box& box, Visit&& visit) const {
    std::vector<std::size_t> waiting;
    if (!nodes_.empty()) waiting.push_back(0);
    while (!waiting.empty()) {
      const Node& node = nodes_[waiting.back()];
      const std::size_t first_child = waiting.back() + 1;
      waiting.pop_back();
      if (!node.box.touches(box)) continue;
      if (node.second_child == 0) {
        for (std::size_t k = node.begin; k < node.end; ++k) {
          if (boxes_[order_[k]].touches(box)) visit(order_[k]);
        }
      } else {
        waiting.push_back(first_child);
        waiting.push_back(node.second_child);
      }
    }
  }

 private:
  struct Node {
    Box box;
    std::size_t begin, end;
    std::size_t second_child;  ///< 0: a leaf
  };

  std::size_t build(std::size_t begin, std::size_t end) {
    const std::size_t number = nodes_.size();
    Box box = boxes_[order_[begin]];
    for (std::size_t k = begin; k < end; ++k) {
      box.lower = glm::min(box.lower, boxes_[order_[k]].lower);
      box.upper = glm::max(box.upper, boxes_[order_[k]].upper);
    }
    nodes_.push_back({box, begin, end, 0});
    constexpr std::size_t kLeaf = 8;
    if (end - begin <= kLeaf) return number;
    const Vec3 size = box.upper - box.lower;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + std::ptrdiff_t(begin),
                     order_.begin() + std::ptrdiff_t(middle), order_.begin() + std::ptrdiff_t(end),
                     [&](std::size_t a, std::size_t b) {
                       return boxes_[a].lower[axis] + boxes_[a].upper[axis] <
                              boxes_[b].lower[axis] + boxes_[b].upper[axis];
                     });
    build(begin, middle);
    const std::size_t second = build(middle, end);
    nodes_[number].second_child = second;
    return number;
  }

  std::vector<Box> boxes_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace radiosity
