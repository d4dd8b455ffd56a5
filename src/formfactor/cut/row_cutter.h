// The tree of a mesh's patches, and rows of rays cut through it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/rays/ray_scene.h"
#include "formfactor/row_accounts.h"
#include "matrix/cut_operator.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The patches that have an area and are not `known`, whose rows are known whole, in the
/// coordinates of rays.
PatchTree treeOfPatches(const PatchMesh& mesh, const RayScene& scene, std::span<const Index> known);

/// What the rays of a row count beside its cut. Each hit stands for itself.
struct CutCounts {
  double rays = 0;              ///< of both replicates; RayRow::counted()
  double sky = 0;               ///< of these, into the sky
  double known = 0;             ///< on patches that are not in the tree
  std::vector<SeenBack> backs;  ///< surfaces seen from behind, and hits in place of shares
};

/// A cut of a tree for a patch (Walter et al., "Lightcuts", SIGGRAPH 2005): the nodes farthest up
/// that are small as seen from it.
class RowCutter {
 public:
  /// `opening`: the most radius of a node over its distance. All are kept by reference.
  RowCutter(const RayScene& scene, const PatchTree& tree, double opening);

  const RayScene& scene() const { return scene_; }
  const PatchTree& tree() const { return tree_; }
  /// The position of the row of a place in the tree, in the order of the scene.
  std::size_t positionOf(std::size_t place) const {
    return scene_.position()[tree_.patches()[place].patch];
  }
  /// Adds the cut of a row, of at most kMostRays rays a replicate, to others.
  CutCounts cut(std::size_t place, const RayRow& row, CutRows& rows) const;

  /// Counts are of 16 bits.
  static constexpr std::uint32_t kMostRays = 1U << 15U;

 private:
  class Descent;

  const RayScene& scene_;
  const PatchTree& tree_;
  double opening_;
  std::vector<Index> place_;  ///< in the tree, by unknown; or kNone
};

}  // namespace radiosity
