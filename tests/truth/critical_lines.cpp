#include "critical_lines.h"

#include <algorithm>
#include <optional>

namespace radiosity::truth {
namespace {

/// Heights above the plane closer than this, relative, are the same: the shadow runs to infinity.
constexpr double kLevel = 1e-9;

/// An edge of one or more blockers, and the third corners that tell their sides.
struct Rim {
  Vec3 a, b;
  std::vector<Vec3> across;  ///< a point of each blocker that has this edge
};

struct Parts {
  std::vector<Rim> rims;
  std::vector<Vec3> corners;
};

/// Edges and corners of all blockers, each once.
Parts partsOf(const std::vector<const Blocker*>& blockers) {
  Parts parts;
  for (const Blocker* blocker : blockers) {
    const Vec3 middle = middleOf(blocker->loop);
    for (std::size_t k = 0; k < blocker->loop.size(); ++k) {
      const Vec3& a = blocker->loop[k];
      const Vec3& b = blocker->loop.next(k);
      if (std::find(parts.corners.begin(), parts.corners.end(), a) == parts.corners.end()) {
        parts.corners.push_back(a);
      }
      const auto same = std::find_if(parts.rims.begin(), parts.rims.end(), [&](const Rim& rim) {
        return (rim.a == a && rim.b == b) || (rim.a == b && rim.b == a);
      });
      if (same == parts.rims.end()) {
        parts.rims.push_back({a, b, {middle}});
      } else {
        same->across.push_back(middle);
      }
    }
  }
  return parts;
}

/// Whether the edge bounds the shadow that a light at `eye` casts: not where blockers continue it
/// on both sides.
bool boundsShadow(const Rim& rim, const Vec3& eye) {
  const Vec3 normal = glm::cross(rim.a - eye, rim.b - eye);
  bool above = false;
  bool below = false;
  for (const Vec3& p : rim.across) {
    const double side = glm::dot(normal, p - eye);
    above = above || side > 0;
    below = below || side < 0;
  }
  return !(above && below);
}

/// Heights over a plane, and projections on to it.
struct Ground {
  Vec3 normal;
  double offset;
  double height(const Vec3& p) const { return glm::dot(normal, p) - offset; }
  /// Where the line from `top` through `p` meets the plane.
  Vec3 through(const Vec3& top, const Vec3& p) const {
    const double high = height(top);
    return top + (p - top) * (high / (high - height(p)));
  }
};

/// The part of a..b with low <= height <= high, if there is one.
std::optional<Segment> between(const Ground& ground, Vec3 a, Vec3 b, double low, double high) {
  double height_a = ground.height(a);
  double height_b = ground.height(b);
  if (height_a > height_b) {
    std::swap(a, b);
    std::swap(height_a, height_b);
  }
  if (height_b < low || height_a > high) return std::nullopt;
  const Vec3 along = b - a;
  const double rise = height_b - height_a;
  const Segment out{height_a < low ? a + along * ((low - height_a) / rise) : a,
                    height_b > high ? a + along * ((high - height_a) / rise) : b};
  return out;
}

/// The line along which a blocker is seen edge-on, if its plane cuts the target.
std::optional<Segment> edgeOn(const Sheet& source, const Loop& target, const Blocker& blocker) {
  bool above = false;
  bool below = false;
  for (const Vec3& p : target) {
    above = above || glm::dot(blocker.normal, p) > blocker.offset;
    below = below || glm::dot(blocker.normal, p) < blocker.offset;
  }
  if (!above || !below) return std::nullopt;
  const Vec3 direction = glm::cross(source.normal, blocker.normal);
  const double square = glm::dot(direction, direction);
  if (square < kLevel * kLevel) return std::nullopt;
  // The point of both planes nearest to the source's middle.
  const Vec3 towards = glm::cross(direction, source.normal) / square;
  const double gap = blocker.offset - glm::dot(blocker.normal, source.middle);
  const Vec3 foot = source.middle + towards * (gap / glm::dot(towards, blocker.normal));
  const Vec3 half = direction * (2 * source.radius / std::sqrt(square));
  return Segment{foot - half, foot + half};
}

/// Whether some of the segment lies inside the loop, not only on its rim.
bool enters(const Sheet& source, const Loop& loop, const Segment& segment, double slack) {
  double t0 = 0;
  double t1 = 1;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    Vec3 inward = glm::cross(source.normal, loop.next(k) - loop[k]);
    const double length = glm::length(inward);
    if (!(length > 0)) continue;
    inward /= length;
    const double from = glm::dot(inward, segment.from - loop[k]) - slack;
    const double to = glm::dot(inward, segment.to - loop[k]) - slack;
    if (from <= 0 && to <= 0) return false;
    if (from < 0) t0 = std::max(t0, from / (from - to));
    if (to < 0) t1 = std::min(t1, from / (from - to));
  }
  return t0 < t1;
}

}  // namespace

std::vector<Segment> criticalSegments(const Sheet& source, const Loop& target,
                                      const std::vector<const Blocker*>& blockers) {
  const Ground ground{source.normal, source.offset};
  const Parts parts = partsOf(blockers);
  std::vector<Segment> segments;
  const auto add = [&](const std::optional<Segment>& segment) {
    if (segment && enters(source, source.loop, *segment, 0)) segments.push_back(*segment);
  };
  for (std::size_t k = 0; k < target.size(); ++k) {
    const Vec3& corner = target[k];
    const double high = ground.height(corner);
    for (const Rim& rim : parts.rims) {
      if (!(high > 0) || !boundsShadow(rim, corner)) continue;
      if (const auto part = between(ground, rim.a, rim.b, 0, high * (1 - kLevel))) {
        add(Segment{ground.through(corner, part->from), ground.through(corner, part->to)});
      }
    }
    for (const Vec3& p : parts.corners) {
      const double low = ground.height(p);
      if (low < 0) continue;
      const double top = std::max(low * (1 + kLevel), kLevel * source.radius);
      const double highest = std::max(high, ground.height(target.next(k)));
      if (const auto part = between(ground, corner, target.next(k), top, highest)) {
        add(Segment{ground.through(part->from, p), ground.through(part->to, p)});
      }
    }
  }
  for (const Blocker* blocker : blockers) add(edgeOn(source, target, *blocker));
  return segments;
}

std::vector<Loop> cutIntoCells(const Sheet& source, const Loop& loop,
                               const std::vector<Segment>& segments, std::size_t most) {
  const double slack = 1e-12 * source.radius;  // thinner cells than this carry nothing
  std::vector<Loop> cells = {loop};
  for (const Segment& segment : segments) {
    const Vec3 along = segment.to - segment.from;
    const double length = glm::length(along);
    if (!(length > 0)) continue;
    const Vec3 normal = glm::cross(source.normal, along) / length;
    const double offset = glm::dot(normal, segment.from);
    const std::size_t count = cells.size();
    for (std::size_t k = 0; k < count && cells.size() < most; ++k) {
      if (!enters(source, cells[k], segment, slack)) continue;
      Loop left;
      Loop right;
      split(cells[k], normal, offset, slack, &left, &right);
      if (left.empty() || right.empty()) continue;
      cells[k] = left;
      cells.push_back(right);
    }
  }
  return cells;
}

}  // namespace radiosity::truth
