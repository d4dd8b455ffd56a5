#include "mesh/patches/faces_under_patches.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/geometry/clip.h"
#include "mesh/box_pairs.h"
#include "mesh/triangulate.h"

namespace radiosity {

namespace {

// Once faces cover this share of a patch, farther ones are ignored: welding may leave slits as wide
// as the coincidence.
constexpr double kCovered = 0.999;

template <class Value>
Value between(const FlatTriangle& triangle, const std::array<Value, 3>& value, const Vec2& q) {
  const std::array<Vec2, 3>& p = triangle.p;
  const double whole = cross2(p[1] - p[0], p[2] - p[0]);
  const double second = cross2(q - p[0], p[2] - p[0]) / whole;
  const double third = cross2(p[1] - p[0], q - p[0]) / whole;
  return value[0] + second * (value[1] - value[0]) + third * (value[2] - value[0]);
}

}  // namespace

VaryingSurfaces::VaryingSurfaces(const Scene& scene)
    : textured(scene.surfaces.size()), coloured(scene.surfaces.size()) {
  for (std::size_t s = 0; s < scene.surfaces.size() && !scene.texcoords.empty(); ++s) {
    const Material& material = scene.materials[scene.surfaces[s].material];
    textured[s] = material.texture != kNone || material.emission_texture != kNone;
  }
  for (std::size_t f = 0; f < scene.faceCount() && !scene.colours.empty(); ++f) {
    const auto colours =
        std::span(scene.colours)
            .subspan(scene.face_offset[f], scene.face_offset[f + 1] - scene.face_offset[f]);
    const bool white =
        std::all_of(colours.begin(), colours.end(), [](const Vec3& c) { return c == Vec3(1.0); });
    if (!white) coloured[scene.face_surface[f]] = true;
  }
}

Vec2 FlatTriangle::map(const Vec2& q) const { return between(*this, uv, q); }

Vec3 FlatTriangle::colourAt(const Vec2& q) const {
  return glm::clamp(between(*this, colour, q), 0.0, 1.0);
}

std::vector<Vec2> FlatTriangle::partOf(std::vector<Vec2> polygon) const {
  std::vector<Vec2> scratch;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2& a = p[k];
    const Vec2 along = p[(k + 1) % 3] - a;
    clipLoop(polygon, scratch, [&](const Vec2& q) { return cross2(along, q - a); });
  }
  return polygon;
}

/// A face seen along a patch's normal: its distance from the patch's plane.
struct FacesUnderPatches::Candidate {
  Index face;
  double distance;
};

FacesUnderPatches::FacesUnderPatches(const Scene& scene, const PatchMesh& mesh,
                                     const VaryingSurfaces& varying,
                                     std::span<const std::uint8_t> wanted)
    : scene_(scene), mesh_(mesh), varying_(varying), near_(mesh.size()) {
  std::vector<Index> patches;
  std::vector<Index> first_boxes;
  std::vector<Box3> boxes;
  for (Index i = 0; i < mesh.size(); ++i) {
    if (!varies(i) || (!wanted.empty() && wanted[i] == 0)) continue;
    first_boxes.push_back(Index(boxes.size()));
    boxes.push_back(boxOf(i).grown(reachOf(i)));
    patches.push_back(i);
  }
  if (patches.empty()) return;
  std::vector<Index> faces;
  for (Index f = 0; f < scene.faceCount(); ++f) {
    if (!varying.at(scene.face_surface[f])) continue;
    Box3& box = boxes.emplace_back();
    for (const Index v : scene.face(f)) box.add(scene.vertices[v]);
    faces.push_back(f);
  }
  for (const auto& [p, other] : overlappingPairs(boxes, first_boxes)) {
    if (other < patches.size()) continue;
    const Index f = faces[other - patches.size()];
    if (scene.face_surface[f] == mesh.surface[patches[p]]) near_[patches[p]].push_back(f);
  }
}

