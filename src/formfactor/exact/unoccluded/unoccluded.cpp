#include "formfactor/exact/unoccluded/unoccluded.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "base/geometry/plane_frame.h"
#include "formfactor/exact/unoccluded/far_kernels.h"
#include "formfactor/exact/unoccluded/near_exchange.h"
#include "visibility/clipping/flat_polygon.h"

namespace radiosity {
namespace {

/// Single precision keeps a value to about 1e-6.
constexpr double kFinestInSinglePrecision = 3e-6;
/// Columns of a row that are handled at a time: their data stays in the first-level cache.
constexpr Index kTile = 256;

enum class Side : std::uint8_t { front, crossing, behind };

/// The side of a plane on which an element lies; within coincidence of the plane counts as behind.
Side sideOf(const ElementSet& elements, Index element, const FacetFrame& plane) {
  const double middle = glm::dot(plane.normal, elements.centroid[element]) - plane.offset;
  if (middle > elements.radius[element]) return Side::front;
  if (middle < -elements.radius[element]) return Side::behind;
  double low = 0;
  double high = 0;
  for (const Vec3& corner : elements.corners[element]) {
    const double height = glm::dot(plane.normal, corner) - plane.offset;
    low = std::min(low, height);
    high = std::max(high, height);
  }
  if (high <= elements.coincidence) return Side::behind;
  return low < -elements.coincidence ? Side::crossing : Side::front;
}

FacetFrame frameOf(const ElementSet& elements, const Facet& facet) {
  const auto& bounds = elements.clusters[facet.root].bounds;
  Vec3 along = bounds[1] - bounds[0];
  if (!(glm::length(along) > 0)) along = axisAcross(facet.normal);
  const PlaneFrame frame = makeFrame(Vec3(0.0), facet.normal, along);
  return {frame.u, frame.v, facet.normal, facet.offset};
}

/// A part of an element: a triangle or convex quadrilateral.
struct ElementPart {
  std::array<Vec3, 4> corners{};
  std::size_t count = 0;
  FlatShape shape;
  FarBounds bounds;
  double radius = 0;
  Index element = 0;

  std::span<const Vec3> outline() const { return {corners.data(), count}; }
};

ElementPart makePart(Index element, std::span<const Vec3> corners, const FacetFrame& frame,
                     const FarLimits& limits) {
  ElementPart part;
  part.element = element;
  part.count = corners.size();
  std::copy(corners.begin(), corners.end(), part.corners.begin());
  part.shape = flatShape(corners, frame);
  part.bounds = limits.of(part.shape);
  for (const Vec3& corner : corners) {
    part.radius = std::max(part.radius, glm::distance(corner, part.shape.centroid));
  }
  return part;
}

/// The part of an element in front of a plane, as one or two parts; parts without area are left
/// out.
void appendFront(const ElementSet& elements, Index element, const FacetFrame& frame,
                 const FacetFrame& plane, const FarLimits& limits,
                 std::vector<ElementPart>& parts) {
  const FlatPolygon front = clipToFront(elements.outline(element), plane.normal, plane.offset);
  const auto append = [&](std::span<const Vec3> corners) {
    ElementPart part = makePart(element, corners, frame, limits);
    if (part.shape.area > 0) parts.push_back(part);
  };
  if (front.count < 3) return;
  append(front.outline().first(std::min<std::size_t>(front.count, 4)));
  if (front.count <= 4) return;
  std::array<Vec3, FlatPolygon::kMostCorners - 2> rest;
  const auto end = std::ranges::copy(front.outline().subspan(3), rest.begin()).out;
  *end = front.corners[0];
  append({rest.begin(), end + 1});
}

}  // namespace

UnoccludedCounts& UnoccludedCounts::operator+=(const UnoccludedCounts& other) {
  contour += other.contour;
  lambert += other.lambert;
  product += other.product;
  clipped += other.clipped;
  return *this;
}

class UnoccludedKernel::Implementation {
 public:
  virtual ~Implementation() = default;
  virtual void block(ElementRange rows, ElementRange columns, double* out, std::size_t stride,
                     UnoccludedCounts& counts) const = 0;
};

/// The part of the kernel that depends on the precision of the distant pairs.
template <class T>
class UnoccludedKernel::Typed : public UnoccludedKernel::Implementation {
 public:
  Typed(const ElementSet& elements, double tolerance, FarFunction<T> far_row,
        const ClipKernels<double>& lambert)
      : elements_(elements),
        tolerance_(tolerance),
        far_row_(far_row),
        lambert_(lambert),
        limits_(tolerance),
        rule_limits_(limits_.template rules<T>()),
        columns_(elements.size()) {
    for (const Facet& facet : elements.facets) frames_.push_back(frameOf(elements, facet));
    shapes_.reserve(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      shapes_.push_back(flatShape(elements.outline(e), frames_[elements.facet[e]]));
      bounds_.push_back(limits_.of(shapes_[e]));
      columns_.set(e, shapes_[e], bounds_[e]);
    }
  }

