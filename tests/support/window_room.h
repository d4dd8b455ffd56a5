// A room with a window, and what comes in by it.
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "support/scene_builder.h"

namespace radiosity::test {

/// 4 x 5 x 3 m seen from inside, with a window in the wall at y = 0; a table if `height` is above
/// 0.
inline constexpr Vec2 kWindowX{1, 3};
inline constexpr Vec2 kWindowZ{1, 2.2};
inline SceneBuilder roomWithWindow(double height, double reflectance = 0.5) {
  SceneBuilder builder;
  const Index room = builder.surface("room", reflectance);
  const auto north = [&](double x0, double x1, double z0, double z1) {
    builder.face(room, {{x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0}});
  };
  north(0, kWindowX.x, 0, 3);
  north(kWindowX.y, 4, 0, 3);
  north(kWindowX.x, kWindowX.y, 0, kWindowZ.x);
  north(kWindowX.x, kWindowX.y, kWindowZ.y, 3);
  builder.level(room, 0, 0, 4, 5, 0);
  builder.level(room, 0, 0, 4, 5, 3, false);
  builder.face(room, {{0, 5, 0}, {4, 5, 0}, {4, 5, 3}, {0, 5, 3}});
  builder.face(room, {{0, 0, 0}, {0, 5, 0}, {0, 5, 3}, {0, 0, 3}});
  builder.face(room, {{4, 5, 0}, {4, 0, 0}, {4, 0, 3}, {4, 5, 3}});
  if (height > 0) builder.level(builder.surface("table"), 1.5, 1.5, 2.5, 2.5, height);
  return builder;
}

/// What a level place gets through the window, by Gauss points over it: of radiance 1 all over (x),
/// and of Moon and Spencer's sky that gives 1 to open ground (y).
inline Vec2 throughWindow(const Vec3& place) {
  constexpr std::array<double, 3> kAt{-0.7745966692414834, 0, 0.7745966692414834};
  constexpr std::array<double, 3> kWeight{5.0 / 9, 8.0 / 9, 5.0 / 9};
  constexpr int kCells = 24;
  Vec2 sum(0.0);
  const double dx = (kWindowX.y - kWindowX.x) / kCells;
  const double dz = (kWindowZ.y - kWindowZ.x) / kCells;
  for (int i = 0; i < kCells * kCells; ++i) {
    const int row = i / kCells;
    for (int k = 0; k < 9; ++k) {
      const Vec3 at(kWindowX.x + dx * (i % kCells + 0.5 + 0.5 * kAt[std::size_t(k % 3)]), 0,
                    kWindowZ.x + dz * (row + 0.5 + 0.5 * kAt[std::size_t(k / 3)]));
      const Vec3 way = at - place;
      const double square = glm::dot(way, way);
      const double sine = way.z / std::sqrt(square);
      if (!(sine > 0)) continue;
      const double area = dx * dz / 4 * kWeight[std::size_t(k % 3)] * kWeight[std::size_t(k / 3)];
      const double share = area * sine * (place.y / std::sqrt(square)) / square;
      sum += share * Vec2(1, 3 / (7 * std::numbers::pi) * (1 + 2 * sine));
    }
  }
  return sum;
}

}  // namespace radiosity::test
