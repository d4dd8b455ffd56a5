#include "formfactor/cell_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>
#include <utility>

#include "base/geometry/clip.h"

namespace radiosity {
namespace {

/// A part cut by a line into less than this share of itself counts as lying on one side.
constexpr double kSliverCell = 1e-6;

struct Line {
  double a, b, c;
  double at(const Vec2& p) const { return a * p.x + b * p.y + c; }
};

Line lineThrough(const Vec2& p, const Vec2& q) {
  const Vec2 along = glm::normalize(q - p);
  return {-along.y, along.x, along.y * p.x - along.x * p.y};
}

struct Split {
  std::vector<CellPart> inside;
  std::vector<CellPart> outside;
};

Split splitBy(const std::vector<CellPart>& parts, const Line& line) {
  Split split;
  for (const CellPart& part : parts) {
    const double least = kSliverCell * std::abs(polygonArea(part.corners));
    CellPart in{clipConvex(part.corners, line.a, line.b, line.c), part.item};
    CellPart out{clipConvex(part.corners, -line.a, -line.b, -line.c), part.item};
    const bool has_in = std::abs(polygonArea(in.corners)) > least;
    const bool has_out = std::abs(polygonArea(out.corners)) > least;
    if (has_in) split.inside.push_back(std::move(in));
    if (has_out) split.outside.push_back(std::move(out));
  }
  return split;
}

/// The number of parts that reach to one side of a line, on the side with more; slivers count.
std::size_t largerSide(const std::vector<CellPart>& parts, const Line& line) {
  std::size_t inside = 0;
  std::size_t outside = 0;
  for (const CellPart& part : parts) {
    double low = line.at(part.corners.front());
    double high = low;
    for (const Vec2& corner : part.corners) {
      const double height = line.at(corner);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    const double least = kSliverCell * (high - low);
    inside += high > least;
    outside += low < -least;
  }
  return std::max(inside, outside);
}

/// Splits along the edge of a part whose larger half is smallest; an empty split if no edge makes
/// both halves smaller than the whole. `thorough`: all edges are tried, also those that seem no
/// better before slivers are dropped.
std::pair<Line, Split> bestSplit(const std::vector<CellPart>& parts, bool thorough) {
  std::pair<Line, Split> best;
  std::size_t best_size = parts.size();
  for (const CellPart& part : parts) {
    for (std::size_t k = 0, last = part.corners.size() - 1; k < part.corners.size(); last = k++) {
      if (part.corners[last] == part.corners[k]) continue;
      const Line line = lineThrough(part.corners[last], part.corners[k]);
      if (!thorough && largerSide(parts, line) >= best_size) continue;
      Split split = splitBy(parts, line);
      const std::size_t size = std::max(split.inside.size(), split.outside.size());
      if (size < best_size) {
        best_size = size;
        best = {line, std::move(split)};
      }
    }
    // Long lists come from meshes much finer in one place: a fair split is good enough there.
    if (best_size * 3 <= parts.size() * 2) break;
  }
  return best;
}

}  // namespace

std::vector<Vec2> clipConvex(const std::vector<Vec2>& polygon, double a, double b, double c) {
  const Line line{a, b, c};
  std::vector<Vec2> kept;
  clipCorners(
      polygon, [&](const Vec2& p) { return line.at(p); },
      [&](const Vec2& corner) { kept.push_back(corner); });
  return kept;
}

std::int32_t buildCellTree(std::vector<CellPart> parts, std::vector<CellNode>& nodes) {
  const auto same = [&](const CellPart& part) { return part.item == parts.front().item; };
  if (std::all_of(parts.begin(), parts.end(), same)) return parts.front().item;
  auto [line, split] = bestSplit(parts, false);
  if (split.inside.empty() || split.outside.empty()) std::tie(line, split) = bestSplit(parts, true);
  if (split.inside.empty() || split.outside.empty()) return parts.front().item;
  const std::size_t node = nodes.size();
  nodes.push_back({line.a, line.b, line.c, 0, 0});
  const std::int32_t inside = buildCellTree(std::move(split.inside), nodes);
  const std::int32_t outside = buildCellTree(std::move(split.outside), nodes);
  nodes[node].inside = inside;
  nodes[node].outside = outside;
  return ~std::int32_t(node);
}

}  // namespace radiosity
