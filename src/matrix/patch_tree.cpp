#include "matrix/patch_tree.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "matrix/bands_at_once.h"

namespace radiosity {
namespace {

using Vector = Eigen::Matrix<double, kPatchFeatures, 1>;
using Square = Eigen::Matrix<double, kPatchFeatures, kPatchFeatures>;

std::size_t middleOf(std::size_t begin, std::size_t end) { return begin + (end - begin) / 2; }

/// The share of the largest variance that is added to all: features that hardly spread have no say.
constexpr double kHeldVariance = 0.01;

Vector vectorOf(const PatchTree::Features& at) {
  return Eigen::Map<const Eigen::Matrix<float, kPatchFeatures, 1>>(at.data()).cast<double>();
}

struct Spread {
  Vector middle = Vector::Zero();
  double radius = 0;
  Square covariance = Square::Zero();  ///< of f
};

Spread spreadOf(std::span<const PatchTree::Patch> patches) {
  Spread spread;
  double area = 0;
  for (const PatchTree::Patch& patch : patches) {
    area += patch.area;
    spread.middle += patch.area * vectorOf(patch.at);
  }
  spread.middle /= area;
  double square = 0;
  for (const PatchTree::Patch& patch : patches) {
    square = std::max(square, (vectorOf(patch.at) - spread.middle).head<3>().squaredNorm());
  }
  spread.radius = std::sqrt(square);
  for (const PatchTree::Patch& patch : patches) {
    Vector f = vectorOf(patch.at) - spread.middle;
    if (spread.radius > 0) f.head<3>() /= spread.radius;
    spread.covariance += patch.area * f * f.transpose();
  }
  spread.covariance /= area;
  return spread;
}

/// The feature over which patches spread most.
std::size_t widestOf(std::span<const PatchTree::Patch> patches) {
  std::size_t widest = 0;
  spreadOf(patches).covariance.diagonal().maxCoeff(&widest);
  return widest;
}

PatchTree::Fit fitOf(std::span<const PatchTree::Patch> patches) {
  Spread spread = spreadOf(patches);
  PatchTree::Fit fit;
  fit.radius = spread.radius;
  Eigen::Map<Vector>(fit.middle.data()) = spread.middle;
  const double most = spread.covariance.diagonal().maxCoeff();
  if (!(most > 0)) return fit;
  spread.covariance.diagonal().array() += kHeldVariance * most;
  const Square solved = spread.covariance.llt().solve(Square::Identity());
  const Square inverse = 0.5 * (solved + solved.transpose());  // alike from both sides, to the bit
  Eigen::Map<Eigen::Matrix<float, kPatchFeatures, kPatchFeatures>>(fit.inverse.data()) =
      inverse.cast<float>();
  return fit;
}

/// Sums over a node, with f about its middle but not divided by its radius.
template <int kBands>
struct Moments {
  std::array<double, kBands> sum{};                                 ///< of area times B
  std::array<std::array<double, kPatchFeatures>, kBands> with_f{};  ///< of area times B times f
};

/// Fills in the fields of the nodes below one, from the leaves up.
template <int kBands>
class UpSweep {
 public:
  UpSweep(const PatchTree& tree, const double* x, std::size_t stride, NodeField* fields)
      : tree_(tree), x_(x), stride_(stride), fields_(fields) {}

  Moments<kBands> operator()(std::size_t node, double& area) const {
    const PatchTree::Node& of = tree_.nodes()[node];
    if (of.isLeaf()) return leaf(node, area);
    std::array<double, 2> areas{};
    std::array<Moments<kBands>, 2> below;
    const std::array<std::size_t, 2> children{tree_.first(node), tree_.second(node)};
    inHalves(
        of.end - of.begin, [&] { below[0] = (*this)(children[0], areas[0]); },
        [&] { below[1] = (*this)(children[1], areas[1]); });
    area = areas[0] + areas[1];
    return inner(node, children, below, area);
  }

 private:
  Moments<kBands> leaf(std::size_t node, double& area) const {
    const PatchTree::Patch& patch = tree_.patches()[tree_.nodes()[node].begin];
    area = patch.area;
    Moments<kBands> moments;
    for (std::size_t b = 0; b < kBands; ++b) {
      const double value = patch.counts * x_[patch.patch * stride_ + b];
      moments.sum[b] = patch.area * value;
      fields_[node * stride_ + b] = {value, {}};
    }
    return moments;
  }

