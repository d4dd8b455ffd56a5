#include "formfactor/exact/occluded/critical_lines.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace radiosity {
namespace {

/// Parts narrower than this share of the polygon are not cut off.
constexpr double kNarrow = 1e-9;

/// Heights this close, relative to one of them, are alike: from a corner that high, an edge is
/// projected to where no polygon is.
constexpr double kLevel = 1e-6;

/// As far as any polygon reaches, in ElementSet's units.
constexpr double kFarAway = 4;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The part of a segment between two heights, as parameters.
struct Range {
  double begin = 0;
  double end = 1;
  /// Keeps where a quantity that goes from a to b is not negative.
  void keep(double a, double b) {
    if (a < 0 && b < 0) end = begin;
    if (a < 0 && b >= 0) begin = std::max(begin, a / (a - b));
    if (b < 0 && a >= 0) end = std::min(end, a / (a - b));
  }
  bool empty() const { return !(begin < end); }
};

/// The parameter at which an edge meets the plane of height 0; outside [0, 1] if it does not.
double footOf(double from, double to, double touching) {
  if (std::min(from, to) > touching || std::max(from, to) < touching) return -1;
  if (std::min(from, to) < -touching) return from / (from - to);
  return from < to ? 0.0 : 1.0;
}

Range between(double from, double to, double low, double high) {
  Range range;
  range.keep(from - low, to - low);
  if (high < kInfinity) range.keep(high - from, high - to);
  return range;
}

}  // namespace

bool CriticalLines::cut(std::span<const Vec3> polygon, const Vec3& normal,
                        std::span<const Vec3> target, std::span<const Blocker> blockers,
                        double coincidence, std::size_t most_parts) {
  if (tooManyEdges(blockers)) return false;
  frame_ = makeFrame(polygon[0], normal, axisAcross(normal));
  coincidence_ = coincidence;
  most_parts_ = most_parts;
  too_many_ = false;
  if (parts_.size() < most_parts) parts_.resize(most_parts);
  count_ = 1;
  parts_[0].clear();
  double size = 0;
  for (const Vec3& p : polygon) {
    parts_[0].push_back(frame_.flat(p));
    size = std::max(size, glm::length(parts_[0].back()));
  }
  narrow_ = kNarrow * size;
  findFeet(target, blockers);
  for (const Blocker& blocker : blockers) {
    const Occluder& body = *blocker.body;
    facePlanes(body);
    for (std::size_t k = 0; k < target.size() && !too_many_; ++k) {
      edgesPastCorner(target[k], body);
      cornersPastEdge({target[k], target[(k + 1) % target.size()]}, body);
    }
    for (const Blocker& behind : blockers) {
      if (behind.body == blocker.body || too_many_) continue;
      for (const Vec3& corner : behind.body->corners) edgesPastCorner(corner, body);
      for (const Occluder::Edge& edge : behind.body->edges) {
        cornersPastEdge({behind.body->corners[edge.from], behind.body->corners[edge.to]}, body);
      }
    }
  }
  return !too_many_;
}

bool CriticalLines::tooManyEdges(std::span<const Blocker> blockers) const {
  std::size_t edges = 0;
  for (const Blocker& blocker : blockers) edges += blocker.body->edges.size();
  return edges > kMostEdges;
}

/// Cuts where an eye sees an edge of the body's outline pass a corner that is farther away.
void CriticalLines::edgesPastCorner(const Vec3& corner, const Occluder& body) {
  const double high = height(corner);
  if (high <= coincidence_) {
    if (high >= -coincidence_) edgesPastFoot(corner, body);
    return;
  }
  const auto side = [&](Index plane) {
    const double d = glm::dot(body.planes[plane].normal, corner) - body.planes[plane].offset;
    return d > coincidence_ ? 1 : (d < -coincidence_ ? -1 : 0);
  };
  for (const Occluder::Edge& edge : body.edges) {
    // For a corner in the plane of a face, rounding would choose the side: it may be either.
    if (side(edge.left) * side(edge.right) > 0) continue;
    const Vec3& from = body.corners[edge.from];
    const Vec3& to = body.corners[edge.to];
    const double h0 = height(from);
    const double h1 = height(to);
    const Range range = between(h0, h1, -coincidence_, high * (1 - kLevel));
    if (range.empty()) continue;
    const auto project = [&](double t) {
      const Vec3 p = from + (to - from) * t;
      return frame_.flat(corner + (p - corner) * (high / (high - (h0 + (h1 - h0) * t))));
    };
    cutAlongSegment(project(range.begin), project(range.end));
  }
}

/// The same for a corner in the eyes' plane: they see it past the points where edges of the body
/// meet the plane.
void CriticalLines::edgesPastFoot(const Vec3& corner, const Occluder& body) {
  const Vec2 at = frame_.flat(corner);
  for (const Occluder::Edge& edge : body.edges) {
    const Vec3& from = body.corners[edge.from];
    const Vec3& to = body.corners[edge.to];
    const double h0 = height(from);
    const double h1 = height(to);
    const double t = footOf(h0, h1, coincidence_);
    if (t < 0) continue;
    const Vec2 foot = frame_.flat(from + (to - from) * t);
    const double distance = glm::length(foot - at);
    if (distance > narrow_) cutAlongSegment(foot, foot + (foot - at) * (kFarAway / distance));
  }
}