Box3 FacesUnderPatches::boxOf(std::size_t i) const {
  Box3 box;
  for (const Index v : mesh_.outline(i)) box.add(mesh_.vertices[v]);
  return box;
}

double FacesUnderPatches::reachOf(std::size_t i) const {
  const Box3 box = boxOf(i);
  return 1e-3 * glm::length(box.high - box.low);
}

bool FacesUnderPatches::varies(std::size_t i) const {
  return mesh_.side[i] == 0 && mesh_.area[i] > 0 && varying_.at(mesh_.surface[i]);
}

PlaneFrame FacesUnderPatches::frameOf(std::size_t i) const {
  return makeFrame(mesh_.centroid[i], mesh_.normal[i], axisAcross(mesh_.normal[i]));
}

double FacesUnderPatches::forParts(
    std::size_t i, bool coloured,
    const std::function<void(const FlatTriangle&, const std::vector<Vec2>&, double)>& visit) const {
  const PlaneFrame frame = frameOf(i);
  double covered = 0;
  for (const Candidate& candidate : nearestFirst(i, frame)) {
    for (const FlatTriangle& triangle : flattened(candidate.face, coloured, frame)) {
      for (std::size_t t = mesh_.piece_offset[i]; t < mesh_.piece_offset[i + 1]; ++t) {
        std::vector<Vec2> piece;
        piece.reserve(3);
        for (const Index v : mesh_.pieces[t]) piece.push_back(frame.flat(mesh_.vertices[v]));
        const std::vector<Vec2> part = triangle.partOf(std::move(piece));
        const double area = polygonArea(part);
        if (!(area > 0)) continue;
        visit(triangle, part, area);
        covered += area;
      }
    }
    if (covered >= kCovered * mesh_.area[i]) break;
  }
  return covered;
}

/// The faces that look the same way: the source face first, then by distance from the patch's
/// plane.
std::vector<FacesUnderPatches::Candidate> FacesUnderPatches::nearestFirst(
    std::size_t i, const PlaneFrame& frame) const {
  std::vector<Candidate> result = {{mesh_.source_face[i], -1.0}};
  for (const Index f : near_[i]) {
    if (f == mesh_.source_face[i]) continue;
    const auto outline = scene_.face(f);
    const auto corner = [&](std::size_t k) { return scene_.vertices[outline[k]]; };
    const Vec3 area = vectorArea(outline.size(), corner);
    if (glm::dot(area, frame.n) <= 0) continue;
    // The point of the face's plane on the normal through the patch's centroid.
    const double height = glm::dot(corner(0) - frame.origin, area) / glm::dot(area, frame.n);
    result.push_back({f, std::abs(height)});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  return result;
}

std::vector<FlatTriangle> FacesUnderPatches::flattened(Index face, bool coloured,
                                                       const PlaneFrame& frame) const {
  const auto outline = scene_.face(face);
  std::vector<Vec2> flat;
  flat.reserve(outline.size());
  for (const Index v : outline) flat.push_back(frame.flat(scene_.vertices[v]));
  std::vector<FlatTriangle> result;
  const std::size_t first = scene_.face_offset[face];
  for (const auto& t : triangulateOutline(flat)) {
    FlatTriangle triangle{{flat[t[0]], flat[t[1]], flat[t[2]]},
                          {},
                          {Vec3(1.0), Vec3(1.0), Vec3(1.0)},
                          {outline[t[0]], outline[t[1]], outline[t[2]]}};
    for (std::size_t k = 0; k < 3; ++k) {
      if (!scene_.texcoords.empty()) triangle.uv[k] = scene_.texcoords[first + t[k]];
      if (coloured) triangle.colour[k] = scene_.colours[first + t[k]];
    }
    if (cross2(triangle.p[1] - triangle.p[0], triangle.p[2] - triangle.p[0]) > 0) {
      result.push_back(triangle);
    }
  }
  return result;
}

}  // namespace radiosity
