// Possible obstacles between two polygons: convex pieces of the planar polygons, found by a tree
// of boxes.
#pragma once

#include <vector>

#include "radiosity/patch_mesh.h"
#include "shaft.h"

namespace radiosity::truth {

class BlockerSet {
 public:
  /// All polygons of the mesh but those that have the whole scene on one side. `vertices` stand
  /// in for the mesh's; `coincidence`: closer things touch.
  BlockerSet(const PatchMesh& mesh, const std::vector<Vec3>& vertices, double coincidence);

  /// Blockers that may come between: all that do, and some that do not.
  std::vector<const Blocker*> inside(const Shaft& shaft) const;

  std::size_t size() const { return blockers_.size(); }
  std::size_t solids() const;  ///< blockers that belong to closed convex bodies

 private:
  struct Node {
    Vec3 low{0.0}, high{0.0};
    std::uint32_t first = 0;  ///< blocker, or the first of two child nodes
    std::uint32_t count = 0;  ///< blockers; 0: an inner node
  };

  void joinBodies();
  void findSolids(const std::vector<Vec3>& vertices, double coincidence);
  void buildNode(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::vector<Blocker> blockers_;
  std::vector<Node> nodes_;
};

}  // namespace radiosity::truth
