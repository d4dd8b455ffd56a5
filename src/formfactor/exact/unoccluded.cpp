#include "formfactor/exact/unoccluded.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "formfactor/exact/far_kernels.h"
#include "formfactor/exact/flat_polygon.h"
#include "formfactor/exact/near_exchange.h"
#include "mesh/plane_frame.h"

namespace radiosity {
namespace {

/// Single precision keeps a value to about 1e-6.
constexpr double kFinestInSinglePrecision = 3e-6;
/// Columns of a row that are handled at a time: what they need stays in the first-level cache.
constexpr Index kTile = 256;

enum class Side : std::uint8_t { front, crossing, behind };

/// Where a polygon lies of a plane; what keeps within coincidence of it is behind.
Side sideOf(std::span<const Vec3> outline, const FacetFrame& plane, double coincidence) {
  double low = 0;
  double high = 0;
  for (const Vec3& corner : outline) {
    const double height = glm::dot(plane.normal, corner) - plane.offset;
    low = std::min(low, height);
    high = std::max(high, height);
  }
  if (high <= coincidence) return Side::behind;
  return low < -coincidence ? Side::crossing : Side::front;
}

FacetFrame frameOf(const ElementSet& elements, const Facet& facet) {
  const auto& bounds = elements.clusters[facet.root].bounds;
  Vec3 along = bounds[1] - bounds[0];
  if (!(glm::length(along) > 0)) along = axisAcross(facet.normal);
  const PlaneFrame frame = makeFrame(Vec3(0.0), facet.normal, along);
  return {frame.u, frame.v, facet.normal, facet.offset};
}

/// A part of an element: a triangle or convex quadrilateral.
struct Part {
  std::array<Vec3, 4> corners{};
  std::size_t count = 0;
  FlatShape shape;
  double radius = 0;
  Index element = 0;

