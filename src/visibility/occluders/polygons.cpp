#include "visibility/occluders/polygons.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>
#include <tuple>

#include "base/geometry/plane_frame.h"
#include "mesh/triangulate.h"
#include "mesh/welded_points.h"
#include "visibility/occluders/hull.h"

namespace radiosity {
namespace {

/// Drops repeated neighbours, which welding may leave; fewer than three vertices bound nothing.
std::vector<Index> withoutRepeats(const std::vector<Index>& loop) {
  std::vector<Index> out;
  for (const Index v : loop) {
    if (out.empty() || out.back() != v) out.push_back(v);
  }
  while (out.size() > 1 && out.front() == out.back()) out.pop_back();
  if (out.size() < 3) out.clear();
  return out;
}

}  // namespace

OccluderPolygons::OccluderPolygons(const PatchMesh& mesh, const ElementSet& elements)
    : coincidence(elements.coincidence) {
  const PlanarPolygons& source = mesh.polygons;
  std::vector<Index> order(source.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tie(mesh.surface_names[source.surface[a]], source.index_in_surface[a]) <
           std::tie(mesh.surface_names[source.surface[b]], source.index_in_surface[b]);
  });
  WeldedPoints welded;
  std::vector<Index> place(mesh.vertices.size(), kNone);
  for (const Index p : order) {
    for (std::size_t l = source.loopBegin(p); l < source.loopEnd(p); ++l) {
      for (const Index v : source.loop(l)) {
        if (place[v] == kNone) {
          place[v] =
              welded.insert((mesh.vertices[v] - elements.middle) * elements.scale, coincidence);
        }
      }
    }
  }
  vertices.reserve(welded.size());
  for (Index v = 0; v < welded.size(); ++v) vertices.push_back(welded[v]);
  for (const Index p : order) addPolygon(mesh, elements, p, place);
  vertex_tree = PointTree(vertices);
  findBounding();
  std::vector<Box3> boxes;
  boxes.reserve(polygons.size());
  for (const OccluderPolygon& polygon : polygons) boxes.push_back(polygon.box);
  tree = BoxTree(boxes);
  std::vector<std::uint8_t> back_is_patch(source.size(), 0);
  for (const Facet& facet : elements.facets) {
    if (facet.back && !facet.black) back_is_patch[facet.polygon] = 1;
  }
  for (OccluderPolygon& polygon : polygons) polygon.one_sided = !back_is_patch[polygon.source];
}

void OccluderPolygons::addPolygon(const PatchMesh& mesh, const ElementSet& elements, Index p,
                                  const std::vector<Index>& place) {
  const PlanarPolygons& source = mesh.polygons;
  OccluderPolygon polygon;
  polygon.source = p;
  polygon.normal = source.normal[p];
  polygon.offset = glm::dot(polygon.normal, (source.origin[p] - elements.middle) * elements.scale);
  for (std::size_t l = source.loopBegin(p); l < source.loopEnd(p); ++l) {
    std::vector<Index> loop;
    for (const Index v : source.loop(l)) loop.push_back(place[v]);
    loop = withoutRepeats(loop);
    if (!loop.empty()) polygon.loops.push_back(std::move(loop));
  }
  if (polygon.loops.empty()) return;
  describe(polygon);
  polygons.push_back(std::move(polygon));
}

void OccluderPolygons::describe(OccluderPolygon& polygon) const {
  Vec3 area(0.0);
  for (const std::vector<Index>& loop : polygon.loops) {
    area += vectorArea(loop.size(), [&](std::size_t k) { return vertices[loop[k]]; });
    for (const Index v : loop) {
      polygon.box.add(vertices[v]);
      const double height = glm::dot(polygon.normal, vertices[v]) - polygon.offset;
      polygon.deviation = std::max(polygon.deviation, std::abs(height));
    }
  }
  polygon.planar = polygon.deviation <= coincidence;
  polygon.area = glm::dot(area, polygon.normal);
  std::vector<Index> all;
  for (const std::vector<Index>& loop : polygon.loops)
    all.insert(all.end(), loop.begin(), loop.end());
  polygon.corners = planarHull(vertices, all, polygon.normal, coincidence);
  if (polygon.corners.empty()) polygon.corners = std::move(all);
  polygon.convex = polygon.loops.size() == 1;
  const std::vector<Index>& loop = polygon.loops[0];
  for (std::size_t k = 0; polygon.convex && k < loop.size(); ++k) {
    const Vec3& a = vertices[loop[k]];
    const Vec3& b = vertices[loop[(k + 1) % loop.size()]];
    const Vec3& c = vertices[loop[(k + 2) % loop.size()]];
    // A corner that turns inward by less than the coincidence is straight.
    const Vec3 chord = c - a;
    const double turn = glm::dot(glm::cross(b - a, chord), polygon.normal);
    if (turn < -coincidence * glm::length(chord)) polygon.convex = false;
  }
}

void OccluderPolygons::findBounding() {
  for (OccluderPolygon& polygon : polygons) {
    // A patch that is not planar stands for its plane, with its deviation as tolerance.
    const double tolerance = std::max(coincidence, polygon.deviation);
    const bool above = !allBehind(polygon.normal, polygon.offset, tolerance);
    const bool below = !allBehind(-polygon.normal, -polygon.offset, tolerance);
    polygon.bounds_scene = !(above && below);
    polygon.faces_scene = !below;
  }
}

OccluderEdgeUsers OccluderPolygons::edgeUsers() const {
  OccluderEdgeUsers users;
  for (Index p = 0; p < polygons.size(); ++p) {
    for (const std::vector<Index>& loop : polygons[p].loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        users[{loop[k], loop[(k + 1) % loop.size()]}].push_back(p);
      }
    }
  }
  return users;
}

std::vector<std::array<Index, 3>> OccluderPolygons::trianglesOf(
    const OccluderPolygon& polygon) const {
  const std::vector<std::span<const Index>> loops(polygon.loops.begin(), polygon.loops.end());
  return triangulatePolygon(vertices, loops, polygon.normal)
      .value_or(std::vector<std::array<Index, 3>>());
}

}  // namespace radiosity
