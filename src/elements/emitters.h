// What shines: convex pieces of planar polygons.
#pragma once

#include <span>
#include <vector>

#include "formfactor/exact/elements/elements.h"
#include "formfactor/exact/visibility/shadow.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A convex piece of one side of a polygon, of one exitance. Coordinates are ElementSet's.
struct Emitter {
  std::vector<Vec3> outline;  ///< 3 or 4 corners, counter-clockwise about the normal
  Vec3 normal{0.0};
  double offset = 0;  ///< dot(normal, x) of its plane
  Vec3 centre{0.0};
  double radius = 0;
  double area = 0;
  Index facet = 0;  ///< of the ElementSet
  Index patch = 0;  ///< one that has the exitance
  ShapeCorners shape{};
};

/// The fewest pieces: those of the polygon where all its patches shine alike, else its elements.
std::vector<Emitter> findEmitters(const PatchMesh& mesh, const ElementSet& elements,
                                  const PatchMaterials& materials);

}  // namespace radiosity
