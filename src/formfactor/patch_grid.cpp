#include "formfactor/patch_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/geometry/clip.h"

namespace radiosity {
namespace {

/// Shares of a cell below which an overlap is rounding (see PatchGrid).
constexpr double kSliverPatch = 1e-6;
/// Along one axis; their product is at most 2^24 (see RowMap).
constexpr double kMostCells = 4096;
constexpr std::int32_t kEmpty = std::numeric_limits<std::int32_t>::max();

struct Bounds {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double extent() const { return high - low; }
};

/// Cells [first, end) that an interval touches by more than rounding; at least one.
struct CellRange {
  std::int32_t first, end;
};
CellRange cellRange(const Bounds& bounds, std::int32_t count) {
  const auto first = std::int32_t(std::floor(bounds.low + kSliverPatch));
  const auto end = std::int32_t(std::ceil(bounds.high - kSliverPatch));
  const std::int32_t clamped = std::clamp(first, 0, count - 1);
  return {clamped, std::clamp(end, clamped + 1, count)};
}

std::int32_t nearestCount(double extent) {
  return std::int32_t(std::clamp(std::round(extent), 1.0, kMostCells));
}

bool nearInteger(double x) { return std::abs(x - std::round(x)) < kSliverPatch * x; }

}  // namespace

void PatchGrid::chooseAxes(std::span<const GridPiece> pieces, const Vec3& origin,
                           const Vec3& normal) {
  const std::vector<Vec3>& corners = pieces.front().corners;
  const Vec3 a = corners[1] - corners[0];
  Vec3 b = corners.back() - corners[0];
  // Nearly parallel edges make useless axes.
  if (glm::length(glm::cross(a, b)) < 0.25 * glm::length(a) * glm::length(b)) {
    b = glm::cross(normal, a);
  }
  const Vec3 across_b = glm::cross(b, normal);
  const Vec3 across_a = glm::cross(normal, a);
  u_axis_ = across_b / glm::dot(a, across_b);
  v_axis_ = across_a / glm::dot(b, across_a);

  Bounds u;
  Bounds v;
  for (const GridPiece& piece : pieces) {
    for (const Vec3& corner : piece.corners) {
      u.add(glm::dot(u_axis_, corner - origin));
      v.add(glm::dot(v_axis_, corner - origin));
    }
  }
  const double count = double(pieces.size());
  const double fitting = u.extent() * v.extent();
  columns_ = nearestCount(u.extent());
  rows_ = nearestCount(v.extent());
  const double cells = double(columns_) * rows_;
  const bool regular = nearInteger(u.extent()) && nearInteger(v.extent()) && cells <= 4 * count &&
                       cells >= count / 4;
  // One quadrilateral or two triangles a cell: rows and columns, if not quite parallelograms.
  if (!regular && cells != count && 2 * cells != count) {
    const double fine = std::sqrt(2 * count / fitting);
    columns_ = nearestCount(std::ceil(u.extent() * fine));
    rows_ = nearestCount(std::ceil(2 * count / columns_));
  }
  const double u_scale = columns_ / u.extent();
  const double v_scale = rows_ / v.extent();
  u_axis_ *= u_scale;
  v_axis_ *= v_scale;
  u_offset_ = -u.low * u_scale;
  v_offset_ = -v.low * v_scale;
}

PatchGrid::PatchGrid(std::span<const GridPiece> pieces, const Vec3& origin, const Vec3& normal) {
  chooseAxes(pieces, origin, normal);
  std::vector<std::vector<CellPart>> parts(std::size_t(columns_) * std::size_t(rows_));
  for (const GridPiece& piece : pieces) {
    std::vector<Vec2> outline;
    Bounds u;
    Bounds v;
    for (const Vec3& corner : piece.corners) {
      outline.emplace_back(glm::dot(u_axis_, corner - origin) + u_offset_,
                           glm::dot(v_axis_, corner - origin) + v_offset_);
      u.add(outline.back().x);
      v.add(outline.back().y);
    }
    const double least = kSliverPatch * std::min(2 * std::abs(polygonArea(outline)), 1.0);
    const CellRange columns = cellRange(u, columns_);
    const CellRange rows = cellRange(v, rows_);
    for (std::int32_t column = columns.first; column < columns.end; ++column) {
      std::vector<Vec2> strip = clipConvex(outline, 1, 0, -column);
      strip = clipConvex(strip, -1, 0, column + 1.0);
      for (std::int32_t row = rows.first; row < rows.end; ++row) {
        std::vector<Vec2> part = clipConvex(strip, 0, 1, -row);
        part = clipConvex(part, 0, -1, row + 1.0);
        if (!(2 * std::abs(polygonArea(part)) > least)) continue;
        parts[std::size_t(row) * std::size_t(columns_) + std::size_t(column)].push_back(
            {std::move(part), piece.item});
      }
    }
  }
  cells_.reserve(parts.size());
  for (std::vector<CellPart>& cell : parts) {
    cells_.push_back(cell.empty() ? kEmpty : buildCellTree(std::move(cell), nodes_));
  }
  fillEmptyCells();
  moveToCellCentres();
}

/// Moves the cells so that their centres, not their corners, have whole coordinates: look-ups
/// round.
void PatchGrid::moveToCellCentres() {
  u_offset_ -= 0.5;
  v_offset_ -= 0.5;
  for (CellNode& node : nodes_) node.c += 0.5 * (node.a + node.b);
}

/// Cells outside the polygon take an item of the nearest cell that has one (in steps across cell
/// edges): pixels on the polygon's rim fall there by rounding.
void PatchGrid::fillEmptyCells() {
  const auto firstItem = [&](std::int32_t entry) {
    while (entry < 0) entry = node(~entry).inside;
    return entry;
  };
  const std::int32_t count = columns_ * rows_;
  std::vector<std::int32_t> front;
  for (std::int32_t cell = 0; cell < count; ++cell) {
    if (cells_[std::size_t(cell)] != kEmpty) front.push_back(cell);
  }
  for (std::size_t k = 0; k < front.size(); ++k) {
    const std::int32_t cell = front[k];
    const std::int32_t column = cell % columns_;
    const std::int32_t item = firstItem(cells_[std::size_t(cell)]);
    const auto spread = [&](bool exists, std::int32_t neighbour) {
      if (!exists || cells_[std::size_t(neighbour)] != kEmpty) return;
      cells_[std::size_t(neighbour)] = item;
      front.push_back(neighbour);
    };
    spread(column > 0, cell - 1);
    spread(column + 1 < columns_, cell + 1);
    spread(cell >= columns_, cell - columns_);
    spread(cell + columns_ < count, cell + columns_);
  }
}

}  // namespace radiosity
