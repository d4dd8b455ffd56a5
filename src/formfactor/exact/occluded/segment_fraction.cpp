#include "formfactor/exact/occluded/segment_fraction.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "formfactor/exact/occluded/cell_rule.h"

namespace radiosity {
namespace {

/// Whether a segment runs through a convex body, or through its plane inside its outline.
bool meets(const Occluder& body, const Vec3& from, const Vec3& to) {
  double enter = 0;
  double leave = 1;
  for (const Occluder::Plane& plane : body.planes) {
    const double a = glm::dot(plane.normal, from) - plane.offset;
    const double b = glm::dot(plane.normal, to) - plane.offset;
    if (a > 0 && b > 0) return false;
    if (a > 0) enter = std::max(enter, a / (a - b));
    if (b > 0) leave = std::min(leave, a / (a - b));
  }
  if (!body.flat) return enter < leave;
  // Its two faces are one plane: the outline decides.
  const Vec3& normal = body.planes[0].normal;
  const double a = glm::dot(normal, from) - body.planes[0].offset;
  const double b = glm::dot(normal, to) - body.planes[0].offset;
  if (!(a * b < 0)) return false;
  const Vec3 at = from + (to - from) * (a / (a - b));
  return std::all_of(body.edges.begin(), body.edges.end(), [&](const Occluder::Edge& edge) {
    const Vec3& corner = body.corners[edge.from];
    const Vec3 across = glm::cross(normal, body.corners[edge.to] - corner);
    return glm::dot(across, at - corner) >= 0;
  });
}

SamplePoints pointsOf(const ElementSet& elements, Index element) {
  return SampleCell{elements.corners[element]}.points(3);
}

double heightOver(const ElementSet& elements, Index element, const Vec3& point) {
  const Facet& facet = elements.facets[elements.facet[element]];
  return glm::dot(facet.normal, point) - facet.offset;
}

}  // namespace

OccludedExchange exchangeBySegments(const ElementSet& elements, const OccluderSet& occluders,
                                    const OccludedPair& pair,
                                    std::span<const Index> occluder_list) {
  const auto between =
      occluder_list.subspan(pair.occluders_begin, pair.occluders_end - pair.occluders_begin);
  std::size_t all = 0;
  std::size_t clear = 0;
  const SamplePoints columns = pointsOf(elements, pair.column);
  const SamplePoints rows = pointsOf(elements, pair.row);
  for (const SamplePoint& p : rows.all()) {
    if (!(heightOver(elements, pair.column, p.position) > 0)) continue;
    for (const SamplePoint& q : columns.all()) {
      if (!(heightOver(elements, pair.row, q.position) > 0)) continue;
      ++all;
      clear += std::none_of(between.begin(), between.end(), [&](Index o) {
        return meets(occluders.occluders[o], p.position, q.position);
      });
    }
  }
  if (all == 0) return {0, pair.unoccluded};
  const double fraction = double(clear) / double(all);
  const double least = 1 / double(all);
  const double error = std::sqrt(std::max(fraction * (1 - fraction), least) / double(all));
  return {pair.unoccluded * fraction, pair.unoccluded * error};
}

}  // namespace radiosity