/// Cuts where an eye sees a corner of the body pass an edge that is farther away.
void CriticalLines::cornersPastEdge(const Segment& edge, const Occluder& body) {
  const double h0 = height(edge.from);
  const double h1 = height(edge.to);
  for (const Vec3& corner : body.corners) {
    const double low = height(corner);
    if (low <= coincidence_) continue;
    const Range range = between(h0, h1, low * (1 + kLevel), kInfinity);
    if (range.empty()) continue;
    const auto project = [&](double t) {
      const Vec3 p = edge.from + (edge.to - edge.from) * t;
      const double high = h0 + (h1 - h0) * t;
      return frame_.flat(p + (corner - p) * (high / (high - low)));
    };
    cutAlongSegment(project(range.begin), project(range.end));
  }
}

/// Cuts where an eye sees a face edge-on: to either side other edges make the outline.
void CriticalLines::facePlanes(const Occluder& body) {
  for (const Occluder::Plane& plane : body.planes) {
    const Vec2 normal(glm::dot(plane.normal, frame_.u), glm::dot(plane.normal, frame_.v));
    const double length = glm::length(normal);
    if (!(length > kNarrow)) continue;
    const double distance = plane.offset - glm::dot(plane.normal, frame_.origin);
    const Vec2 across = normal / length;
    cutAlong(across * (distance / length), {-across.y, across.x}, -kInfinity, kInfinity);
  }
}

void CriticalLines::findFeet(std::span<const Vec3> target, std::span<const Blocker> blockers) {
  feet_.clear();
  for (const Vec3& corner : target) {
    if (std::abs(height(corner)) <= coincidence_) feet_.push_back(frame_.flat(corner));
  }
  for (const Blocker& blocker : blockers) {
    const Occluder& body = *blocker.body;
    for (const Occluder::Edge& edge : body.edges) {
      const Vec3& from = body.corners[edge.from];
      const Vec3& to = body.corners[edge.to];
      const double t = footOf(height(from), height(to), coincidence_);
      if (t >= 0) feet_.push_back(frame_.flat(from + (to - from) * t));
    }
  }
}

bool CriticalLines::isFoot(const Vec2& corner) const {
  return std::any_of(feet_.begin(), feet_.end(),
                     [&](const Vec2& foot) { return glm::length(foot - corner) <= coincidence_; });
}

void CriticalLines::cutAlongSegment(const Vec2& from, const Vec2& to) {
  const double length = glm::length(to - from);
  if (length > narrow_) cutAlong(from, (to - from) / length, 0, length);
}

/// Cuts the parts that the line through `on` crosses from `begin` to `end`.
void CriticalLines::cutAlong(const Vec2& on, const Vec2& along, double begin, double end) {
  const std::size_t before = count_;
  for (std::size_t k = 0; k < before; ++k) {
    if (!crosses(parts_[k], on, along, begin, end)) continue;
    too_many_ = too_many_ || count_ >= most_parts_;
    if (too_many_) return;
    split(k, on, along);
  }
}

/// The side of a line on which a corner lies; 0: on it, within narrow_. Lines often meet in a
/// corner that another line made, and rounding must not decide whether it is cut off.
double CriticalLines::side(const Vec2& corner, const Vec2& on, const Vec2& along) const {
  const double distance = cross2(along, corner - on);
  return std::abs(distance) > narrow_ ? distance : 0.0;
}

bool CriticalLines::crosses(const Part& part, const Vec2& on, const Vec2& along, double begin,
                            double end) const {
  double right = 0;
  double left = 0;
  double enter = kInfinity;
  double leave = -kInfinity;
  const auto meet = [&](const Vec2& x) {
    const double t = glm::dot(along, x - on);
    enter = std::min(enter, t);
    leave = std::max(leave, t);
  };
  Vec2 p = part.back();
  double at_p = side(p, on, along);
  for (const Vec2& q : part) {
    const double at_q = side(q, on, along);
    right = std::min(right, at_q);
    left = std::max(left, at_q);
    if (at_q == 0) meet(q);
    if (at_p * at_q < 0) meet(p + (q - p) * (at_p / (at_p - at_q)));
    p = q;
    at_p = at_q;
  }
  return right < 0 && left > 0 && std::min(leave, end) - std::max(enter, begin) > narrow_;
}

void CriticalLines::split(std::size_t k, const Vec2& on, const Vec2& along) {
  Part& part = parts_[k];
  Part& other = parts_[count_++];
  other.clear();
  kept_.clear();
  Vec2 p = part.back();
  double at_p = side(p, on, along);
  for (const Vec2& q : part) {
    const double at_q = side(q, on, along);
    if (at_p * at_q < 0) {
      const Vec2 x = p + (q - p) * (at_p / (at_p - at_q));
      kept_.push_back(x);
      other.push_back(x);
    }
    if (at_q <= 0) kept_.push_back(q);
    if (at_q >= 0) other.push_back(q);
    p = q;
    at_p = at_q;
  }
  part.swap(kept_);
}

}  // namespace radiosity
