#include "formfactor/exact/partial.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "formfactor/exact/partial_pair.h"
#include "formfactor/exact/sample_cell.h"
#include "formfactor/exact/visible_part.h"

namespace radiosity {
namespace {

/// Cells a pair may be cut into: enough to reach the smallest tolerances, and an end where an
/// estimate never falls.
constexpr std::size_t kMostCells = 4096;

/// One pair, from its first cells to the tolerance.
class PairQuadrature {
 public:
  PairQuadrature(const SampledPair& pair, VisiblePart& eye) : pair_(pair), eye_(eye) {
    // Of a quadrilateral cut by a plane there may be five corners: a quadrilateral and a triangle.
    const std::vector<Vec3>& c = pair.sampled;
    for (std::size_t first = 0; first + 2 < c.size(); first += 2) {
      SampleCell cell;
      cell.corners = {c[0], c[first + 1], c[first + 2], c[std::min(first + 3, c.size() - 1)]};
      look(cell);
      cells_.push_back(cell);
    }
  }

  /// Cuts cells until the error of the visible fraction is below `tolerance`.
  void refine(double tolerance) {
    while (error() > tolerance && cells_.size() < kMostCells) {
      const double share = tolerance * whole() / std::sqrt(double(cells_.size()));
      const double visible_fraction = fraction();
      const std::size_t count = cells_.size();
      for (std::size_t k = 0; k < count; ++k) {
        if (cells_[k].error(visible_fraction) <= share) continue;
        const SampleCell parent = cells_[k];
        for (int c = 0; c < 4; ++c) {
          SampleCell child = parent.child(c);
          look(child);
          if (c == 0) cells_[k] = child;
          if (c > 0) cells_.push_back(child);
        }
      }
    }
  }

  double fraction() const {
    double visible = 0;
    double all = 0;
    for (const SampleCell& cell : cells_) {
      visible += cell.visible();
      all += cell.whole();
    }
    return all > 0 ? visible / all : 0;
  }
  double error() const {
    const double visible_fraction = fraction();
    double sum = 0;
    for (const SampleCell& cell : cells_) {
      const double e = cell.error(visible_fraction);
      sum += e * e;
    }
    const double all = whole();
    return all > 0 ? std::sqrt(sum) / all : 0;
  }
  std::size_t points() const { return points_; }
  std::size_t cells() const { return cells_.size(); }
  bool sampled() const { return sampled_; }

 private:
  double whole() const {
    double all = 0;
    for (const SampleCell& cell : cells_) all += cell.whole();
    return all;
  }

  void look(SampleCell& cell) {
    for (std::size_t k = 0; k < SampleCell::kPoints; ++k) {
      // Shifts of a rank-one lattice (Roberts 2018): the pictures of a pair's points fill each
      // other's gaps.
      const double n = double(points_++);
      const Vec2 shift(0.75487766624669276 * n + 0.5, 0.56984029099805327 * n + 0.5);
      cell.views[k] = eye_.look(cell.point(k).position, pair_.normal, pair_.target, pair_.blockers,
                                shift - Vec2(std::floor(shift.x), std::floor(shift.y)));
      sampled_ |= cell.views[k].sampled;
    }
  }

  const SampledPair& pair_;
  VisiblePart& eye_;
  std::vector<SampleCell> cells_;
  std::size_t points_ = 0;
  bool sampled_ = false;
};

}  // namespace

PartialCounts& PartialCounts::operator+=(const PartialCounts& other) {
  pairs += other.pairs;
  points += other.points;
  subdivided += other.subdivided;
  by_pixels += other.by_pixels;
  hidden += other.hidden;
  return *this;
}

PartialKernel::PartialKernel(const ElementSet& elements, const OccluderSet& occluders,
                             double tolerance, bool simd)
    : elements_(elements), occluders_(occluders), tolerance_(tolerance), simd_(simd) {}

PartialExchange PartialKernel::evaluatePair(const PartialPair& pair,
                                            std::span<const Index> occluder_list, SampledEnd end,
                                            VisiblePart& eye, PartialCounts& counts) const {
  ++counts.pairs;
  const auto blockers =
      occluder_list.subspan(pair.occluders_begin, pair.occluders_end - pair.occluders_begin);
  const SampledPair sampled =
      samplePair(elements_, occluders_, pair.row, pair.column, blockers, end);
  PartialExchange result;
  if (!sampled.sampled.empty() && !sampled.target.empty() && pair.unoccluded > 0) {
    PairQuadrature quadrature(sampled, eye);
    const std::size_t first = quadrature.cells();
    const double allowed = tolerance_ / double(elements_.patch_elements) *
                           std::min(elements_.area[pair.row], elements_.area[pair.column]);
    quadrature.refine(allowed / pair.unoccluded);
    result.exchange = pair.unoccluded * quadrature.fraction();
    result.error = pair.unoccluded * quadrature.error();
    counts.points += quadrature.points();
    counts.subdivided += quadrature.cells() > first;
    counts.by_pixels += quadrature.sampled();
  }
  counts.hidden += result.exchange == 0;
  return result;
}

void PartialKernel::evaluate(std::span<const PartialPair> pairs,
                             std::span<const Index> occluder_list, std::span<PartialExchange> out,
                             PartialCounts& counts) const {
  VisiblePart eye;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PartialPair& pair = pairs[k];
    const auto blockers =
        occluder_list.subspan(pair.occluders_begin, pair.occluders_end - pair.occluders_begin);
    const SampledEnd end = fartherEnd(elements_, occluders_, pair.row, pair.column, blockers);
    out[k] = evaluatePair(pair, occluder_list, end, eye, counts);
  }
}

PartialExchange PartialKernel::evaluateFromOtherEnd(const PartialPair& pair,
                                                    std::span<const Index> occluder_list) const {
  const auto blockers =
      occluder_list.subspan(pair.occluders_begin, pair.occluders_end - pair.occluders_begin);
  const SampledEnd end = fartherEnd(elements_, occluders_, pair.row, pair.column, blockers);
  VisiblePart eye;
  PartialCounts counts;
  return evaluatePair(pair, occluder_list,
                      end == SampledEnd::row ? SampledEnd::column : SampledEnd::row, eye, counts);
}

}  // namespace radiosity
