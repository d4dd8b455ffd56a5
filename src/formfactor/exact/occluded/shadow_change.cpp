#include "formfactor/exact/occluded/shadow_change.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

/// Of bodies with more edges, so many are looked at, one of each few that follow each other.
constexpr std::size_t kMostEdges = 64;

/// Which of `step` edges is looked at, of those with the number `group`. Not always the first:
/// hulls may list the edges of one side at even places and those of the other at odd ones. (A
/// column of 69 edges, 1e-3: all 49 points missed 5% of a pair past the side that was left out.)
std::size_t placeIn(std::size_t group, std::size_t step) {
  return std::size_t((std::uint32_t(group) * 0x9e3779b1u) >> 16) % step;
}

/// An edge is taken to be no nearer to an end than this share of the way.
constexpr double kNearest = 0.02;

/// An edge matters if its shadow comes this near to the far element, in the least distance at which
/// it touches it: from the centroids distances are known only about.
constexpr double kReach = 1.5;

/// Width of an element seen edge-on, in its radii.
constexpr double kLeastWidth = 1e-6;

}  // namespace

double ShadowChange::Outline::width(const Vec2& direction) const {
  double most = 0;
  for (std::size_t k = 0; k < count; ++k) {
    most = std::max(most, std::abs(glm::dot(corners[k], direction)));
  }
  return most;
}

ShadowChange::Seen ShadowChange::see(const Vec3& p) const {
  const Vec3 d = p - frame_.origin;
  return {{glm::dot(d, frame_.u), glm::dot(d, frame_.v)}, glm::dot(d, frame_.n)};
}

ShadowChange::Outline ShadowChange::outlineOf(Index element) const {
  Outline outline;
  const Vec2 middle = frame_.flat(elements_.centroid[element]);
  for (const Vec3& p : elements_.outline(element)) {
    outline.corners[outline.count++] = frame_.flat(p) - middle;
  }
  outline.radius = elements_.radius[element];
  return outline;
}

void ShadowChange::begin(Index row, Index column) {
  const Vec3& from = elements_.centroid[row];
  const Vec3 way = elements_.centroid[column] - from;
  length_ = glm::length(way);
  const Vec3 along = way / length_;
  frame_ = makeFrame(from, along, axisAcross(along));
  of_row_ = outlineOf(row);
  of_column_ = outlineOf(column);
  row_ = 0;
  column_ = 0;
}

void ShadowChange::addEdge(const Seen& from, const Seen& to, EdgeChanges& most) const {
  const Vec2 along = to.across - from.across;
  const double length2 = glm::dot(along, along);
  if (!(length2 > 0)) return;  // it is seen as a point
  // Where it passes the line from centroid to centroid.
  const double t = std::clamp(-glm::dot(from.across, along) / length2, 0.0, 1.0);
  const Vec2 nearest = from.across + along * t;
  const double depth = from.depth + (to.depth - from.depth) * t;
  const double to_row = std::clamp(depth, kNearest * length_, (1 - kNearest) * length_);
  const double to_column = length_ - to_row;
  const double reach = kReach * (of_column_.radius * to_row + of_row_.radius * to_column) / length_;
  if (glm::dot(nearest, nearest) > reach * reach) return;
  const Vec2 direction{-along.y, along.x};
  const double row = std::max(of_row_.width(direction), kLeastWidth * of_row_.radius);
  const double column = std::max(of_column_.width(direction), kLeastWidth * of_column_.radius);
  const double moves = row * to_column;
  const double stays = column * to_row;
  if (std::abs(glm::dot(nearest, direction)) * length_ > kReach * (moves + stays)) return;
  most.moved.row = std::max(most.moved.row, moves / stays);
  most.moved.column = std::max(most.moved.column, stays / moves);
  const double narrow = (row * of_column_.radius) / (column * of_row_.radius);
  most.narrow.row = std::max(most.narrow.row, narrow);
  most.narrow.column = std::max(most.narrow.column, 1 / narrow);
}

void ShadowChange::add(const Occluder& body, const BothEnds& distance2) {
  EdgeChanges most;
  const std::size_t step = (body.edges.size() + kMostEdges - 1) / kMostEdges;
  if (step == 1) {
    corners_.clear();
    for (const Vec3& p : body.corners) corners_.push_back(see(p));
    for (const Occluder::Edge& edge : body.edges) {
      addEdge(corners_[edge.from], corners_[edge.to], most);
    }
  } else {
    for (std::size_t k = 0; k < body.edges.size(); k += step) {
      const std::size_t place = std::min(k + placeIn(k / step, step), body.edges.size() - 1);
      const Occluder::Edge& edge = body.edges[place];
      addEdge(see(body.corners[edge.from]), see(body.corners[edge.to]), most);
    }
  }
  // By the nearest edge. The shadow of one that touches the target does not move, but other edges
  // of the same occluder may be a target's size away.
  const double row = of_row_.radius;
  const double column = of_column_.radius;
  const double by_row =
      std::max(std::sqrt(distance2.column) * row / column, row) / std::sqrt(distance2.row);
  const double by_column =
      std::max(std::sqrt(distance2.row) * column / row, column) / std::sqrt(distance2.column);
  row_ = std::max({row_, by_row * most.narrow.row, most.moved.row});
  column_ = std::max({column_, by_column * most.narrow.column, most.moved.column});
}

}  // namespace radiosity
