#include "formfactor/hemicube/eye_frame.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "formfactor/patch_seed.h"

namespace radiosity {

EyeFrame eyeFrame(const Vec3& eye, const Vec3& normal, double angle) {
  // The coordinate axis farthest from the normal gives the best conditioned cross product.
  const Vec3 size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
  Vec3 axis(0, 0, 1);
  if (size.x <= size.y && size.x <= size.z) {
    axis = Vec3(1, 0, 0);
  } else if (size.y <= size.z) {
    axis = Vec3(0, 1, 0);
  }
  const Vec3 first = glm::normalize(glm::cross(normal, axis));
  const Vec3 second = glm::cross(normal, first);
  const Vec3 turned = std::cos(angle) * first + std::sin(angle) * second;
  return {eye, glm::dmat3(turned, glm::cross(normal, turned), normal)};
}

double turnAngle(const PatchMesh& mesh, std::size_t patch, std::uint64_t seed) {
  const std::uint64_t bits = patchSeed(mesh, patch, seed);
  return double(bits >> 11) * 0x1p-53 * 2 * std::numbers::pi;
}

}  // namespace radiosity
