#include "matrix/cut_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace radiosity {
namespace {

/// Of the sum of differences over all power. Few scenes need more than half the steps.
constexpr double kBalanced = 1e-5;
constexpr int kBalanceSteps = 20;
/// A step must leave less than this share of what was off. Few patches that see each other alone
/// cannot be balanced, since their rays differ: each step would only scale them further.
constexpr double kProgress = 0.97;
/// What a patch counts for is within these, and rests on so many hits: one that hardly any row has
/// hit stays about as it is. A patch behind others takes its part of what ends on a node that it
/// shares with them, until it counts for next to nothing.
constexpr double kFewestCounts = 1.0 / 64;
constexpr double kMostCounts = 4;
constexpr double kCredibleHits = 16;
/// A row that falls below this share of its sum has fits that what patches count for upsets.
constexpr double kSound = 0.5;
/// Parts of the rows that are summed up by themselves: the same for any number of threads.
constexpr std::size_t kParts = 4;

/// Sums of the rows, by place.
std::vector<double> rowSums(const CutParts& parts) {
  const std::vector<double> ones(parts.area.size(), 1.0);
  const std::vector<NodeField> fields = nodeFields(parts.tree, ones, 1);
  std::vector<double> sums(parts.of_a_hit.size());
  parallelFor(parts.blocks.size(), 1, [&](std::size_t b) {
    for (std::size_t r = 0; r < parts.blocks[b].ends.size(); ++r) {
      const std::size_t place = b * CutParts::kBlock + r;
      sums[place] = parts.of_a_hit[place] *
                    sumOfCut<1>(parts.blocks[b], r, fields.data(), 1, CutRows::both)[0];
    }
  });
  return sums;
}

/// Adds what rows of some blocks bring from each node: A_i share and, along f, A_i share f.
void scatter(const CutParts& parts, std::size_t first, std::size_t last,
             std::vector<NodeField>& nodes) {
  for (std::size_t b = first; b < last; ++b) {
    const CutRows& rows = parts.blocks[b];
    for (std::size_t r = 0; r < rows.ends.size(); ++r) {
      const std::size_t place = b * CutParts::kBlock + r;
      const double each = parts.tree.patches()[place].area * parts.of_a_hit[place];
      for (std::size_t e = rows.begin(r); e < rows.ends[r]; ++e) {
        NodeField& node = nodes[rows.nodes[e]];
        const double share = each * CutRows::both(rows.hits[e]);
        node.mean += share;
        for (std::size_t k = 0; k < kPatchFeatures; ++k) {
          node.slope[k] += share * rows.places[e][k] * CutRows::stepOf(k);
        }
      }
    }
  }
}

/// Hands what rows bring from nodes down to their patches.
class DownSweep {
 public:
  DownSweep(const CutParts& parts, const std::vector<NodeField>& nodes, std::vector<double>& sums)
      : tree_(parts.tree), nodes_(nodes), sums_(sums), before_(tree_.patches().size() + 1, 0.0) {
    for (std::size_t k = 0; k < tree_.patches().size(); ++k) {
      before_[k + 1] = before_[k] + tree_.patches()[k].area;
    }
  }

  /// What nodes above bring from a square metre: a value at the middle of this node, and slopes
  /// along the features as they are.
  struct Linear {
    double value = 0;
    std::array<double, kPatchFeatures> slope{};
  };

  void operator()(std::size_t node, Linear from) const {
    const PatchTree::Node& of = tree_.nodes()[node];
    if (of.isLeaf()) {
      const PatchTree::Patch& patch = tree_.patches()[of.begin];
      sums_[of.begin] = patch.counts * (patch.area * from.value + nodes_[node].mean);
      return;
    }
    const PatchTree::Fit& fit = tree_.fit(node);
    const double area = before_[of.end] - before_[of.begin];
    const std::array<double, kPatchFeatures> along = fit.solve(nodes_[node].slope);
    from.value += nodes_[node].mean / area;
    for (std::size_t k = 0; k < kPatchFeatures; ++k) {
      if (fit.unitOf(k) > 0) from.slope[k] += along[k] / fit.unitOf(k) / area;
    }
    const std::array<std::size_t, 2> children{tree_.first(node), tree_.second(node)};
    const auto down = [&](std::size_t child) { (*this)(child, moved(from, fit, child)); };
    inHalves(
        of.end - of.begin, [&] { down(children[0]); }, [&] { down(children[1]); });
  }

