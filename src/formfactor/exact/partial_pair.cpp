#include "formfactor/exact/partial_pair.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace radiosity {
namespace {

/// The part of an element in front of a facet's plane.
std::vector<Vec3> inFront(const ElementSet& elements, Index element, const Facet& facet) {
  ConvexPolygon polygon;
  polygon.assign(elements.outline(element), Vec3(0.0));
  ConvexPolygon front;
  switch (split(polygon, {facet.normal, -facet.offset}, 0, &front, nullptr)) {
    case PlaneSide::inside:
      return polygon.corners;
    case PlaneSide::outside:
      return {};
    default:
      return front.corners;
  }
}

struct Heights {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
};

Heights heights(const Occluder& body, const Facet& facet) {
  Heights h;
  for (const Vec3& p : body.corners) {
    const double d = glm::dot(facet.normal, p) - facet.offset;
    h.least = std::min(h.least, d);
    h.most = std::max(h.most, d);
  }
  return h;
}

/// Square of the distance from a point to the nearest edge of a body.
double edgeDistance2(const Occluder& body, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Occluder::Edge& edge : body.edges) {
    const Vec3 a = p - body.corners[edge.from];
    const Vec3 along = body.corners[edge.to] - body.corners[edge.from];
    const double t = std::clamp(glm::dot(a, along) / glm::dot(along, along), 0.0, 1.0);
    const Vec3 d = a - along * t;
    least = std::min(least, glm::dot(d, d));
  }
  return least;
}

}  // namespace

SampledPair samplePair(const ElementSet& elements, const OccluderSet& occluders, Index row,
                       Index column, std::span<const Index> blockers, SampledEnd end) {
  const Index from = end == SampledEnd::row ? row : column;
  const Index to = end == SampledEnd::row ? column : row;
  const Facet& from_facet = elements.facets[elements.facet[from]];
  const Facet& to_facet = elements.facets[elements.facet[to]];
  SampledPair pair;
  pair.normal = from_facet.normal;
  pair.sampled = inFront(elements, from, to_facet);
  pair.target = inFront(elements, to, from_facet);
  for (const Index id : blockers) {
    const Occluder& body = occluders.occluders[id];
    if (heights(body, from_facet).most <= elements.coincidence) continue;
    const Heights above_target = heights(body, to_facet);
    if (above_target.most <= elements.coincidence) continue;
    pair.blockers.push_back({&body, id, above_target.least < -elements.coincidence});
  }
  return pair;
}

SampledEnd fartherEnd(const ElementSet& elements, const OccluderSet& occluders, Index row,
                      Index column, std::span<const Index> blockers) {
  double at_row = std::numeric_limits<double>::infinity();
  double at_column = at_row;
  for (const Index id : blockers) {
    const Occluder& body = occluders.occluders[id];
    at_row = std::min(at_row, edgeDistance2(body, elements.centroid[row]));
    at_column = std::min(at_column, edgeDistance2(body, elements.centroid[column]));
  }
  const double row_size = elements.radius[row];
  const double column_size = elements.radius[column];
  return at_row * column_size * column_size >= at_column * row_size * row_size ? SampledEnd::row
                                                                               : SampledEnd::column;
}

}  // namespace radiosity
