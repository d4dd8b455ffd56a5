// Scenes put together in memory, for tests: polygons, boxes, prisms, and rigid motions of a scene.
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity::test {

/// Rotates `p` about the unit `axis` through the origin by `angle` radians (Rodrigues).
inline Vec3 rotated(const Vec3& p, const Vec3& axis, double angle) {
  return p * std::cos(angle) + glm::cross(axis, p) * std::sin(angle) +
         axis * (glm::dot(axis, p) * (1.0 - std::cos(angle)));
}

/// Fills a Scene face by face. Every face gets vertices of its own, as if each came from another
/// object of a file: welding has to find shared vertices.
class SceneBuilder {
 public:
  SceneBuilder() {
    scene_.file = "test scene";
    scene_.face_offset.push_back(0);
  }

  Index material(const std::string& name, double reflectance = 0.5, double emission = 0.0,
                 bool two_sided = false) {
    Material m;
    m.name = name;
    m.reflectance = Vec3(reflectance);
    m.emission = Vec3(emission);
    m.two_sided = two_sided;
    scene_.materials.push_back(m);
    return Index(scene_.materials.size() - 1);
  }

  /// A surface of its own material.
  Index surface(const std::string& object, double reflectance = 0.5, double emission = 0.0,
                bool two_sided = false) {
    return surfaceOf(object, material(object, reflectance, emission, two_sided));
  }

  Index surfaceOf(const std::string& object, Index of) {
    scene_.surfaces.push_back({object, of, object + "/" + scene_.materials[of].name});
    return Index(scene_.surfaces.size() - 1);
  }

  /// A polygon, counter-clockwise seen from its front.
  void face(Index surface, const std::vector<Vec3>& corners) {
    for (const Vec3& p : corners) {
      scene_.corners.push_back(Index(scene_.vertices.size()));
      scene_.vertices.push_back(p);
    }
    scene_.face_offset.push_back(scene_.corners.size());
    scene_.face_surface.push_back(surface);
    scene_.face_element.push_back(scene_.face_surface.size());
  }

  /// A horizontal rectangle at height z facing up (or down).
  void level(Index surface, double x0, double y0, double x1, double y1, double z, bool up = true) {
    std::vector<Vec3> p{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
    if (!up) p = {p[0], p[3], p[2], p[1]};
    face(surface, p);
  }

  /// A prism over `base` (counter-clockwise from above, at height z0) up to z1, normals outward
  /// or inward: sides first, then the bottom, then the top.
  void prism(Index surface, const std::vector<Vec2>& base, double z0, double z1,
             bool outward = true) {
    const std::size_t n = base.size();
    std::vector<Vec3> low;
    std::vector<Vec3> high;
    for (const Vec2& p : base) {
      low.emplace_back(p.x, p.y, z0);
      high.emplace_back(p.x, p.y, z1);
    }
    std::vector<std::vector<Vec3>> faces;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = (k + 1) % n;
      faces.push_back({low[k], low[next], high[next], high[k]});
    }
    faces.emplace_back(low.rbegin(), low.rend());
    faces.push_back(high);
    for (auto& f : faces) {
      if (!outward) f = {f.rbegin(), f.rend()};
      face(surface, f);
    }
  }

  void box(Index surface, const Vec3& low, const Vec3& high, bool outward = true) {
    prism(surface, {{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}}, low.z,
          high.z, outward);
  }

  /// A rectangle's corners turned by `angle` radians about `centre`, counter-clockwise.
  static std::vector<Vec2> turnedRectangle(const Vec2& centre, double width, double depth,
                                           double angle) {
    std::vector<Vec2> out;
    for (const auto& [sx, sy] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      const double x = 0.5 * width * sx;
      const double y = 0.5 * depth * sy;
      out.emplace_back(centre.x + x * std::cos(angle) - y * std::sin(angle),
                       centre.y + x * std::sin(angle) + y * std::cos(angle));
    }
    return out;
  }

  static std::vector<Vec2> regularPolygon(const Vec2& centre, double radius, std::size_t n) {
    std::vector<Vec2> out;
    for (std::size_t k = 0; k < n; ++k) {
      const double a = 2.0 * std::numbers::pi * double(k) / double(n);
      out.emplace_back(centre.x + radius * std::cos(a), centre.y + radius * std::sin(a));
    }
    return out;
  }

  Scene& scene() { return scene_; }

 private:
  Scene scene_;
};

/// The scene turned by one radian about a skew axis: no edge stays on a coordinate axis and every
/// coordinate is rounded.
inline Scene turned(Scene scene) {
  const Vec3 axis = glm::normalize(Vec3(1.0, std::sqrt(2.0), std::sqrt(3.0)));
  for (Vec3& p : scene.vertices) p = rotated(p, axis, 1.0);
  return scene;
}

inline Scene scaled(Scene scene, double factor) {
  for (Vec3& p : scene.vertices) p *= factor;
  return scene;
}

inline Scene moved(Scene scene, const Vec3& by) {
  for (Vec3& p : scene.vertices) p += by;
  return scene;
}

}  // namespace radiosity::test
