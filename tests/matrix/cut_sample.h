// Form factors as cut rows, made by chance, for tests of the operator and of its file.
#pragma once

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "matrix/cut_operator.h"

namespace radiosity::test {

/// Of n patches: the last has no area, the one before it a row that is known pair by pair; all
/// others have rows of random nodes that sum to .9, and see that one.
inline CutParts randomCut(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  CutParts parts;
  parts.area.assign(n, 0.0);
  std::vector<PatchTree::Patch> patches(n - 2);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    for (float& at : patches[k].at) at = uniform(random);
    parts.area[k] = 1.5 + double(uniform(random));
    patches[k].area = parts.area[k];
    patches[k].counts = 1 + 0.5 * double(uniform(random));
    patches[k].patch = Index(k);
  }
  parts.area[n - 2] = 2;
  parts.tree = PatchTree(patches);
  parts.blocks.resize(CutParts::blocksOf(patches.size()));
  for (std::size_t place = 0; place < patches.size(); ++place) {
    CutRows& rows = parts.blocks[place / CutParts::kBlock];
    double hits = 0;
    for (std::size_t node = random() % 7; node < parts.tree.nodes().size(); node += 5) {
      rows.nodes.push_back(Index(node));
      rows.hits.push_back({std::uint16_t(random() % 50), std::uint16_t(1 + random() % 50)});
      hits += double(rows.hits.back()[0]) + double(rows.hits.back()[1]);
      CutRows::Place at{};
      if (!parts.tree.nodes()[node].isLeaf()) {
        for (auto& of : at) of = std::int8_t(int(random() % 101) - 50);
      }
      rows.places.push_back(at);
    }
    rows.ends.push_back(std::uint32_t(rows.nodes.size()));
    parts.of_a_hit.push_back(hits > 0 ? 0.9 / hits : 0.0);
  }
  const auto pairs = std::make_shared<RowMatrix>(parts.area, Precision::single_precision);
  std::vector<Index> all;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    pairs->setRow(k, std::vector<Index>{Index(n - 2)}, std::vector<double>{0.0625});
    all.push_back(Index(k));
  }
  pairs->setRow(n - 2, all, std::vector<double>(all.size(), 1.0 / double(n)));
  parts.pairs = pairs;
  parts.bias = 0.003;
  return parts;
}

}  // namespace radiosity::test
