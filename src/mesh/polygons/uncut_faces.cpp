#include "mesh/polygons/uncut_faces.h"

#include <fmt/format.h>

#include <array>
#include <glm/geometric.hpp>
#include <map>
#include <string>

#include "base/geometry/plane_frame.h"
#include "mesh/plane_image.h"
#include "mesh/polygons/merge_cells.h"
#include "mesh/triangulate.h"
#include "radiosity/spelling.h"

namespace radiosity {

namespace {

struct Sum {
  std::size_t faces = 0;
  double area = 0;

  void add(const InputFace& face) {
    ++faces;
    area += face.area;
  }
};

/// Appends a triangle and returns its area.
double appendTriangle(const std::array<Vec3, 3>& corners, const InputFace& face, bool back,
                      CoarseComplex& complex) {
  const Vec3 area = vectorArea(3, [&](std::size_t k) { return corners[k]; });
  // The triangle is thinner than rounding, so it has no normal.
  if (!(glm::dot(area, face.normal) > 0)) return 0;
  CoarsePolygon p;
  auto& loop = p.loops.emplace_back();
  for (const Vec3& corner : corners) {
    loop.push_back(Index(complex.vertices.size()));
    complex.vertices.push_back(corner);
  }
  p.normal = glm::normalize(area);
  p.surface = face.surface;
  p.coincidence = face.coincidence;
  p.back = back;
  p.faces = {face.source};
  complex.polygons.push_back(std::move(p));
  return glm::length(area);
}

}  // namespace

void addUncut(const Scene& scene, const InputFaces& input, CoarseComplex& complex,
              MeshReport& report) {
  for (const InputFace& face : input.uncut) {
    const PlaneImage image(face.normal);
    std::vector<Vec2> outline;
    outline.reserve(face.loop.size());
    for (const Index v : face.loop) outline.push_back(image(input.points[v]));
    const bool back = scene.materials[scene.surfaces[face.surface].material].two_sided;
    double kept = 0;
    for (const auto& t : triangulateOutline(outline)) {
      kept += appendTriangle({input.points[face.loop[t[0]]], input.points[face.loop[t[1]]],
                              input.points[face.loop[t[2]]]},
                             face, back, complex);
    }
    addMovedArea(report.surfaces[face.surface], face.area - kept);
  }
}

void noteHandling(const InputFaces& input, MeshReport& report) {
  std::map<std::string, Sum> alone;
  std::map<std::string, Sum> uncut;
  for (const InputFace& face : input.faces) {
    if (face.handling == Handling::alone) alone[report.surfaces[face.surface].name].add(face);
  }
  for (const InputFace& face : input.uncut) uncut[report.surfaces[face.surface].name].add(face);
  for (const auto& [name, sum] : alone) {
    report.notes.push_back(
        {Severity::info,
         fmt::format("{}: {} faces ({:.6g} m^2) were not merged with their neighbours: details "
                     "there are about as small as the coincidence of {:.3g} m",
                     name, sum.faces, sum.area, input.coincidence)});
  }
  for (const auto& [name, sum] : uncut) {
    report.notes.push_back(
        {Severity::warning,
         fmt::format("{}: {} faces ({:.6g} m^2) were taken as they are, not cut where others touch "
                     "them: details there are about as small as the coincidence of {:.3g} m; try a "
                     "smaller or a larger {}",
                     name, sum.faces, sum.area, input.coincidence, spelled("weld"))});
  }
}

}  // namespace radiosity
