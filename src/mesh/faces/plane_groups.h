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
/// coincidence of the plane, so a plane cannot drift. (Visibility takes what is nearer to a plane
/// than the coincidence for touching it, which hides nothing. With half the coincidence here, noise
/// of that size left lamps in front of ceilings, which were seen through them.) Faces with the
/// handling `alone` have a plane each.
std::vector<Plane> groupByPlane(const InputFaces& input);

}  // namespace radiosity
