#include "page/texture_pieces.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <span>
#include <utility>

#include "base/geometry/clip.h"

namespace radiosity::page {

namespace {

/// Of the whole: parts that are smaller are rounding at an edge.
constexpr double kSliver = 1e-6;
/// Of a texture's width, and of a colour: what 32 bits and welded vertices may be off.
constexpr double kSameColour = 1e-4;

using Flat = std::array<Vec2, 3>;

Vec3 weightsAt(const Flat& whole, const Vec2& q) {
  const double area = cross2(whole[1] - whole[0], whole[2] - whole[0]);
  const double second = cross2(q - whole[0], whole[2] - whole[0]) / area;
  const double third = cross2(whole[1] - whole[0], q - whole[0]) / area;
  return {1 - second - third, second, third};
}

bool saysTheSame(const FlatTriangle& a, const FlatTriangle& b, const Flat& at) {
  return std::ranges::all_of(at, [&](const Vec2& q) {
    const Vec2 uv = glm::abs(a.map(q) - b.map(q));
    const Vec3 colour = glm::abs(a.colourAt(q) - b.colourAt(q));
    return std::max({uv.x, uv.y, colour.x, colour.y, colour.z}) <= kSameColour;
  });
}

PieceCorner cornerAt(const FlatTriangle& face, const Vec2& q, const Vec3& weights) {
  return {weights, face.map(q), face.colourAt(q)};
}

Piece wholePiece(const FlatTriangle& face, const Flat& whole) {
  return {cornerAt(face, whole[0], {1, 0, 0}), cornerAt(face, whole[1], {0, 1, 0}),
          cornerAt(face, whole[2], {0, 0, 1})};
}

}  // namespace

TexturePieces::TexturePieces(const Scene& scene, const PatchMesh& mesh)
    : mesh_(mesh), varying_(scene), faces_(scene, mesh, varying_) {
  for (const Index surface : mesh.surface) {
    any_ = any_ || varying_.at(surface);
    any_colours_ = any_colours_ || varying_.coloured[surface];
  }
}

bool TexturePieces::enter(Index patch) {
  triangles_.clear();
  const Index front = mesh_.side[patch] == 0 ? patch : mesh_.twin[patch];
  if (front == kNone || !faces_.varies(front)) return false;
  frame_ = faces_.frameOf(front);
  faces_.forParts(front, varying_.coloured[mesh_.surface[front]],
                  [&](const FlatTriangle& triangle, const auto&, double) {
                    // A patch of several pieces has several parts in one triangle.
                    if (triangles_.empty() || triangles_.back().p != triangle.p)
                      triangles_.push_back(triangle);
                  });
  return !triangles_.empty();
}

void TexturePieces::cut(const std::array<Vec3, 3>& corners,
                        const std::function<void(const Piece&)>& visit) const {
  const Flat whole = {frame_.flat(corners[0]), frame_.flat(corners[1]), frame_.flat(corners[2])};
  const double area = cross2(whole[1] - whole[0], whole[2] - whole[0]) / 2;
  std::vector<std::pair<const FlatTriangle*, std::vector<Vec2>>> parts;
  for (const FlatTriangle& face : triangles_) {
    std::vector<Vec2> part = face.partOf({whole.begin(), whole.end()});
    if (std::abs(polygonArea(part)) > kSliver * std::abs(area)) {
      parts.emplace_back(&face, std::move(part));
    }
  }
  const FlatTriangle& first = parts.empty() ? triangles_.front() : *parts.front().first;
  const bool is_one = std::ranges::all_of(
      parts, [&](const auto& part) { return saysTheSame(first, *part.first, whole); });
  if (is_one) return visit(wholePiece(first, whole));
  for (const auto& [face, part] : parts) {
    const auto corner = [&, of = face](const Vec2& q) {
      return cornerAt(*of, q, weightsAt(whole, q));
    };
    for (std::size_t k = 2; k < part.size(); ++k) {
      const double own = cross2(part[k - 1] - part[0], part[k] - part[0]) / 2;
      if (std::abs(own) <= kSliver * std::abs(area)) continue;
      visit({corner(part[0]), corner(part[k - 1]), corner(part[k])});
    }
  }
}

}  // namespace radiosity::page