 private:
  Linear moved(Linear from, const PatchTree::Fit& fit, std::size_t child) const {
    for (std::size_t k = 0; k < kPatchFeatures; ++k) {
      from.value += from.slope[k] * (tree_.middle(child, k) - fit.middle[k]);
    }
    return from;
  }

  const PatchTree& tree_;
  const std::vector<NodeField>& nodes_;
  std::vector<double>& sums_;
  std::vector<double> before_;  ///< area of the patches before each place
};

/// sum_i A_i F_ij, by place.
std::vector<double> columnSums(const CutParts& parts) {
  std::array<std::vector<NodeField>, kParts> nodes;
  parallelFor(kParts, 1, [&](std::size_t p) {
    nodes[p].resize(parts.tree.nodes().size());
    const std::size_t blocks = parts.blocks.size();
    scatter(parts, p * blocks / kParts, (p + 1) * blocks / kParts, nodes[p]);
  });
  parallelFor(nodes[0].size(), 4096, [&](std::size_t n) {
    for (std::size_t p = 1; p < kParts; ++p) {
      nodes[0][n].mean += nodes[p][n].mean;
      for (std::size_t k = 0; k < kPatchFeatures; ++k) nodes[0][n].slope[k] += nodes[p][n].slope[k];
    }
  });
  std::vector<double> sums(parts.tree.patches().size());
  DownSweep(parts, nodes[0], sums)(0, {});
  return sums;
}

/// What a patch is to count for, if with what it counts for now rows bring `column` from it and
/// not `wanted`. Slopes may take light from it: the less it counts for, the less they do.
double countsOf(const PatchTree::Patch& patch, double column, double wanted, double credible) {
  const double times = column < 0 ? 0.5 : (wanted + credible) / (column + credible);
  return std::clamp(patch.counts * times, kFewestCounts, kMostCounts);
}

/// The power that a hit brings, on average.
double powerOfAHit(const CutParts& parts) {
  double power = 0;
  double hits = 0;
  for (std::size_t b = 0; b < parts.blocks.size(); ++b) {
    const CutRows& rows = parts.blocks[b];
    for (std::size_t r = 0; r < rows.ends.size(); ++r) {
      const std::size_t place = b * CutParts::kBlock + r;
      double of_row = 0;
      for (std::size_t e = rows.begin(r); e < rows.ends[r]; ++e)
        of_row += CutRows::both(rows.hits[e]);
      hits += of_row;
      power += of_row * parts.of_a_hit[place] * parts.tree.patches()[place].area;
    }
  }
  return hits > 0 ? power / hits : 0.0;
}

/// Takes the means of nodes for a row, without their slopes.
void flatten(CutParts& parts, std::size_t place) {
  CutRows& rows = parts.blocks[place / CutParts::kBlock];
  const std::size_t row = place % CutParts::kBlock;
  std::fill(rows.places.begin() + std::ptrdiff_t(rows.begin(row)),
            rows.places.begin() + std::ptrdiff_t(rows.ends[row]), CutRows::Place{});
}

/// Scales rows to their sums.
void scaleRows(CutParts& parts, std::span<const double> sums) {
  std::vector<double> found = rowSums(parts);
  bool flattened = false;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k] >= kSound * sums[k]) continue;
    flatten(parts, k);
    flattened = true;
  }
  if (flattened) found = rowSums(parts);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k] > 0) parts.of_a_hit[k] *= sums[k] / found[k];
  }
}

}  // namespace

CutBalance balanceCut(CutParts& parts, std::span<const double> sums, Progress& progress) {
  CutBalance balance;
  const auto patches = parts.tree.patches();
  double power = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) power += patches[k].area * sums[k];
  if (!(power > 0)) return balance;
  const double credible = kCredibleHits * powerOfAHit(parts);
  double last = 0;
  for (int step = 0;; ++step) {
    progress.check();
    const std::vector<double> columns = columnSums(parts);
    double off = 0;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      off += std::abs(columns[k] - patches[k].area * sums[k]);
    }
    balance.after = off / power;
    if (step == 0) balance.before = balance.after;
    if (balance.after <= kBalanced || step == kBalanceSteps) break;
    if (step > 0 && balance.after > kProgress * last) break;
    last = balance.after;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const double wanted = patches[k].area * sums[k];
      parts.tree.setCounts(k, countsOf(patches[k], columns[k], wanted, credible));
    }
    scaleRows(parts, sums);
  }
  return balance;
}

}  // namespace radiosity
