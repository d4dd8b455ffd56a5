#include "visibility/elements/clusters.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <limits>

#include "base/geometry/box.h"

namespace radiosity {
namespace {

/// Not quite one half: the middle row of an odd grid falls to one side as a whole, whatever the
/// rounding of its middles.
constexpr double kSplit = 0.5 + 1.0 / 1024;
constexpr double kLong = 2;  // boxes longer than this times their width are halved one way

class ClusterBuilder {
 public:
  ClusterBuilder(std::span<FlatElement> elements, const PlaneFrame& frame, Index first,
                 std::vector<Cluster>& clusters)
      : elements_(elements), frame_(frame), first_(first), clusters_(clusters) {}

  Index build() {
    const auto root = Index(clusters_.size());
    clusters_.push_back(cluster(0, elements_.size()));
    divide(root);
    return root;
  }

 private:
  Cluster cluster(std::size_t begin, std::size_t end) const {
    Box2 box;
    for (const FlatElement& element : elements_.subspan(begin, end - begin)) {
      box.add(element.lower);
      box.add(element.upper);
    }
    Cluster out;
    out.elements = {first_ + Index(begin), first_ + Index(end)};
    out.centre = frame_.lift(box.centre());
    out.radius = 0.5 * box.diagonal();
    out.bounds = {frame_.lift(box.low), frame_.lift({box.high.x, box.low.y}), frame_.lift(box.high),
                  frame_.lift({box.low.x, box.high.y})};
    return out;
  }

  /// Sorts [begin, end) into parts and returns their ends.
  std::vector<std::size_t> split(std::size_t begin, std::size_t end) {
    Box2 box;
    for (std::size_t k = begin; k < end; ++k) box.add(elements_[k].middle);
    const Vec2 size = box.size();
    const Vec2 at = box.low + kSplit * size;
    const bool by_x = size.x * kLong >= size.y;
    const bool by_y = size.y * kLong >= size.x;
    const auto part = [&](const FlatElement& e) {
      return 2U * unsigned(by_y && e.middle.y > at.y) + unsigned(by_x && e.middle.x > at.x);
    };
    const auto from = elements_.begin() + std::ptrdiff_t(begin);
    const auto to = elements_.begin() + std::ptrdiff_t(end);
    std::stable_sort(from, to,
                     [&](const FlatElement& a, const FlatElement& b) { return part(a) < part(b); });
    std::vector<std::size_t> ends;
    for (std::size_t k = begin; k < end; ++k) {
      if (k + 1 == end || part(elements_[k]) != part(elements_[k + 1])) ends.push_back(k + 1);
    }
    if (ends.size() == 1) return {(begin + end) / 2, end};  // all in one place
    return ends;
  }

  void divide(Index node) {
    const std::size_t begin = clusters_[node].elements.first - first_;
    const std::size_t end = clusters_[node].elements.end - first_;
    if (end - begin < 2) return;
    const std::vector<std::size_t> ends = split(begin, end);
    const auto child = Index(clusters_.size());
    clusters_[node].first_child = child;
    clusters_[node].child_count = Index(ends.size());
    for (std::size_t k = 0; k < ends.size(); ++k) {
      clusters_.push_back(cluster(k == 0 ? begin : ends[k - 1], ends[k]));
    }
    for (Index k = 0; k < ends.size(); ++k) divide(child + k);
  }

  std::span<FlatElement> elements_;
  const PlaneFrame& frame_;
  Index first_;
  std::vector<Cluster>& clusters_;
};

}  // namespace

Index appendClusters(std::span<FlatElement> elements, const PlaneFrame& frame, Index first,
                     std::vector<Cluster>& clusters) {
  return ClusterBuilder(elements, frame, first, clusters).build();
}

}  // namespace radiosity