  void block(ElementRange rows, ElementRange columns, double* out, std::size_t stride,
             UnoccludedCounts& counts) const override {
    if (rows.size() == 0 || columns.size() == 0) return;
    // Blocks may be as small as one pair: their arrays are kept from one to the next.
    static thread_local Tile tile;
    const RangePair work{frames_[elements_.facet[rows.first]],
                         frames_[elements_.facet[columns.first]],
                         rows,
                         columns,
                         out,
                         stride,
                         counts};
    for (Index r = 0; r < rows.size(); ++r) {
      std::fill_n(out + r * stride, columns.size(), 0.0);
    }
    for (Index begin = columns.first; begin < columns.end; begin += kTile) {
      prepare({begin, std::min(begin + kTile, columns.end)}, work, tile);
      if (tile.runs.empty() && tile.parts.empty()) continue;
      for (Index r = rows.first; r < rows.end; ++r) row(r, work, tile);
    }
  }

 private:
  struct RangePair {
    const FacetFrame& row_plane;
    const FacetFrame& column_plane;
    ElementRange rows, columns;
    double* out;
    std::size_t stride;
    UnoccludedCounts& counts;
  };

  /// Some columns, sorted by their side of the rows' plane.
  struct Tile {
    ElementRange elements;
    std::vector<ElementRange> runs;  ///< wholly in front
    std::vector<T> heights;          ///< of `elements`
    std::vector<ElementPart> parts;  ///< of those that cross the plane
    FarColumns<T> part_columns{0};
    std::vector<T> part_heights;
    std::vector<ElementPart> row_parts;
    std::vector<T> values;
  };

  void prepare(ElementRange range, const RangePair& work, Tile& tile) const {
    tile.elements = range;
    tile.runs.clear();
    tile.parts.clear();
    tile.heights.assign(range.size() + kFarPadding, T(0));
    const FacetFrame& plane = work.row_plane;
    for (Index c = range.first; c < range.end; ++c) {
      const Side side = sideOf(elements_, c, plane);
      if (side == Side::front) {
        tile.heights[c - range.first] =
            T(glm::dot(plane.normal, elements_.centroid[c]) - plane.offset);
        if (tile.runs.empty() || tile.runs.back().end != c) tile.runs.push_back({c, c});
        ++tile.runs.back().end;
      } else if (side == Side::crossing) {
        appendFront(elements_, c, work.column_plane, plane, limits_, tile.parts);
      }
    }
    tile.values.resize(std::max<std::size_t>(range.size(), tile.parts.size()) + kFarPadding);
    if (tile.parts.empty()) return;
    tile.part_columns.resize(tile.parts.size());
    tile.part_heights.assign(tile.parts.size() + kFarPadding, T(0));
    for (std::size_t k = 0; k < tile.parts.size(); ++k) {
      const FlatShape& shape = tile.parts[k].shape;
      tile.part_columns.set(k, shape, tile.parts[k].bounds);
      tile.part_heights[k] = T(glm::dot(plane.normal, shape.centroid) - plane.offset);
    }
  }

  void row(Index r, const RangePair& work, Tile& tile) const {
    const Side side = sideOf(elements_, r, work.column_plane);
    if (side == Side::behind) return;
    if (side == Side::front) {
      const ElementPart whole{elements_.corners[r], elements_.corner_count[r], shapes_[r],
                              bounds_[r],           elements_.radius[r],       r};
      rowPart(whole, false, work, tile);
      return;
    }
    tile.row_parts.clear();
    appendFront(elements_, r, work.row_plane, work.column_plane, limits_, tile.row_parts);
    for (const ElementPart& part : tile.row_parts) rowPart(part, true, work, tile);
  }

