#include "matrix/cut_operator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "matrix/bands_at_once.h"

namespace radiosity {
namespace {

double hitsApart(const CutRows::Hits& hits) { return double(hits[0]) - double(hits[1]); }

std::array<double, kPatchFeatures> placeOf(const CutRows& rows, std::size_t entry) {
  std::array<double, kPatchFeatures> f{};
  for (std::size_t k = 0; k < kPatchFeatures; ++k)
    f[k] = rows.places[entry][k] * CutRows::stepOf(k);
  return f;
}

double inner(const std::array<double, kPatchFeatures>& a,
             const std::array<double, kPatchFeatures>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < kPatchFeatures; ++k) sum += a[k] * b[k];
  return sum;
}

/// Sums of one row, of all bands.
template <class Weight>
void sumRow(const CutRows& rows, std::size_t row, const NodeField* fields, int bands,
            const Weight& weight, double* sums) {
  forBandsAtOnce(bands, [&]<int kBands>(int b) {
    const auto found = sumOfCut<kBands>(rows, row, fields + b, std::size_t(bands), weight);
    std::copy(found.begin(), found.end(), sums + b);
  });
}

void requireFit(const CutParts& parts) {
  const std::size_t rows = parts.tree.patches().size();
  bool fits = parts.of_a_hit.size() == rows && parts.blocks.size() == CutParts::blocksOf(rows) &&
              (!parts.pairs || parts.pairs->size() == parts.area.size());
  for (const PatchTree::Patch& patch : parts.tree.patches()) {
    fits = fits && patch.patch < parts.area.size();
  }
  for (std::size_t b = 0; b < parts.blocks.size() && fits; ++b) {
    fits = parts.blocks[b].isOf(std::min(CutParts::kBlock, rows - b * CutParts::kBlock),
                                parts.tree.nodes().size());
  }
  if (!fits) throw InputError("form factors: rows that do not fit their tree of patches");
}

}  // namespace

bool CutRows::isOf(std::size_t rows, std::size_t of_nodes) const {
  const std::size_t entries = ends.empty() ? 0 : ends.back();
  return ends.size() == rows && std::ranges::is_sorted(ends) && nodes.size() == entries &&
         hits.size() == entries && places.size() == entries &&
         std::ranges::all_of(nodes, [of_nodes](Index node) { return node < of_nodes; });
}

CutOperator::CutOperator(CutParts parts)
    : ExchangeOperator(parts.area, false), parts_(std::move(parts)) {
  requireFit(parts_);
}

std::size_t CutOperator::entries() const {
  std::size_t sum = 0;
  for (const CutRows& block : parts_.blocks) sum += block.nodes.size();
  return sum;
}

std::size_t CutOperator::bytes() const {
  std::size_t sum = parts_.tree.bytes() + parts_.of_a_hit.size() * sizeof(double);
  for (const CutRows& block : parts_.blocks) sum += block.bytes();
  return sum + (parts_.pairs ? parts_.pairs->bytes() : 0);
}

void CutOperator::multiply(std::span<const double> x, int bands, std::span<double> y,
                           std::span<const std::uint8_t> wanted) const {
  const auto width = std::size_t(bands);
  const auto isWanted = [&](std::size_t i) { return wanted.empty() || wanted[i] != 0; };
  if (parts_.pairs) {
    parts_.pairs->product(x, bands, y, wanted);
  } else {
    for (std::size_t i = 0; i < size(); ++i) {
      if (isWanted(i)) std::fill_n(y.begin() + std::ptrdiff_t(i * width), width, 0.0);
    }
  }
  const std::vector<NodeField> fields = nodeFields(parts_.tree, x, bands);
  parallelFor(parts_.blocks.size(), 1, [&](std::size_t b) {
    std::vector<double> sums(width);
    for (std::size_t r = 0; r < parts_.blocks[b].ends.size(); ++r) {
      const std::size_t place = b * CutParts::kBlock + r;
      const std::size_t i = parts_.tree.patches()[place].patch;
      if (!isWanted(i)) continue;
      sumRow(parts_.blocks[b], r, fields.data(), bands, CutRows::both, sums.data());
      for (std::size_t k = 0; k < width; ++k) y[i * width + k] += parts_.of_a_hit[place] * sums[k];
    }
  });
}

