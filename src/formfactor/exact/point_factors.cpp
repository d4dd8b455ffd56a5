// Form factors from points to patches, past flat occluders. Solids, which the exact method puts in
// the place of closed bodies, and polygons that it leaves out since nothing is behind them, are
// proved for points of patches alone; here every polygon blocks by itself.
#include "radiosity/point_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "base/finite.h"
#include "base/parallel.h"
#include "formfactor/exact/elements/elements.h"
#include "formfactor/exact/flat_polygon.h"
#include "formfactor/exact/occluded/visible_part.h"
#include "formfactor/exact/occluders/flat.h"
#include "formfactor/exact/occluders/polygons.h"
#include "formfactor/exact/visibility/tree.h"

namespace radiosity {
namespace {

/// A half-space that holds everything.
constexpr HalfSpace kAnywhere{{0.0, 0.0, 0.0}, -1.0};
/// Normals that agree to so much: the surface is below the point's horizon, but for rounding.
constexpr double kAligned = 1e-12;

struct Sensor {
  Vec3 eye{0.0};  ///< in ElementSet's coordinates
  Vec3 normal{0.0};
  double horizon = 0;
  std::vector<Index> touched;  ///< occluders that it lies on, which are below its horizon; sorted
};

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

class SensorView {
 public:
  SensorView(const PatchMesh& mesh, Progress& progress)
      : elements_(mesh, progress),
        occluders_(flatOccluders(mesh, elements_, progress)),
        tree_(occluders_) {}

  /// Adds the form factors from a point to `row`, N values.
  void look(const Vec3& point, const Vec3& normal, std::span<double> row) const {
    const Sensor sensor = placed(point, normal);
    const double touching = elements_.coincidence;
    for (const Facet& facet : elements_.facets) {
      if (facet.black || glm::dot(facet.normal, sensor.eye) - facet.offset <= touching) continue;
      for (Index e = facet.elements.first; e < facet.elements.end; ++e) {
        row[elements_.patch[e]] += visible(sensor, facet, e);
      }
    }
  }

 private:
  /// The point, off the surfaces that it lies on.
  Sensor placed(const Vec3& point, const Vec3& normal) const {
    Sensor sensor;
    sensor.eye = (point - elements_.middle) * elements_.scale;
    sensor.normal = glm::normalize(normal);
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

  /// Whether a point lies on a flat occluder or on its border.
  bool isOn(const Occluder& flat, const Vec3& at) const {
    const Vec3 normal = flat.planes[0].normal;
    if (std::abs(glm::dot(normal, at) - flat.planes[0].offset) > elements_.coincidence)
      return false;
    return std::none_of(flat.edges.begin(), flat.edges.end(), [&](const Occluder::Edge& edge) {
      const Vec3& from = flat.corners[edge.from];
      const Vec3 along = flat.corners[edge.to] - from;
      return glm::dot(glm::cross(normal, along), at - from) <
             -elements_.coincidence * glm::length(along);
    });
  }

  double visible(const Sensor& sensor, const Facet& facet, Index e) const {
    thread_local VisiblePart part;
    thread_local std::vector<Blocker> blockers;
    thread_local std::vector<Index> between;
    const double touching = elements_.coincidence;
    const FlatPolygon target = clipToFront(elements_.outline(e), sensor.normal, sensor.horizon);
    if (target.count < 3) return 0;
    between.clear();
    std::size_t tests = 0;
    tree_.query({sensor.eye, 0}, {elements_.centroid[e], elements_.radius[e]},
                {sensor.normal, sensor.horizon}, {facet.normal, facet.offset + touching}, between,
                tests);
    std::sort(between.begin(), between.end());
    blockers.clear();
    for (const Index o : between) {
      if (std::binary_search(sensor.touched.begin(), sensor.touched.end(), o)) continue;
      const Occluder& body = occluders_[o];
      const bool cuts = std::any_of(body.corners.begin(), body.corners.end(), [&](const Vec3& c) {
        return glm::dot(facet.normal, c) < facet.offset - touching;
      });
      blockers.push_back({&body, o, cuts});
    }
    return part.look(sensor.eye, sensor.normal, target.outline(), blockers).visible;
  }

  ElementSet elements_;
  std::vector<Occluder> occluders_;
  OccluderTree tree_;
};

void requirePoints(const PatchMesh& mesh, std::span<const Vec3> points,
                   std::span<const Vec3> normals, std::span<double> factors) {
  if (normals.size() != points.size()) {
    throw InputError(
        fmt::format("view factors from points: {} points and {} normals; give one "
                    "normal a point",
                    points.size(), normals.size()));
  }
  if (factors.size() != points.size() * mesh.size()) {
    throw InputError(
        fmt::format("view factors from points: {} values are needed for {} points and "
                    "{} patches, there is room for {}",
                    points.size() * mesh.size(), points.size(), mesh.size(), factors.size()));
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!isFinite(points[k])) {
      throw InputError(fmt::format(
          "view factors from points: point {} has a coordinate that is no finite number", k));
    }
    if (!isFinite(normals[k]) || !(glm::length(normals[k]) > 0)) {
      throw InputError(fmt::format(
          "view factors from points: normal {} has no direction; give a finite vector that is not "
          "0",
          k));
    }
  }
}

}  // namespace

void pointFormFactors(const PatchMesh& mesh, std::span<const Vec3> points,
                      std::span<const Vec3> normals, std::span<double> factors,
                      Progress& progress) {
  requirePoints(mesh, points, normals, factors);
  const SensorView view(mesh, progress);
  std::fill(factors.begin(), factors.end(), 0.0);
  progress.begin("view factors", points.size(), "points");
  parallelFor(points.size(), 1, [&](std::size_t k) {
    if (progress.cancelled()) return;
    view.look(points[k], normals[k], factors.subspan(k * mesh.size(), mesh.size()));
    progress.advance();
  });
  progress.check();
  progress.end();
}

}  // namespace radiosity
