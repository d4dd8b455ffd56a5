#include "formfactor/hemicube/eye_frame.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/hash.h"

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
  Hash hash;
  hash.text(mesh.surface_names[mesh.surface[patch]]);
  hash.bytes(&mesh.index_in_surface[patch], sizeof(Index));
  hash.bytes(&mesh.side[patch], 1);
  hash.bytes(&seed, sizeof seed);
  // FNV-1a leaves the last bytes little mixed; the finaliser of splitmix64 (Steele et al. 2014)
  // spreads them over all bits.
  std::uint64_t bits = hash.value();
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ull;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebull;
  bits ^= bits >> 31;
  return double(bits >> 11) * 0x1p-53 * 2 * std::numbers::pi;
}

}  // namespace radiosity
