// Lines on a polygon at which the shape of its view of another changes.
#pragma once

#include <vector>

#include "shaft.h"

namespace radiosity::truth {

/// A stretch of a line on the source's plane.
struct Segment {
  Vec3 from{0.0}, to{0.0};
};

/// The straight critical lines on `source`'s plane: between them the visible part of `target` keeps
/// its corners and edges, and its form factor is analytic in the eye's place. From these lines an
/// edge of a blocker passes a corner of the target, a corner of a blocker passes an edge of the
/// target, or a blocker is seen edge-on. (Edges of two blockers meet on an edge of the target along
/// curves, which are not here.) `target` lies in front of the source's plane.
std::vector<Segment> criticalSegments(const Sheet& source, const Loop& target,
                                      const std::vector<const Blocker*>& blockers);

/// The convex cells a convex loop falls into when cut along each segment that crosses it; each cut
/// goes right through the cell it starts in. No more than about `most` cells.
std::vector<Loop> cutIntoCells(const Sheet& source, const Loop& loop,
                               const std::vector<Segment>& segments, std::size_t most);

}  // namespace radiosity::truth
