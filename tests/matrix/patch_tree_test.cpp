// The tree of patches: what a node has, and how it fits a field.
#include "matrix/patch_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace radiosity {
namespace {

/// Patches of random places, areas and normals about one axis.
std::vector<PatchTree::Patch> randomPatches(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<PatchTree::Patch> patches(n);
  for (std::size_t k = 0; k < n; ++k) {
    for (float& at : patches[k].at) at = uniform(random);
    patches[k].area = 0.5 + uniform(random);
    patches[k].patch = Index(n - 1 - k);
  }
  return patches;
}

void expectWhole(const PatchTree& tree, std::size_t n) {
  ASSERT_EQ(tree.patches().size(), n);
  ASSERT_EQ(tree.nodes().size(), 2 * n - 1);
  std::set<Index> named;
  for (const PatchTree::Patch& patch : tree.patches()) named.insert(patch.patch);
  EXPECT_EQ(named.size(), n);
  EXPECT_EQ(tree.nodes()[0].begin, 0u);
  EXPECT_EQ(tree.nodes()[0].end, n);
  for (std::size_t k = 0; k < tree.nodes().size(); ++k) {
    const PatchTree::Node& node = tree.nodes()[k];
    ASSERT_LT(node.begin, node.end);
    if (node.isLeaf()) continue;
    EXPECT_EQ(tree.nodes()[tree.first(k)].begin, node.begin);
    EXPECT_EQ(tree.nodes()[tree.first(k)].end, tree.nodes()[tree.second(k)].begin);
    EXPECT_EQ(tree.nodes()[tree.second(k)].end, node.end);
  }
}

TEST(PatchTree, HalvesItsPatchesDownToOne) {
  for (const std::size_t n : {1u, 2u, 3u, 100u, 9999u}) {
    const PatchTree tree(randomPatches(n, 1));
    expectWhole(tree, n);
  }
  EXPECT_TRUE(PatchTree(std::vector<PatchTree::Patch>()).nodes().empty());
}

TEST(PatchTree, OfPatchesThatAreAllAlikeIsATree) {
  std::vector<PatchTree::Patch> patches(5000);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    patches[k] = {.at = {1, 2, 3, 0, 0, 1}, .area = 1, .patch = Index(k)};
  }
  const PatchTree tree(patches);
  expectWhole(tree, patches.size());
  EXPECT_EQ(tree.fit(0).radius, 0);
  const std::vector<double> x(patches.size(), 3.0);
  EXPECT_NEAR(nodeFields(tree, x, 1)[0].mean, 3, 1e-12);
}

TEST(PatchTree, IsTheSameFromItsOwnOrder) {
  const PatchTree tree(randomPatches(5000, 2));
  const PatchTree again = PatchTree::ofSorted({tree.patches().begin(), tree.patches().end()});
  for (std::size_t k = 0; k < tree.nodes().size(); ++k) {
    ASSERT_EQ(tree.nodes()[k].begin, again.nodes()[k].begin);
    ASSERT_EQ(tree.nodes()[k].end, again.nodes()[k].end);
    if (tree.nodes()[k].isLeaf()) continue;
    ASSERT_EQ(tree.fit(k).inverse, again.fit(k).inverse);
  }
}

TEST(PatchTree, HoldsItsPatchesWithinTheRadiusOfEachNode) {
  const PatchTree tree(randomPatches(500, 3));
  for (std::size_t k = 0; k < tree.nodes().size(); ++k) {
    const PatchTree::Node& node = tree.nodes()[k];
    if (node.isLeaf()) continue;
    const PatchTree::Fit& fit = tree.fit(k);
    for (Index p = node.begin; p < node.end; ++p) {
      double square = 0;
      for (std::size_t f = 0; f < 3; ++f) {
        square += std::pow(tree.patches()[p].at[f] - fit.middle[f], 2);
      }
      EXPECT_LE(std::sqrt(square), fit.radius * (1 + 1e-12));
    }
  }
}

TEST(PatchTree, FitsFieldsThatAreLinearInPlaceAndNormal) {
  const std::size_t n = 3000;
  const PatchTree tree(randomPatches(n, 4));
  // Two bands: a constant, and a linear field; more than four walk twice.
  const std::array<double, kPatchFeatures> slope{1, -2, 0.5, 3, 0, -1};
  for (const int bands : {2, 6}) {
    std::vector<double> x(n * std::size_t(bands), 0.0);
    for (const PatchTree::Patch& patch : tree.patches()) {
      double* of = &x[patch.patch * std::size_t(bands)];
      of[bands - 2] = 7;
      for (std::size_t f = 0; f < kPatchFeatures; ++f) of[bands - 1] += slope[f] * patch.at[f];
    }
    const std::vector<NodeField> fields = nodeFields(tree, x, bands);
    for (const std::size_t node : {std::size_t(0), tree.first(0), tree.second(0)}) {
      const PatchTree::Fit& fit = tree.fit(node);
      const NodeField* of = &fields[node * std::size_t(bands)];
      EXPECT_NEAR(of[bands - 2].mean, 7, 1e-12);
      double middle = 0;
      for (std::size_t f = 0; f < kPatchFeatures; ++f) {
        middle += slope[f] * fit.middle[f];
        EXPECT_NEAR(of[bands - 2].slope[f], 0, 1e-12);
        // The fit holds back by a hundredth of the strongest variance: twice that for others here.
        EXPECT_NEAR(of[bands - 1].slope[f], slope[f] * fit.unitOf(f), 0.1);
      }
      EXPECT_NEAR(of[bands - 1].mean, middle, 1e-6);
    }
  }
}

}  // namespace
}  // namespace radiosity
