// What may stand between two polygons: convex pieces of the planar polygons, found by a tree of
// boxes.
#pragma once

#include <array>
#include <vector>

#include "loop.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::truth {

/// A convex piece of a planar polygon.
struct Blocker {
  Loop loop;
  Vec3 normal{0.0};  ///< unit, the loop is counter-clockwise about it
  double offset = 0;
  Index body = 0;  ///< pieces that share corners, directly or through others, are one body
};

/// A patch or a piece of one, convex, with its plane.
struct Sheet {
  Loop loop;
  Vec3 normal{0.0};
  double offset = 0;
  Vec3 middle{0.0};
  double radius = 0;
  explicit Sheet(const Loop& corners);
};

class BlockerSet {
 public:
  /// All polygons of the mesh but those that have the whole scene on one side. `vertices` stand
  /// in for the mesh's; `coincidence`: closer things touch.
  BlockerSet(const PatchMesh& mesh, const std::vector<Vec3>& vertices, double coincidence);

  /// Blockers that may cut a line from `a` to `b`: all that do, and some that do not.
  std::vector<const Blocker*> between(const Sheet& a, const Sheet& b) const;

  std::size_t size() const { return blockers_.size(); }

 private:
  struct Node {
    Vec3 low, high;
    std::uint32_t first = 0;  ///< blocker, or the first of two child nodes
    std::uint32_t count = 0;  ///< blockers; 0: an inner node
  };
  struct Plane {
    Vec3 normal;    ///< not unit
    double offset;  ///< dot(normal, x) > offset where something may block
  };

  void joinBodies();
  void buildNode(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  std::vector<Plane> shaft(const Sheet& a, const Sheet& b) const;

  double coincidence_;
  std::vector<Blocker> blockers_;
  std::vector<Node> nodes_;
};

}  // namespace radiosity::truth
