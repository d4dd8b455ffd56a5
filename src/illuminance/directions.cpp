#include "illuminance/directions.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "formfactor/rays/sobol.h"

namespace radiosity {

std::array<Vec3, kCubeFaces> cubeNormals() {
  std::array<Vec3, kCubeFaces> normals{};
  for (std::size_t face = 0; face < kCubeFaces; ++face) {
    normals[face][int(face / 2)] = face % 2 == 0 ? 1 : -1;
  }
  return normals;
}

std::array<Vec3, kUprights> uprightNormals(Up up) {
  std::array<Vec3, kUprights> normals{};
  for (std::size_t k = 0; k < kUprights; ++k) {
    const double angle = 2 * std::numbers::pi * double(k) / double(kUprights);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    normals[k] = up == Up::y ? Vec3(c, 0, -s) : Vec3(c, s, 0);
  }
  return normals;
}

SphereSets::SphereSets(std::uint64_t seed) {
  const SobolPoints sobol;
  std::array<std::vector<float>, kDimensions> points;
  PointArrays out{};
  for (std::size_t d = 0; d < kDimensions; ++d) {
    points[d].resize(kMostPoints);
    out[d] = points[d].data();
  }
  for (std::size_t set = 0; set < kSets; ++set) {
    sobol.points(0, kMostPoints, seed * kSets + set, out);
    for (std::size_t k = 0; k < kMostPoints; ++k) {
      const double z = 1 - 2 * double(points[0][k]);
      const double angle = 2 * std::numbers::pi * double(points[1][k]);
      const double across = std::sqrt(std::max(0.0, 1 - z * z));
      directions_[set].emplace_back(across * std::cos(angle), across * std::sin(angle), z);
    }
  }
}

std::array<double, kMeasured> Weights::of(const Vec3& toward) const {
  std::array<double, kMeasured> weights{};
  weights[0] = std::max(0.0, glm::dot(normal_, toward));
  for (std::size_t face = 0; face < kCubeFaces; ++face) {
    weights[1 + face] = std::max(0.0, glm::dot(cube_[face], toward));
  }
  const double height = glm::dot(upright_, toward);
  weights[std::size_t(Measured::cylinder)] =
      std::sqrt(std::max(0.0, 1 - height * height)) * std::numbers::inv_pi;
  return weights;
}

}  // namespace radiosity
