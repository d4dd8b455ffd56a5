// Form factors as rows that are cut through a tree of patches: each row holds some hundred nodes in
// place of the patches that its rays have hit, and takes a field at a node where they hit it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "matrix/patch_tree.h"
#include "radiosity/exchange_operator.h"
#include "radiosity/row_matrix.h"

namespace radiosity {

/// Some consecutive rows. The arrays beside `ends` have an entry for each node of each row's cut.
struct CutRows {
  /// The mean of f (PatchTree::Fit) over the patches that were hit, in steps of kStep.
  using Place = std::array<std::int8_t, kPatchFeatures>;
  /// Hits of two sets of rays that know nothing of each other.
  using Hits = std::array<std::uint16_t, 2>;

  std::vector<std::uint32_t> ends;  ///< of each row's entries
  std::vector<Index> nodes;
  std::vector<Hits> hits;
  std::vector<Place> places;

  /// Whether it is of so many rows, and all its arrays fit together and to a tree of `nodes` nodes.
  bool isOf(std::size_t rows, std::size_t nodes) const;
  std::size_t begin(std::size_t row) const { return row == 0 ? 0 : ends[row - 1]; }
  std::size_t bytes() const {
    return ends.size() * sizeof(std::uint32_t) +
           nodes.size() * (sizeof(Index) + sizeof(Hits) + sizeof(Place));
  }
  static double both(const Hits& of) { return double(of[0]) + double(of[1]); }
  /// The step of a feature: f is within 1 for places, and within 2 for normals.
  static constexpr double stepOf(std::size_t feature) { return (feature < 3 ? 1.0 : 2.0) / 127; }
};

/// All that a CutOperator is made of.
struct CutParts {
  std::vector<double> area;      ///< N, m^2
  PatchTree tree;                ///< of the patches that rays hit and that have rows of rays
  std::vector<CutRows> blocks;   ///< of kBlock patches each, in the tree's order
  std::vector<double> of_a_hit;  ///< by place in the tree: what a hit of this row counts
  std::shared_ptr<const RowMatrix> pairs;  ///< what is known pair by pair, beside these; or null
  double bias = 0;  ///< about the relative error of irradiance by which cuts differ from their rays

  /// Rows of a block.
  static constexpr std::size_t kBlock = 64;
  static std::size_t blocksOf(std::size_t rows) { return (rows + kBlock - 1) / kBlock; }
};

/// H = F B takes the fit of B over a node at the mean place and normal of what was hit there, which
/// is right for a B that is linear in these. A form factor that comes of it may be below 0; rows
/// sum to what their hits count.
class CutOperator final : public ExchangeOperator {
 public:
  /// Errors: InputError if the parts do not fit together.
  explicit CutOperator(CutParts parts);

  const CutParts& parts() const { return parts_; }
  std::size_t entries() const;

  std::vector<double> row(std::size_t i) const override;
  bool isNonNegative() const override { return false; }
  std::vector<double> rowNorms() const override;
  std::optional<double> relativeError(std::span<const double> x, int bands) const override;
  std::size_t bytes() const override;

 private:
  void multiply(std::span<const double> x, int bands, std::span<double> y,
                std::span<const std::uint8_t> wanted) const override;

  CutParts parts_;
};

/// sum over the entries of a row of weight(hits) times the field at each, one of the bands of
/// nodeFields(). `kBands` of `stride` bands.
template <int kBands, class Weight>
std::array<double, kBands> sumOfCut(const CutRows& rows, std::size_t row, const NodeField* fields,
                                    std::size_t stride, const Weight& weight) {
  std::array<double, kBands> sum{};
  for (std::size_t e = rows.begin(row); e < rows.ends[row]; ++e) {
    std::array<double, kPatchFeatures> f;
    for (std::size_t k = 0; k < kPatchFeatures; ++k) {
      f[k] = double(rows.places[e][k]) * CutRows::stepOf(k);
    }
    const double times = weight(rows.hits[e]);
    const NodeField* of_node = fields + rows.nodes[e] * stride;
    for (int b = 0; b < kBands; ++b) {
      double beside = 0;
      for (std::size_t k = 0; k < kPatchFeatures; ++k) beside += of_node[b].slope[k] * f[k];
      sum[b] += times * (of_node[b].mean + beside);
    }
  }
  return sum;
}

}  // namespace radiosity
