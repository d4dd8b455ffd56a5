// The tree of occluders: finds those between two spheres, all of them or as many as are asked for.
#include <gtest/gtest.h>

#include <algorithm>

#include "occluder_builder.h"
#include "visibility/shadows/tree.h"

namespace radiosity {
namespace {

constexpr std::size_t kInRow = 100;

/// A small triangle at a place.
Occluder triangleAt(const Vec3& place) {
  return test::flatOccluder({place + Vec3(.001, 0, 0), place + Vec3(0, .001, 0), place});
}

/// Triangles along the x axis from 0 to 1, and as many a unit beside it.
struct ExactOccluderTree : ::testing::Test {
  ExactOccluderTree() {
    for (std::size_t k = 0; k < kInRow; ++k) {
      occluders.push_back(triangleAt({double(k) / kInRow, 0, 0}));
      occluders.push_back(triangleAt({double(k) / kInRow, 1, 0}));
    }
  }

  std::vector<Index> between(const Sphere& a, const Sphere& b, std::size_t most) const {
    std::vector<Index> found;
    std::size_t tests = 0;
    OccluderTree(occluders).query(a, b, kAnywhere, kAnywhere, found, tests, most);
    std::sort(found.begin(), found.end());
    return found;
  }

  std::vector<Occluder> occluders;
  const Sphere start{{-1, 0, 0}, .1};
  const Sphere end{{2, 0, 0}, .1};
};

TEST_F(ExactOccluderTree, FindsAllThatStandBetweenTwoSpheres) {
  const std::vector<Index> found = between(start, end, occluders.size());
  ASSERT_EQ(found.size(), kInRow);
  for (const Index o : found) EXPECT_LT(occluders[o].centre.y, .5);
}

TEST_F(ExactOccluderTree, EndsOnceMoreThanAskedForAreFound) {
  const std::vector<Index> all = between(start, end, occluders.size());
  for (const std::size_t most : {std::size_t(0), std::size_t(10), kInRow - 1}) {
    const std::vector<Index> found = between(start, end, most);
    EXPECT_GT(found.size(), most);
    EXPECT_LE(found.size(), most + 2);  // a leaf holds two
    EXPECT_TRUE(std::includes(all.begin(), all.end(), found.begin(), found.end()));
  }
  EXPECT_EQ(between(start, end, kInRow), all);
}

TEST_F(ExactOccluderTree, FindsNothingBesideThem) {
  EXPECT_TRUE(between({{-1, 3, 0}, .1}, {{2, 3, 0}, .1}, 10).empty());
}

}  // namespace
}  // namespace radiosity