std::vector<double> CutOperator::row(std::size_t i) const {
  std::vector<double> values = parts_.pairs ? parts_.pairs->row(i) : std::vector<double>(size());
  const auto patches = parts_.tree.patches();
  const auto found = std::ranges::find(patches, Index(i), &PatchTree::Patch::patch);
  if (found == patches.end()) return values;
  const auto place = std::size_t(found - patches.begin());
  const CutRows& rows = parts_.blocks[place / CutParts::kBlock];
  const std::size_t row = place % CutParts::kBlock;
  for (std::size_t e = rows.begin(row); e < rows.ends[row]; ++e) {
    const PatchTree::Node& node = parts_.tree.nodes()[rows.nodes[e]];
    const auto below = patches.subspan(node.begin, node.end - node.begin);
    const double share = parts_.of_a_hit[place] * CutRows::both(rows.hits[e]);
    if (node.isLeaf()) {
      values[below.front().patch] += below.front().counts * share;
      continue;
    }
    const PatchTree::Fit& fit = parts_.tree.fit(rows.nodes[e]);
    const auto slope = fit.solve(placeOf(rows, e));
    double area = 0;
    for (const PatchTree::Patch& patch : below) area += patch.area;
    for (const PatchTree::Patch& patch : below) {
      const auto f = fit.relative(
          {patch.at[0], patch.at[1], patch.at[2], patch.at[3], patch.at[4], patch.at[5]});
      values[patch.patch] += share * patch.counts * patch.area / area * (1 + inner(f, slope));
    }
  }
  return values;
}

// The weights of a node's patches are c_j A_j / A (1 + f_j' v), v = C^-1 f, c_j what they count. By
// Cauchy and Schwarz their absolute values sum to no more than the root of the mean of c_j^2 times
// that of 1 + v' C v, and v' C v <= f' C^-1 f.
std::vector<double> CutOperator::rowNorms() const {
  std::vector<double> norms =
      parts_.pairs ? parts_.pairs->rowSums() : std::vector<double>(size(), 0.0);
  std::vector<double> counts(size(), 0.0);
  for (const PatchTree::Patch& patch : parts_.tree.patches()) counts[patch.patch] = patch.counts;
  const std::vector<NodeField> squares = nodeFields(parts_.tree, counts, 1);
  parallelFor(parts_.blocks.size(), 1, [&](std::size_t b) {
    const CutRows& rows = parts_.blocks[b];
    for (std::size_t r = 0; r < rows.ends.size(); ++r) {
      const std::size_t place = b * CutParts::kBlock + r;
      double sum = 0;
      for (std::size_t e = rows.begin(r); e < rows.ends[r]; ++e) {
        double along = 0;
        if (!parts_.tree.nodes()[rows.nodes[e]].isLeaf()) {
          const std::array<double, kPatchFeatures> f = placeOf(rows, e);
          along = inner(f, parts_.tree.fit(rows.nodes[e]).solve(f));
        }
        sum += CutRows::both(rows.hits[e]) *
               std::sqrt(squares[rows.nodes[e]].mean * (1 + std::max(0.0, along)));
      }
      norms[parts_.tree.patches()[place].patch] += parts_.of_a_hit[place] * sum;
    }
  });
  return norms;
}

// Half the difference of two independent estimates is, in the mean square, the error of their mean.
std::optional<double> CutOperator::relativeError(std::span<const double> x, int bands) const {
  const auto width = std::size_t(bands);
  std::vector<double> y(size() * width);
  product(x, bands, y);
  const std::vector<NodeField> fields = nodeFields(parts_.tree, x, bands);
  std::vector<double> squares(parts_.blocks.size(), 0.0);
  parallelFor(parts_.blocks.size(), 1, [&](std::size_t b) {
    std::vector<double> sums(width);
    for (std::size_t r = 0; r < parts_.blocks[b].ends.size(); ++r) {
      const std::size_t place = b * CutParts::kBlock + r;
      const double area = this->area()[parts_.tree.patches()[place].patch];
      sumRow(parts_.blocks[b], r, fields.data(), bands, hitsApart, sums.data());
      for (const double sum : sums) {
        const double error = parts_.of_a_hit[place] * sum;
        squares[b] += area * error * error;
      }
    }
  });
  double norm = 0;
  for (std::size_t k = 0; k < y.size(); ++k) norm += area()[k / width] * y[k] * y[k];
  double square = 0;
  for (const double of_block : squares) square += of_block;
  if (!(norm > 0)) return std::nullopt;
  return std::hypot(std::sqrt(square / norm), parts_.bias);
}

}  // namespace radiosity
