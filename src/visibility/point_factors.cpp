// Form factors from points to patches, each point by itself.
#include "radiosity/point_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "base/finite.h"
#include "base/parallel.h"
#include "visibility/sensor_view.h"

namespace radiosity {
namespace {

/// Adds the form factors from a point to `row`, N values.
void look(const SensorView& view, const Vec3& point, const Vec3& normal, std::span<double> row) {
  const ElementSet& elements = view.elements();
  const Sensor sensor =
      view.placed((point - elements.middle) * elements.scale, glm::normalize(normal));
  for (const Facet& facet : elements.facets) {
    if (!view.faces(sensor, facet)) continue;
    for (Index e = facet.elements.first; e < facet.elements.end; ++e) {
      row[elements.patch[e]] += view.visible(sensor, facet, e);
    }
  }
}

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
    look(view, points[k], normals[k], factors.subspan(k * mesh.size(), mesh.size()));
    progress.advance();
  });
  progress.check();
  progress.end();
}

}  // namespace radiosity
