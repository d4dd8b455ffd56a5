// Patch meshes with their planar polygons, made by hand, for tests of rasterisers.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "quad_mesh.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::test {

/// Builds polygons and the patches that tile them. Neighbouring polygons must share their edges
/// vertex for vertex; equal points become one vertex.
class MeshBuilder {
 public:
  using Loop = std::vector<Vec3>;

  /// A rectangle or parallelogram origin + [0,1] u + [0,1] v, front along u x v, cut nu x nv.
  void grid(const std::string& surface, Vec3 origin, Vec3 u, Vec3 v, int nu = 1, int nv = 1,
            bool two_sided = false) {
    patches_.grid(surface, origin, u, v, nu, nv, two_sided);
    endPolygon(surface, {{origin, origin + u, origin + u + v, origin + v}}, two_sided);
  }

  /// The faces of a box, fronts outward, or inward for a room; n x n patches each. `floor`: false
  /// leaves out the lower face of the last axis.
  void box(const std::string& surface, Vec3 low, Vec3 high, int n, bool inward = false,
           bool floor = true) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 u(0.0), v(0.0), w(0.0);
      u[(axis + 1) % 3] = (high - low)[(axis + 1) % 3];
      v[(axis + 2) % 3] = (high - low)[(axis + 2) % 3];
      w[axis] = (high - low)[axis];
      if (inward) std::swap(u, v);
      grid(surface, low + w, u, v, n, n);
      if (axis < 2 || floor) grid(surface, low, v, u, n, n);
    }
  }

  /// Any planar polygon: outer loops counter-clockwise, holes clockwise; `outlines` are the convex
  /// patches that tile it (the polygon itself, if there are none).
  void polygon(const std::string& surface, std::vector<Loop> loops, std::vector<Loop> outlines = {},
               bool two_sided = false) {
    if (outlines.empty()) outlines = loops;
    for (const Loop& outline : outlines) patches_.patch(surface, outline, two_sided);
    endPolygon(surface, std::move(loops), two_sided);
  }

  /// The mesh, its fronts in the order given by `order` (a permutation), or as they came.
  PatchMesh build(const std::vector<std::size_t>& order = {}) const {
    PatchMesh mesh = patches_.build(order);
    for (Index i = 0; i < mesh.size(); ++i) {
      mesh.polygon[i] =
          mesh.side[i] ? mesh.polygon[mesh.twin[i]] : polygon_of_[order.empty() ? i : order[i]];
    }
    PlanarPolygons& out = mesh.polygons;
    out.loop_offset = out.corner_offset = {0};
    std::vector<Index> used(mesh.surface_names.size(), 0);
    for (const Planned& planned : polygons_) {
      const Index surface =
          Index(std::find(mesh.surface_names.begin(), mesh.surface_names.end(), planned.surface) -
                mesh.surface_names.begin());
      Vec3 normal(0.0);
      for (const Loop& loop : planned.loops) {
        for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
          normal += glm::cross(loop[k] - loop[0], loop[k + 1] - loop[0]);
        }
        for (const Vec3& point : loop) out.corners.push_back(vertex(mesh, point));
        out.corner_offset.push_back(out.corners.size());
      }
      out.loop_offset.push_back(out.corner_offset.size() - 1);
      out.normal.push_back(glm::normalize(normal));
      out.origin.push_back(planned.loops[0][0]);
      out.surface.push_back(surface);
      out.index_in_surface.push_back(used[surface]++);
      out.back_is_patch.push_back(planned.two_sided);
    }
    return mesh;
  }

 private:
  struct Planned {
    std::string surface;
    std::vector<Loop> loops;
    bool two_sided;
  };

  void endPolygon(const std::string& surface, std::vector<Loop> loops, bool two_sided) {
    polygon_of_.resize(patches_.patchCount(), Index(polygons_.size()));
    polygons_.push_back({surface, std::move(loops), two_sided});
  }

  static Index vertex(PatchMesh& mesh, const Vec3& point) {
    const auto found = std::find(mesh.vertices.begin(), mesh.vertices.end(), point);
    if (found == mesh.vertices.end()) {
      mesh.vertices.push_back(point);
      return Index(mesh.vertices.size() - 1);
    }
    return Index(found - mesh.vertices.begin());
  }

  QuadMesh patches_;
  std::vector<Planned> polygons_;
  std::vector<Index> polygon_of_;
};

/// A floor [low, high] at height z with a rectangular hole, cut into the eight rectangles around
/// the hole, n x n patches each; one polygon.
inline void floorWithHole(MeshBuilder& builder, const std::string& surface, Vec2 low, Vec2 high,
                          Vec2 hole_low, Vec2 hole_high, double z, int n) {
  using Loop = MeshBuilder::Loop;
  const auto rectangle = [&](double x0, double x1, double y0, double y1) {
    return Loop{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  };
  const std::vector<double> xs = {low.x, hole_low.x, hole_high.x, high.x};
  const std::vector<double> ys = {low.y, hole_low.y, hole_high.y, high.y};
  std::vector<Loop> outlines;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (i == 1 && j == 1) continue;
      for (int a = 0; a < n; ++a) {
        for (int b = 0; b < n; ++b) {
          const auto x = [&](int k) { return xs[i] + (xs[i + 1] - xs[i]) * k / n; };
          const auto y = [&](int k) { return ys[j] + (ys[j + 1] - ys[j]) * k / n; };
          outlines.push_back(rectangle(x(a), x(a + 1), y(b), y(b + 1)));
        }
      }
    }
  }
  Loop hole = rectangle(hole_low.x, hole_high.x, hole_low.y, hole_high.y);
  std::reverse(hole.begin(), hole.end());
  builder.polygon(surface, {rectangle(low.x, high.x, low.y, high.y), hole}, outlines);
}

/// A closed room [0,1]^3, fronts inward, with a block standing on its floor without a bottom: one
/// closed surface of 11 polygons. n x n patches a wall and a block face, 8 n^2 on the floor.
inline MeshBuilder roomWithBlock(int n) {
  MeshBuilder builder;
  const double lo = 0.3, hi = 0.6, top = 0.45;
  floorWithHole(builder, "floor", {0, 0}, {1, 1}, {lo, lo}, {hi, hi}, 0, n);
  builder.grid("ceiling", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n);
  builder.grid("left", {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, n, n);
  builder.grid("right", {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, n, n);
  builder.grid("front", {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, n, n);
  builder.grid("back", {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, n, n);
  builder.box("block", {lo, lo, 0}, {hi, hi, top}, n, false, false);
  return builder;
}

/// The inside of a cube, each face cut along a diagonal: adjacent triangles meet in four ways.
inline PatchMesh cubeOfTriangles() {
  MeshBuilder builder;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 u(0.0), v(0.0), w(0.0);
    u[(axis + 1) % 3] = v[(axis + 2) % 3] = w[axis] = 1;
    builder.polygon("room", {{w, w + v, w + u + v, w + u}},
                    {{w, w + v, w + u + v}, {w, w + u + v, w + u}});
    builder.polygon("room", {{Vec3(0), u, u + v, v}}, {{Vec3(0), u, v}, {u, u + v, v}});
  }
  return builder.build();
}

}  // namespace radiosity::test
