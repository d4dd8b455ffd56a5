// Coarse complexes put together by hand, for tests of the subdivision stage.
#pragma once

#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "mesh/polygons/complex.h"
#include "support/scene_builder.h"

namespace radiosity::test {

/// Polygons that share vertices by position. Every polygon gets a face of the scene (its outer
/// loop), so that patches have a source.
class CoarseBuilder {
 public:
  CoarseBuilder() { complex_.coincidence = 1e-7; }

  Index surface(const std::string& name) { return scene_.surface(name); }

  CoarsePolygon& polygon(Index surface, const std::vector<std::vector<Vec3>>& loops) {
    CoarsePolygon& polygon = complex_.polygons.emplace_back();
    for (const auto& loop : loops) {
      auto& ids = polygon.loops.emplace_back();
      for (const Vec3& p : loop) ids.push_back(vertex(p));
    }
    Vec3 area(0.0);
    const auto& outer = loops[0];
    for (std::size_t k = 0; k < outer.size(); ++k) {
      area += glm::cross(outer[k] - outer[0], outer[(k + 1) % outer.size()] - outer[0]);
    }
    polygon.normal = glm::normalize(area);
    polygon.surface = surface;
    polygon.faces = {Index(scene_.scene().faceCount())};
    scene_.face(surface, outer);
    return polygon;
  }

  /// In the plane z = 0, facing up.
  CoarsePolygon& flat(Index surface, const std::vector<std::vector<Vec2>>& loops) {
    std::vector<std::vector<Vec3>> lifted;
    for (const auto& loop : loops) {
      auto& points = lifted.emplace_back();
      for (const Vec2& p : loop) points.emplace_back(p, 0.0);
    }
    return polygon(surface, lifted);
  }

  void innerEdge(CoarsePolygon& polygon, const Vec3& a, const Vec3& b) {
    polygon.inner_edges.push_back({vertex(a), vertex(b)});
  }

  /// The six squares of the cube [0,1]^3, facing outward.
  void cube(Index s) {
    const auto p = [](int x, int y, int z) { return Vec3(x, y, z); };
    polygon(s, {{p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)}});
    polygon(s, {{p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)}});
    polygon(s, {{p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)}});
    polygon(s, {{p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0)}});
    polygon(s, {{p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)}});
    polygon(s, {{p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)}});
  }

  Index vertex(const Vec3& p) {
    for (Index i = 0; i < complex_.vertices.size(); ++i) {
      if (complex_.vertices[i] == p) return i;
    }
    complex_.vertices.push_back(p);
    return Index(complex_.vertices.size() - 1);
  }

  CoarseComplex& complex() { return complex_; }
  Scene& scene() { return scene_.scene(); }

 private:
  CoarseComplex complex_;
  SceneBuilder scene_;
};

}  // namespace radiosity::test
