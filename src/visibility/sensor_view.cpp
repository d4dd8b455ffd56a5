#include "visibility/sensor_view.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "visibility/clipping/flat_polygon.h"
#include "visibility/clipping/visible_part.h"
#include "visibility/occluders/flat.h"
#include "visibility/occluders/polygons.h"

namespace radiosity {
namespace {

/// Normals that agree to this: the surface is below the point's horizon, but for rounding.
constexpr double kAligned = 1e-12;

/// Every polygon in convex pieces.
std::vector<Occluder> flatOccluders(const PatchMesh& mesh, const ElementSet& elements,
                                    Progress& progress) {
  OccluderPolygons all(mesh, elements);
  const std::vector<std::uint8_t> none(all.polygons.size(), 0);
  std::vector<Occluder> occluders;
  for (const FlatPiece& piece : flatPieces(all, none, progress)) {
    Occluder occluder;
    if (makeFlatOccluder(all, piece, occluder)) occluders.push_back(std::move(occluder));
  }
  return occluders;
}

}  // namespace

SensorView::SensorView(const PatchMesh& mesh, Progress& progress)
    : elements_(mesh, progress),
      occluders_(flatOccluders(mesh, elements_, progress)),
      tree_(occluders_) {}

Sensor SensorView::placed(const Vec3& eye, const Vec3& normal) const {
  Sensor sensor;
  sensor.eye = eye;
  sensor.normal = normal;
  const double touching = elements_.coincidence;
  const Sphere ball{sensor.eye, touching};
  std::vector<Index> near;
  std::size_t tests = 0;
  tree_.query(ball, ball, kAnywhere, kAnywhere, near, tests);
  Vec3 lift(0.0);
  for (const Index o : near) {
    const Occluder::Plane& plane = occluders_[o].planes[0];
    if (!isOn(occluders_[o], sensor.eye)) continue;
    const double cosine = glm::dot(plane.normal, sensor.normal);
    if (std::abs(cosine) > 1 - kAligned) {
      sensor.touched.push_back(o);
    } else {
      lift += (cosine < 0 ? -2 : 2) * touching * plane.normal;
    }
  }
  sensor.eye += lift;
  std::sort(sensor.touched.begin(), sensor.touched.end());
  sensor.horizon = glm::dot(sensor.normal, sensor.eye);
  return sensor;
}

bool SensorView::faces(const Sensor& sensor, const Facet& facet) const {
  return !facet.black && glm::dot(facet.normal, sensor.eye) - facet.offset > elements_.coincidence;
}

double SensorView::visible(const Sensor& sensor, const Facet& facet, Index e) const {
  constexpr auto kAny = std::numeric_limits<std::size_t>::max();
  const Target target{elements_.outline(e), facet.normal, facet.offset, elements_.centroid[e],
                      elements_.radius[e]};
  return visible(sensor, target, kAny).value_or(0);
}

std::optional<double> SensorView::visible(const Sensor& sensor, const Target& target,
                                          std::size_t most) const {
  thread_local VisiblePart part;
  thread_local std::vector<Blocker> blockers;
  thread_local std::vector<Index> between;
  const double touching = elements_.coincidence;
  const FlatPolygon above = clipToFront(target.outline, sensor.normal, sensor.horizon);
  if (above.count < 3) return 0;
  between.clear();
  std::size_t tests = 0;
  tree_.query({sensor.eye, 0}, {target.centre, target.radius}, {sensor.normal, sensor.horizon},
              {target.normal, target.offset + touching}, between, tests, most);
  if (between.size() > most) return std::nullopt;
  std::sort(between.begin(), between.end());
  blockers.clear();
  for (const Index o : between) {
    if (std::binary_search(sensor.touched.begin(), sensor.touched.end(), o)) continue;
    const Occluder& body = occluders_[o];
    const bool cuts = std::any_of(body.corners.begin(), body.corners.end(), [&](const Vec3& c) {
      return glm::dot(target.normal, c) < target.offset - touching;
    });
    blockers.push_back({&body, o, cuts});
  }
  return part.look(sensor.eye, sensor.normal, above.outline(), blockers).visible;
}

/// Whether a point lies on a flat occluder or on its border.
bool SensorView::isOn(const Occluder& flat, const Vec3& at) const {
  const Vec3 normal = flat.planes[0].normal;
  if (std::abs(glm::dot(normal, at) - flat.planes[0].offset) > elements_.coincidence) return false;
  return std::none_of(flat.edges.begin(), flat.edges.end(), [&](const Occluder::Edge& edge) {
    const Vec3& from = flat.corners[edge.from];
    const Vec3 along = flat.corners[edge.to] - from;
    return glm::dot(glm::cross(normal, along), at - from) <
           -elements_.coincidence * glm::length(along);
  });
}

}  // namespace radiosity
