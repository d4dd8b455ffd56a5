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
/// that overlap, from face to face). Coplanar: every vertex of every face lies within half the
/// coincidence of the plane, so a plane is a slab one coincidence thick and cannot drift. Faces
/// with the handling `alone` have a plane each.
std::vector<Plane> groupByPlane(const InputFaces& input);

}  // namespace radiosity