  void rowPart(const ElementPart& part, bool cut, const RangePair& work, Tile& tile) const {
    FarRow<T> far(part.shape, work.row_plane, work.column_plane, part.bounds);
    double* out = work.out + (part.element - work.rows.first) * work.stride;
    for (const ElementRange& run : tile.runs) {
      const T* heights = tile.heights.data() + (run.first - tile.elements.first);
      const std::size_t near = far_row_(
          far, {&columns_, run.first, run.size(), heights, tile.values.data()}, rule_limits_);
      work.counts.product += run.size() - near;
      if (cut) work.counts.clipped += run.size();
      if (near > 0) {
        for (Index k = 0; k < run.size(); ++k) {
          if (tile.values[k] != T(kNearPair)) continue;
          const Index c = run.first + k;
          const PlanarElement column{elements_.outline(c), work.column_plane.normal,
                                     elements_.centroid[c], elements_.radius[c]};
          out[c - work.columns.first] += nearPair(part, column, work);
          tile.values[k] = 0;
        }
      }
      double* run_out = out + (run.first - work.columns.first);
      // An element that touches the horizon within coincidence may reach below it by its rounding.
      for (Index k = 0; k < run.size(); ++k) run_out[k] += std::max(double(tile.values[k]), 0.0);
    }
    if (!tile.parts.empty()) cutColumns(part, far, out, work, tile);
  }

  void cutColumns(const ElementPart& part, FarRow<T>& far, double* out, const RangePair& work,
                  Tile& tile) const {
    const std::size_t count = tile.parts.size();
    const std::size_t near =
        far_row_(far, {&tile.part_columns, 0, count, tile.part_heights.data(), tile.values.data()},
                 rule_limits_);
    work.counts.product += count - near;
    work.counts.clipped += count;
    for (std::size_t k = 0; k < count; ++k) {
      const ElementPart& column = tile.parts[k];
      const PlanarElement piece{column.outline(), work.column_plane.normal, column.shape.centroid,
                                column.radius};
      out[column.element - work.columns.first] += tile.values[k] == T(kNearPair)
                                                      ? nearPair(part, piece, work)
                                                      : std::max(double(tile.values[k]), 0.0);
    }
  }

  double nearPair(const ElementPart& row, const PlanarElement& column,
                  const RangePair& work) const {
    const NearValue value =
        nearExchange({row.outline(), work.row_plane.normal, row.shape.centroid, row.radius}, column,
                     tolerance_, lambert_);
    ++(value.contour ? work.counts.contour : work.counts.lambert);
    return std::max(value.exchange, 0.0);
  }

  const ElementSet& elements_;
  double tolerance_;
  FarFunction<T> far_row_;
  ClipKernels<double> lambert_;
  FarLimits limits_;
  RuleLimits<T> rule_limits_;
  std::vector<FacetFrame> frames_;
  std::vector<FlatShape> shapes_;
  std::vector<FarBounds> bounds_;
  FarColumns<T> columns_;
};

UnoccludedKernel::UnoccludedKernel(const ElementSet& elements, double tolerance, bool simd) {
  const FarKernels kernels = farKernels(simd);
  const ClipKernels<double> lambert = clipKernels(simd).exact;
  if (tolerance < kFinestInSinglePrecision) {
    implementation_ =
        std::make_unique<Typed<double>>(elements, tolerance, kernels.double_precision, lambert);
  } else {
    implementation_ =
        std::make_unique<Typed<float>>(elements, tolerance, kernels.single_precision, lambert);
  }
}

UnoccludedKernel::~UnoccludedKernel() = default;

void UnoccludedKernel::block(ElementRange rows, ElementRange columns, double* out,
                             std::size_t stride, UnoccludedCounts& counts) const {
  implementation_->block(rows, columns, out, stride, counts);
}

double UnoccludedKernel::pair(Index row, Index column) const {
  double value = 0;
  UnoccludedCounts counts;
  block({row, row + 1}, {column, column + 1}, &value, 1, counts);
  return value;
}

}  // namespace radiosity