  Moments<kBands> inner(std::size_t node, const std::array<std::size_t, 2>& children,
                        const std::array<Moments<kBands>, 2>& below, double area) const {
    const PatchTree::Fit& fit = tree_.fit(node);
    Moments<kBands> moments;
    for (std::size_t c = 0; c < 2; ++c) {
      std::array<double, kPatchFeatures> moved{};
      for (std::size_t k = 0; k < kPatchFeatures; ++k) {
        moved[k] = tree_.middle(children[c], k) - fit.middle[k];
      }
      for (std::size_t b = 0; b < kBands; ++b) {
        moments.sum[b] += below[c].sum[b];
        for (std::size_t k = 0; k < kPatchFeatures; ++k) {
          moments.with_f[b][k] += below[c].with_f[b][k] + moved[k] * below[c].sum[b];
        }
      }
    }
    for (std::size_t b = 0; b < kBands; ++b) {
      std::array<double, kPatchFeatures> mean{};
      for (std::size_t k = 0; k < kPatchFeatures; ++k) {
        const double unit = fit.unitOf(k) * area;
        mean[k] = unit > 0 ? moments.with_f[b][k] / unit : 0.0;
      }
      fields_[node * stride_ + b] = {moments.sum[b] / area, fit.solve(mean)};
    }
    return moments;
  }

  const PatchTree& tree_;
  const double* x_;
  std::size_t stride_;
  NodeField* fields_;
};

}  // namespace

std::array<double, kPatchFeatures> PatchTree::Fit::relative(
    const std::array<double, kPatchFeatures>& at) const {
  std::array<double, kPatchFeatures> f{};
  for (std::size_t k = 0; k < kPatchFeatures; ++k) {
    const double unit = unitOf(k);
    f[k] = unit > 0 ? (at[k] - middle[k]) / unit : 0.0;
  }
  return f;
}

std::array<double, kPatchFeatures> PatchTree::Fit::solve(
    const std::array<double, kPatchFeatures>& f) const {
  std::array<double, kPatchFeatures> solved{};
  for (std::size_t k = 0; k < kPatchFeatures; ++k) {
    for (std::size_t m = 0; m < kPatchFeatures; ++m)
      solved[k] += inverse[kPatchFeatures * k + m] * f[m];
  }
  return solved;
}

PatchTree::PatchTree(std::vector<Patch> patches) : patches_(std::move(patches)) {
  if (patches_.empty()) return;
  sort(0, patches_.size());
  grow();
}

PatchTree PatchTree::ofSorted(std::vector<Patch> patches) {
  PatchTree tree;
  tree.patches_ = std::move(patches);
  if (!tree.patches_.empty()) tree.grow();
  return tree;
}

void PatchTree::sort(std::size_t begin, std::size_t end) {
  if (end - begin <= 1) return;
  const std::span<Patch> patches = std::span(patches_).subspan(begin, end - begin);
  const std::size_t widest = widestOf(patches);
  const auto isBefore = [widest](const Patch& a, const Patch& b) {
    return std::tie(a.at[widest], a.at, a.patch) < std::tie(b.at[widest], b.at, b.patch);
  };
  const std::size_t middle = middleOf(begin, end);
  std::nth_element(patches.begin(), patches.begin() + std::ptrdiff_t(middle - begin), patches.end(),
                   isBefore);
  inHalves(
      end - begin, [&] { sort(begin, middle); }, [&] { sort(middle, end); });
}

void PatchTree::grow() {
  nodes_.resize(2 * patches_.size() - 1);
  fits_.resize(patches_.size() - 1);
  growNode(0, 0, patches_.size());
}

// Once patches are sorted: the bits of a fit depend on their order.
void PatchTree::growNode(std::size_t node, std::size_t begin, std::size_t end) {
  nodes_[node] = {Index(begin), Index(end)};
  if (end - begin <= 1) return;
  fits_[node - begin] = fitOf(std::span(patches_).subspan(begin, end - begin));
  const std::size_t middle = middleOf(begin, end);
  inHalves(
      end - begin, [&] { growNode(node + 1, begin, middle); },
      [&] { growNode(node + 2 * (middle - begin), middle, end); });
}

std::vector<NodeField> nodeFields(const PatchTree& tree, std::span<const double> x, int bands) {
  const auto stride = std::size_t(bands);
  std::vector<NodeField> fields(tree.nodes().size() * stride);
  if (fields.empty()) return fields;
  forBandsAtOnce(bands, [&]<int kBands>(int b) {
    double area = 0;
    UpSweep<kBands>(tree, x.data() + b, stride, fields.data() + b)(0, area);
  });
  return fields;
}

}  // namespace radiosity
