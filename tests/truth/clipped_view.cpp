#include "clipped_view.h"

#include <cmath>
#include <numbers>

namespace radiosity::truth {
namespace {

/// Relative to normal and corner: nearer than this to a cutting plane is on it. Shadows that share
/// an edge then leave no sliver between them.
constexpr double kRounding = 1e-14;

/// The shadow of a blocker, seen from the origin: inside where dot(normals[k], y) > offset of all
/// planes. The first is the blocker's own, all others go through the origin.
struct Shadow {
  std::array<Vec3, Loop::kRoom + 1> normals;
  double far_offset = 0;
  std::size_t planes = 0;
  double offset(std::size_t k) const { return k == 0 ? far_offset : 0; }
};

bool isOutside(const Loop& loop, const Vec3& normal, double offset, double slack) {
  for (const Vec3& p : loop) {
    if (glm::dot(normal, p) - offset > slack) return false;
  }
  return true;
}

/// Makes the shadow; false where it misses the target, or where the blocker is seen edge-on.
bool castShadow(const Blocker& blocker, const Vec3& point, const Loop& target, double slack,
                Shadow& shadow) {
  const double height = glm::dot(blocker.normal, point) - blocker.offset;
  if (height == 0 || (blocker.solid && height < 0)) return false;
  const double side = height > 0 ? 1 : -1;
  shadow.normals[0] = blocker.normal * -side;
  shadow.far_offset = std::abs(height);
  if (isOutside(target, shadow.normals[0], shadow.far_offset, slack)) return false;
  shadow.planes = blocker.loop.size() + 1;
  Vec3 corner = blocker.loop[0] - point;
  for (std::size_t k = 1; k < shadow.planes; ++k) {
    // Counter-clockwise about a normal towards the point: inside is where a x b points away.
    const Vec3 next = blocker.loop.next(k - 1) - point;
    const Vec3 normal = glm::cross(corner, next);
    const double length = glm::length(normal);
    shadow.normals[k] = length > 0 ? normal * (-side / length) : Vec3(0.0);
    if (isOutside(target, shadow.normals[k], 0, slack)) return false;
    corner = next;
  }
  return true;
}

bool misses(const Shadow& shadow, const Loop& piece, double slack) {
  for (std::size_t k = 0; k < shadow.planes; ++k) {
    if (isOutside(piece, shadow.normals[k], shadow.offset(k), slack)) return true;
  }
  return false;
}

/// Appends what of `piece` lies outside the shadow.
void subtract(const Shadow& shadow, Loop piece, double slack, std::vector<Loop>& out) {
  Loop inside;
  Loop outside;
  for (std::size_t k = 0; k < shadow.planes; ++k) {
    split(piece, shadow.normals[k], shadow.offset(k), slack, &inside, &outside);
    if (!outside.empty()) out.push_back(outside);
    if (inside.empty()) return;
    piece = inside;
  }
}

}  // namespace

double pointToPolygon(const Loop& polygon, const Vec3& normal) {
  double sum = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& a = polygon[k];
    const Vec3& b = polygon.next(k);
    const Vec3 c = glm::cross(a, b - a);
    const double sine = glm::length(c);
    if (sine > 0) sum -= glm::dot(normal, c) * (std::atan2(sine, glm::dot(a, b)) / sine);
  }
  return sum / (2 * std::numbers::pi);
}

Glimpse ClippedView::from(const Vec3& point) const {
  Loop target;
  double size = 0;
  for (const Vec3& p : target_) {
    target.push(p - point);
    size = std::max(size, glm::length(p - point));
  }
  const double slack = kRounding * size;
  thread_local std::vector<Loop> pieces;
  thread_local std::vector<Loop> rest;
  pieces.assign(1, target);
  Glimpse seen;
  seen.whole = pointToPolygon(target, source_.normal);
  seen.clear = true;
  Shadow shadow;
  for (const Blocker* blocker : blockers_) {
    if (!castShadow(*blocker, point, target, slack, shadow)) continue;
    rest.clear();
    for (const Loop& piece : pieces) {
      if (misses(shadow, piece, slack)) {
        rest.push_back(piece);
      } else {
        subtract(shadow, piece, slack, rest);
        seen.clear = false;
      }
    }
    pieces.swap(rest);
    if (pieces.empty()) break;
  }
  seen.hidden = pieces.empty();
  if (seen.hidden) {
    seen.blocked = seen.whole;
  } else if (!seen.clear) {
    seen.blocked = seen.whole;
    for (const Loop& piece : pieces) seen.blocked -= pointToPolygon(piece, source_.normal);
  }
  return seen;
}

}  // namespace radiosity::truth
