// Lines in a plane on which an eye sees a shadow's edge pass a corner of its target.
#pragma once

#include <span>
#include <vector>

#include "base/geometry/plane_frame.h"
#include "visibility/clipping/visible_part.h"

namespace radiosity {

/// Cuts a polygon along straight lines. Between them the view of a convex target past convex bodies
/// changes smoothly. It has a kink where the eye is in line with a corner of the target and an edge
/// of a body, a corner of a body and an edge of the target, a corner of one body and an
/// edge of another, or is in the plane of a body's face (Gigus & Malik 1990 have all such events).
/// Each but the last leaves a segment in the eye's plane, the projection of the edge from the
/// corner or of the edge through it. The other kinks are on curves, where two bodies' edges seem to
/// cross on an edge of the target. Holds scratch memory: one a thread.
class CriticalLines {
 public:
  /// Most edges of all bodies in between. Every edge may be in line with every corner: with more of
  /// them, the search for lines takes as long as the lines save.
  static constexpr std::size_t kMostEdges = 64;

  using Part = std::vector<Vec2>;  ///< convex; see lift()

  /// `polygon`: convex, in a plane of unit normal `normal`, with `target` in front of it; a corner
  /// nearer to that plane than `coincidence` touches it. False: there would be more than
  /// `most_parts`, or there is too much in between to look for them.
  bool cut(std::span<const Vec3> polygon, const Vec3& normal, std::span<const Vec3> target,
           std::span<const Blocker> blockers, double coincidence, std::size_t most_parts);

  std::span<const Part> parts() const { return {parts_.data(), count_}; }
  Vec3 lift(const Vec2& p) const { return frame_.lift(p); }
  /// True if a body's outline, or a corner of the target, stands on the polygon's plane in this
  /// corner of a part: the view of an eye beside it depends on the side that the eye is on, however
  /// near it is.
  bool isFoot(const Vec2& corner) const;

 private:
  struct Segment {
    Vec3 from, to;
  };
  bool tooManyEdges(std::span<const Blocker> blockers) const;
  double height(const Vec3& p) const { return glm::dot(p - frame_.origin, frame_.n); }
  void edgesPastCorner(const Vec3& corner, const Occluder& body);
  void edgesPastFoot(const Vec3& corner, const Occluder& body);
  void cornersPastEdge(const Segment& edge, const Occluder& body);
  void facePlanes(const Occluder& body);
  void findFeet(std::span<const Vec3> target, std::span<const Blocker> blockers);
  void cutAlongSegment(const Vec2& from, const Vec2& to);
  void cutAlong(const Vec2& on, const Vec2& along, double begin, double end);
  double side(const Vec2& corner, const Vec2& on, const Vec2& along) const;
  bool crosses(const Part& part, const Vec2& on, const Vec2& along, double begin, double end) const;
  void split(std::size_t part, const Vec2& on, const Vec2& along);

  PlaneFrame frame_;
  double coincidence_ = 0;
  double narrow_ = 0;  ///< no part is cut off that is narrower
  std::vector<Vec2> feet_;
  std::vector<Part> parts_;  ///< the first count_ are in use
  std::size_t count_ = 0;
  std::size_t most_parts_ = 0;
  bool too_many_ = false;
  Part kept_;
};

}  // namespace radiosity
