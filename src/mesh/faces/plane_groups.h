// Groups faces that lie in one plane.
#pragma once

#include <glm/geometric.hpp>
#include <vector>

#include "mesh/faces/input_faces.h"

namespace radiosity {

/// n.x = offset for points of the plane; the faces may face either way.
struct Plane {
  Vec3 normal{0.0};  ///< unit
  double offset = 0;
  double coincidence = 0;    ///< of the face it was begun with, m
  std::vector<Index> faces;  ///< ascending, into InputFaces::faces

  double distance(const Vec3& p) const { return glm::dot(normal, p) - offset; }
};

/// Puts every face into exactly one plane, together with the coplanar faces connected to it (boxes
/// that overlap, from face to face). Coplanar: every vertex of every face lies within the
/// coincidence of the plane, so a plane cannot drift. (Nor is one seen beside another that it
/// touches: visibility takes what is nearer than that for touching. With half of it, noise of half
/// a coincidence left lamps in front of ceilings that were seen through them.) Faces with the
/// handling `alone` have a plane each.
std::vector<Plane> groupByPlane(const InputFaces& input);

}  // namespace radiosity
