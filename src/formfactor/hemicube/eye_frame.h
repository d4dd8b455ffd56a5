// The place of an eye and the turn of its hemicube.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A hemicube's position and axes. The columns of `axes` are orthonormal: two in the horizon's
/// plane and the normal, which points up through the top face.
struct EyeFrame {
  Vec3 eye{0.0};
  glm::dmat3 axes{1.0};

  /// A point in the eye's own coordinates; the third is the height above the horizon.
  Vec3 toEye(const Vec3& point) const { return (point - eye) * axes; }
};

/// A frame about a unit normal, turned by `angle` radians from a direction that depends on the
/// normal alone.
EyeFrame eyeFrame(const Vec3& eye, const Vec3& normal, double angle);

/// A random angle in [0, 2 pi) for one patch. It depends on the patch's surface name and its index
/// within the surface, not on its place in the mesh, so that a permuted mesh sees the same.
double turnAngle(const PatchMesh& mesh, std::size_t patch, std::uint64_t seed);

}  // namespace radiosity
