// Random numbers for scenes: the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <random>

#include "radiosity/base.h"

namespace radiosity::property {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (double(bits_() >> 11) * 0x1p-53);
  }
  /// 10 to a uniform power.
  double powerOfTen(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  /// low to high, both included.
  int integer(int low, int high) { return low + int(bits_() % std::uint64_t(high - low + 1)); }
  bool chance(double share) { return uniform(0, 1) < share; }
  Vec3 point(const Vec3& low, const Vec3& high) {
    return {uniform(low.x, high.x), uniform(low.y, high.y), uniform(low.z, high.z)};
  }
  Vec3 direction() {
    const double z = uniform(-1, 1);
    const double angle = uniform(0, 2 * std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  glm::dmat3 turnAbout(const Vec3& axis, double angle) {
    const double c = std::cos(angle);
    glm::dmat3 turn(0.0);
    for (int k = 0; k < 3; ++k) {
      Vec3 unit(0.0);
      unit[k] = 1;
      turn[k] = unit * c + glm::cross(axis, unit) * std::sin(angle) +
                axis * (glm::dot(axis, unit) * (1 - c));
    }
    return turn;
  }
  glm::dmat3 turn() { return turnAbout(direction(), uniform(0, 2 * std::numbers::pi)); }

 private:
  std::mt19937_64 bits_;
};

}  // namespace radiosity::property
