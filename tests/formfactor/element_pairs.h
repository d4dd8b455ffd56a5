// Random pairs of planar elements in front of each other's planes, of all shapes and placements.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "radiosity/base.h"

namespace radiosity::test {

enum class Shape { square, parallelogram, sliver, triangle, quadrilateral };

struct ElementPair {
  std::vector<Vec3> a, b;
  Vec3 normal_a{0.0}, normal_b{0.0};
};

class ElementPairs {
 public:
  explicit ElementPairs(std::uint64_t seed) : random_(seed) {}

  /// Sizes 1 and `ratio`, middles `distance` apart. One in two pairs is moved so that one or both
  /// touch the other's plane: grazing is hardest.
  ElementPair next(Shape shape, double ratio, double distance) {
    for (;;) {
      ElementPair pair;
      pair.a = outline(shape, 1, pair.normal_a);
      pair.b = outline(shape, ratio, pair.normal_b);
      const Vec3 offset = distance * direction();
      for (Vec3& p : pair.b) p += offset;
      const auto lower = [](std::vector<Vec3>& moved, const Vec3& normal, const Vec3& onto) {
        const double height = least(moved, normal, onto);
        for (Vec3& p : moved) p -= height * normal;
      };
      const double touching = uniform(0, 4);
      if (touching < 2) lower(pair.b, pair.normal_a, pair.a[0]);
      if (touching < 1) lower(pair.a, pair.normal_b, pair.b[0]);
      const bool in_front = least(pair.b, pair.normal_a, pair.a[0]) >= -kRounding &&
                            least(pair.a, pair.normal_b, pair.b[0]) >= -kRounding;
      if (in_front) return pair;
    }
  }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double logUniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      const double l = glm::length(v);
      if (l < 1 && l > 0.1) return v / l;
    }
  }

 private:
  static constexpr double kRounding = 1e-14;

  static double least(const std::vector<Vec3>& points, const Vec3& normal, const Vec3& on) {
    double height = glm::dot(normal, points[0] - on);
    for (const Vec3& p : points) height = std::min(height, glm::dot(normal, p - on));
    return height;
  }
  static double turn(const std::vector<Vec2>& c, std::size_t k) {
    const std::size_t n = c.size();
    const Vec2 in = c[(k + 1) % n] - c[k];
    const Vec2 out = c[(k + 2) % n] - c[(k + 1) % n];
    return in.x * out.y - in.y * out.x;
  }
  Vec2 point(double x, double y) { return {uniform(0.2, 1) * x, uniform(0.2, 1) * y}; }

  std::vector<Vec2> flat(Shape shape) {
    const double shear = shape == Shape::square ? 0 : uniform(-0.8, 0.8);
    double height = shape == Shape::square ? 1 : uniform(0.5, 1);
    if (shape == Shape::sliver) height *= logUniform(1e-3, 0.1);
    std::vector<Vec2> c = {
        {-1 - shear, -height}, {1 - shear, -height}, {1 + shear, height}, {-1 + shear, height}};
    if (shape == Shape::triangle) {
      do {
        c = {{uniform(-1, 1), uniform(-1, 1)},
             {uniform(-1, 1), uniform(-1, 1)},
             {uniform(-1, 1), uniform(-1, 1)}};
      } while (turn(c, 0) < 0.2);
    } else if (shape == Shape::quadrilateral) {
      do {
        c = {point(-1, -1), point(1, -1), point(1, 1), point(-1, 1)};
      } while (turn(c, 0) < 0.05 || turn(c, 1) < 0.05 || turn(c, 2) < 0.05 || turn(c, 3) < 0.05);
    }
    return c;
  }
  std::vector<Vec3> outline(Shape shape, double size, Vec3& normal) {
    normal = direction();
    const Vec3 u = glm::normalize(glm::cross(normal, direction()));
    const Vec3 v = glm::cross(normal, u);
    std::vector<Vec3> corners;
    for (const Vec2& p : flat(shape)) corners.push_back(size * (p.x * u + p.y * v));
    return corners;
  }

  std::mt19937_64 random_;
};

}  // namespace radiosity::test
