// Emitters: convex pieces of planar polygons.
#pragma once

#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"
#include "visibility/elements/elements.h"
#include "visibility/shadows/shadow.h"

namespace radiosity {

/// A convex piece of one side of a polygon, with one exitance. Coordinates are those of ElementSet.
struct Emitter {
  std::vector<Vec3> outline;  ///< 3 or 4 corners, counter-clockwise about the normal
  Vec3 normal{0.0};
  double offset = 0;  ///< dot(normal, x) of its plane
  Vec3 centre{0.0};
  double radius = 0;
  double area = 0;
  Index facet = 0;  ///< of the ElementSet
  Index patch = 0;  ///< a patch with this exitance
  ShapeCorners shape{};
};

/// The fewest pieces: those of the polygon if all its patches have the same emission, else its
/// elements.
std::vector<Emitter> findEmitters(const PatchMesh& mesh, const ElementSet& elements,
                                  const PatchMaterials& materials);

}  // namespace radiosity
