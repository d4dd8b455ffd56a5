#include "mesh/box_pairs.h"

#include <CGAL/Box_intersection_d/Box_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>

namespace radiosity {

namespace {

/// A box that knows its number; CGAL asks for unique ids.
class NumberedBox
    : public CGAL::Box_intersection_d::Box_d<double, 3, CGAL::Box_intersection_d::ID_NONE> {
 public:
  using Base = CGAL::Box_intersection_d::Box_d<double, 3, CGAL::Box_intersection_d::ID_NONE>;
  NumberedBox(const Box3& box, Index number)
      : Base(CGAL::Bbox_3(box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z)),
        number_(number) {}
  std::size_t id() const { return number_; }

 private:
  Index number_;
};

std::vector<NumberedBox> numbered(const std::vector<Box3>& boxes, const std::vector<Index>& which) {
  std::vector<NumberedBox> out;
  out.reserve(which.size());
  for (const Index i : which) out.emplace_back(boxes[i], i);
  return out;
}

}  // namespace

std::vector<std::pair<Index, Index>> overlappingPairs(const std::vector<Box3>& boxes,
                                                      const Progress* progress) {
  std::vector<Index> all(boxes.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = Index(i);
  return overlappingPairs(boxes, all, progress);
}

std::vector<std::pair<Index, Index>> overlappingPairs(const std::vector<Box3>& boxes,
                                                      const std::vector<Index>& some,
                                                      const Progress* progress) {
  std::vector<std::pair<Index, Index>> pairs;
  std::size_t asked = 0;
  const auto found = [&](const NumberedBox& a, const NumberedBox& b) {
    if (progress != nullptr && ++asked % 65536 == 0) progress->check();
    if (a.id() != b.id()) {
      pairs.emplace_back(Index(std::min(a.id(), b.id())), Index(std::max(a.id(), b.id())));
    }
  };
  auto first = numbered(boxes, some);
  if (some.size() == boxes.size()) {
    CGAL::box_self_intersection_d(first.begin(), first.end(), found);
  } else {
    std::vector<Index> all(boxes.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = Index(i);
    auto second = numbered(boxes, all);
    CGAL::box_intersection_d(first.begin(), first.end(), second.begin(), second.end(), found);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace radiosity
