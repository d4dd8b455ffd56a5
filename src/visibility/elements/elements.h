// The patches as the exact method works on them: convex planar elements, sorted so that every
// cluster of neighbours is a contiguous range.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A range of elements [first, end).
struct ElementRange {
  Index first = 0;
  Index end = 0;
  Index size() const { return end - first; }
};

/// A node of the quadtree over one facet's elements.
struct Cluster {
  ElementRange elements;
  Index first_child = 0;  ///< into ElementSet::clusters
  Index child_count = 0;  ///< 0: a leaf (one element)
  Vec3 centre{0.0};       ///< of the bounding sphere
  double radius = 0;
  std::array<Vec3, 4>
      bounds;  ///< corners of a rectangle of the facet's plane that holds all elements
};

/// One side of one planar polygon that carries elements: they are coplanar, face alike, and never
/// exchange anything with each other.
struct Facet {
  Index polygon = 0;  ///< of the mesh
  bool back = false;  ///< the polygon's back side
  /// True: a black back. Its elements are the polygon's own convex pieces, not patches; they absorb
  /// and return nothing, and serve to tell backs from the sky.
  bool black = false;
  Vec3 normal{0.0};   ///< unit, out of the side that carries the elements
  double offset = 0;  ///< dot(normal, x) = offset on the plane
  ElementRange elements;
  Index root = 0;  ///< cluster
};

/// All elements of a mesh. Coordinates are the mesh's, moved so that the scene's middle is the
/// origin and multiplied by a power of two that brings its size to about 1: form factors do not
/// change, and nothing depends on the scene's unit or place. Areas are scaled likewise.
///
/// A patch that is a triangle or a convex quadrilateral, but for corners in line with their
/// neighbours, is one element. Any other patch is cut into trapezoids or, if they are fewer, into
/// its own pieces, each an element. Facets are ordered by surface name, polygon index within the
/// surface and side, black ones after all others; elements within a facet follow a quadtree in the
/// facet's plane (ties: index within the surface), those of one patch next to each other. So
/// nothing depends on how patches are numbered.
struct ElementSet {
  explicit ElementSet(const PatchMesh& mesh);
  /// `leading`: N flags, or none; polygons with such patches come before all others. Throws
  /// Cancelled.
  ElementSet(const PatchMesh& mesh, const Progress& progress,
             std::span<const std::uint8_t> leading = {});

  std::size_t size() const { return patch.size(); }
  std::span<const Vec3> outline(std::size_t e) const {
    return {corners[e].data(), corner_count[e]};
  }

  double scale = 1;        ///< power of two
  Vec3 middle{0.0};        ///< element coordinates are (mesh coordinates - middle) * scale
  double coincidence = 0;  ///< of the mesh, scaled: the one length tolerance

  std::vector<Index> patch;                  ///< E; of a black element: N + surface
  std::vector<Index> facet;                  ///< E
  std::vector<std::array<Vec3, 4>> corners;  ///< E, counter-clockwise about the facet's normal;
                                             ///< a triangle's fourth repeats its third
  std::vector<std::uint8_t> corner_count;    ///< E, 3 or 4
  std::vector<Vec3> centroid;                ///< E, of area
  std::vector<double> area;                  ///< E
  std::vector<double> radius;                ///< E, largest distance of a corner from the centroid
  std::vector<Facet> facets;
  std::vector<Cluster> clusters;
  std::size_t patch_elements =
      0;  ///< elements [0, patch_elements) belong to patches, the rest are black
  std::size_t leading_elements = 0;  ///< of these, the first ones, of polygons that lead
};

}  // namespace radiosity