  std::span<const Vec3> outline() const { return {corners.data(), count}; }
};

Part makePart(Index element, std::span<const Vec3> corners, const FacetFrame& frame) {
  Part part;
  part.element = element;
  part.count = corners.size();
  std::copy(corners.begin(), corners.end(), part.corners.begin());
  part.shape = flatShape(corners, frame);
  for (const Vec3& corner : corners) {
    part.radius = std::max(part.radius, glm::distance(corner, part.shape.centroid));
  }
  return part;
}

/// The part of an element in front of a plane, as one or two parts; what has no area is left out.
void appendFront(const ElementSet& elements, Index element, const FacetFrame& frame,
                 const FacetFrame& plane, std::vector<Part>& parts) {
  const FlatPolygon front = clipToFront(elements.outline(element), plane.normal, plane.offset);
  const auto append = [&](std::span<const Vec3> corners) {
    Part part = makePart(element, corners, frame);
    if (part.shape.area > 0) parts.push_back(part);
  };
  if (front.count < 3) return;
  append(front.outline().first(std::min<std::size_t>(front.count, 4)));
  if (front.count == 5) append(std::array{front.corners[3], front.corners[4], front.corners[0]});
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

/// All that depends on the precision of the distant pairs.
template <class T>
class UnoccludedKernel::Typed : public UnoccludedKernel::Implementation {
 public:
  Typed(const ElementSet& elements, double tolerance, FarFunction<T> far_row)
      : elements_(elements),
        tolerance_(tolerance),
        far_row_(far_row),
        limits_(tolerance),
        columns_(elements.size()) {
    for (std::size_t k = 0; k < kProductRules; ++k) product_limits_[k] = T(limits_.product[k]);
    for (const Facet& facet : elements.facets) frames_.push_back(frameOf(elements, facet));
    shapes_.reserve(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      shapes_.push_back(flatShape(elements.outline(e), frames_[elements.facet[e]]));
      columns_.set(e, shapes_[e], limits_.of(shapes_[e]));
    }
  }

  void block(ElementRange rows, ElementRange columns, double* out, std::size_t stride,
             UnoccludedCounts& counts) const override {
    if (rows.size() == 0 || columns.size() == 0) return;
    Work work{frames_[elements_.facet[rows.first]],
              frames_[elements_.facet[columns.first]],
              rows,
              columns,
              out,
              stride,
              counts,
              {},
              {}};
    for (Index r = 0; r < rows.size(); ++r) {
      std::fill_n(out + r * stride, columns.size(), 0.0);
    }
    for (Index begin = columns.first; begin < columns.end; begin += kTile) {
      const ElementRange tile{begin, std::min(begin + kTile, columns.end)};
      Tile prepared = prepare(tile, work);
      for (Index r = rows.first; r < rows.end; ++r) row(r, prepared, work);
    }
  }

 private:
  struct Work {
    const FacetFrame& row_plane;
    const FacetFrame& column_plane;
    ElementRange rows, columns;
    double* out;
    std::size_t stride;
    UnoccludedCounts& counts;
    std::vector<Part> row_parts;
    std::vector<T> values;
  };

  /// Some columns, sorted out by where they lie of the rows' plane.
  struct Tile {
    ElementRange elements;
    std::vector<ElementRange> runs;  ///< wholly in front
    std::vector<T> heights;          ///< of `elements`
    std::vector<Part> parts;         ///< of those that cross the plane
    FarColumns<T> part_columns{0};
    std::vector<T> part_heights;
  };

  Tile prepare(ElementRange range, Work& work) const {
    Tile tile;
    tile.elements = range;
    tile.heights.assign(range.size() + kFarPadding, T(0));
    const FacetFrame& plane = work.row_plane;
    for (Index c = range.first; c < range.end; ++c) {
      const Side side = sideOf(elements_.outline(c), plane, elements_.coincidence);
      if (side == Side::front) {
        tile.heights[c - range.first] =
            T(glm::dot(plane.normal, shapes_[c].centroid) - plane.offset);
        if (tile.runs.empty() || tile.runs.back().end != c) tile.runs.push_back({c, c});
        ++tile.runs.back().end;
      } else if (side == Side::crossing) {
        appendFront(elements_, c, work.column_plane, plane, tile.parts);
      }
    }
    if (tile.parts.empty()) return tile;
    tile.part_columns = FarColumns<T>(tile.parts.size());
    tile.part_heights.assign(tile.parts.size() + kFarPadding, T(0));
    for (std::size_t k = 0; k < tile.parts.size(); ++k) {
      const FlatShape& shape = tile.parts[k].shape;
      tile.part_columns.set(k, shape, limits_.of(shape));
      tile.part_heights[k] = T(glm::dot(plane.normal, shape.centroid) - plane.offset);
    }
    return tile;
  }

  void row(Index r, const Tile& tile, Work& work) const {
    const Side side = sideOf(elements_.outline(r), work.column_plane, elements_.coincidence);
    if (side == Side::behind) return;
    if (side == Side::front) {
      Part whole{elements_.corners[r], elements_.corner_count[r], shapes_[r], elements_.radius[r],
                 r};
      rowPart(whole, false, tile, work);
      return;
    }
    work.row_parts.clear();
    appendFront(elements_, r, work.row_plane, work.column_plane, work.row_parts);
    for (const Part& part : work.row_parts) rowPart(part, true, tile, work);
  }

  void rowPart(const Part& part, bool cut, const Tile& tile, Work& work) const {
    FarRow<T> far(part.shape, work.row_plane, work.column_plane, limits_.of(part.shape));
    double* out = work.out + (part.element - work.rows.first) * work.stride;
    work.values.resize(kTile * 2 + kFarPadding);
    for (const ElementRange& run : tile.runs) {
      const T* heights = tile.heights.data() + (run.first - tile.elements.first);
      const FarBatch<T> batch{&columns_, run.first, run.size(), heights, work.values.data()};
      const std::size_t near = far_row_(far, batch, product_limits_);
      work.counts.product += run.size() - near;
      if (cut) work.counts.clipped += run.size();
      for (Index k = 0; k < run.size(); ++k) {
        const Index c = run.first + k;
        const T value = work.values[k];
        out[c - work.columns.first] +=
            value == T(kNearPair) ? nearPair(part,
                                             {elements_.outline(c), work.column_plane.normal,
                                              shapes_[c].centroid, elements_.radius[c]},
                                             work)
                                  : double(value);
      }
    }
    if (tile.parts.empty()) return;
    const FarBatch<T> batch{&tile.part_columns, 0, tile.parts.size(), tile.part_heights.data(),
                            work.values.data()};
    const std::size_t near = far_row_(far, batch, product_limits_);
    work.counts.product += tile.parts.size() - near;
    work.counts.clipped += tile.parts.size();
    for (std::size_t k = 0; k < tile.parts.size(); ++k) {
      const Part& column = tile.parts[k];
      const T value = work.values[k];
      out[column.element - work.columns.first] +=
          value == T(kNearPair) ? nearPair(part,
                                           {column.outline(), work.column_plane.normal,
                                            column.shape.centroid, column.radius},
                                           work)
                                : double(value);
    }
  }

  double nearPair(const Part& row, const PlanarElement& column, Work& work) const {
    const NearValue value = nearExchange(
        {row.outline(), work.row_plane.normal, row.shape.centroid, row.radius}, column, tolerance_);
    ++(value.contour ? work.counts.contour : work.counts.lambert);
    return std::max(value.exchange, 0.0);
  }

  const ElementSet& elements_;
  double tolerance_;
  FarFunction<T> far_row_;
  FarLimits limits_;
  std::array<T, kProductRules> product_limits_{};
  std::vector<FacetFrame> frames_;
  std::vector<FlatShape> shapes_;
  FarColumns<T> columns_;
};

UnoccludedKernel::UnoccludedKernel(const ElementSet& elements, double tolerance, bool simd) {
  const FarKernels kernels = simd ? simdFarKernels() : scalarFarKernels();
  if (tolerance < kFinestInSinglePrecision) {
    implementation_ =
        std::make_unique<Typed<double>>(elements, tolerance, kernels.double_precision);
  } else {
    implementation_ = std::make_unique<Typed<float>>(elements, tolerance, kernels.single_precision);
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
