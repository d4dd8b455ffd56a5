// The classified pairs of some rows, kept until they are evaluated.
#pragma once

#include <span>
#include <vector>

#include "formfactor/exact/occluded/occluded_pairs.h"
#include "formfactor/exact/visibility/visibility.h"
#include "visibility/elements/elements.h"

namespace radiosity {

/// A rectangle of pairs with nothing in between.
struct PairBlock {
  ElementRange rows;
  ElementRange columns;
};

class RecordedPairs final : public VisibilitySink {
 public:
  RecordedPairs() = default;
  /// Throws Cancelled where `progress`, kept by reference, is cancelled.
  explicit RecordedPairs(const Progress* progress) : progress_(progress) {}

  void poll() const override {
    if (progress_ != nullptr) progress_->check();
  }
  void unoccluded(ElementRange rows, ElementRange columns) override {
    blocks.push_back({rows, columns});
  }
  void occluded(Index row, Index column, std::span<const Index> occluders) override {
    const auto begin = std::uint32_t(occluder_list.size());
    occluder_list.insert(occluder_list.end(), occluders.begin(), occluders.end());
    occluded_pairs.push_back({row, column, begin, std::uint32_t(occluder_list.size()), 0.0});
  }
  void clear() {
    blocks.clear();
    occluded_pairs.clear();
    occluder_list.clear();
  }

  std::vector<PairBlock> blocks;
  std::vector<OccludedPair> occluded_pairs;
  std::vector<Index> occluder_list;

 private:
  const Progress* progress_ = nullptr;
};

}  // namespace radiosity
