#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "base/geometry/clip.h"
#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "mesh/box_pairs.h"
#include "mesh/patches/texture_mean.h"
#include "mesh/triangulate.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

namespace {

/// A triangle of a face flattened onto a patch's plane, with what its corners carry.
struct Mapped {
  std::array<Vec2, 3> p;
  std::array<Vec2, 3> uv;
  std::array<Vec3, 3> colour;

  Vec2 map(const Vec2& q) const { return between(uv, q); }
  /// Within 0 and 1, which rounding at an edge of the triangle would leave.
  Vec3 colourAt(const Vec2& q) const { return glm::clamp(between(colour, q), 0.0, 1.0); }

 private:
  template <class Value>
  Value between(const std::array<Value, 3>& value, const Vec2& q) const {
    const double whole = cross2(p[1] - p[0], p[2] - p[0]);
    const double second = cross2(q - p[0], p[2] - p[0]) / whole;
    const double third = cross2(p[1] - p[0], q - p[0]) / whole;
    return value[0] + second * (value[1] - value[0]) + third * (value[2] - value[0]);
  }
};

/// A face seen along a patch's normal: its triangles, and its distance from the patch's plane.
struct Candidate {
  Index face;
  double distance;
};

// Once faces cover this share of a patch, farther ones are ignored: welding may leave slits as wide
// as the coincidence.
constexpr double kCovered = 0.999;

class PatchTexture {
 public:
  PatchTexture(const Scene& scene, const PatchMesh& mesh, std::span<const TextureMean> textures)
      : scene_(scene), mesh_(mesh), textures_(textures) {}

  /// The area mean over patch i of what multiplies its reflectance: a texture of the scene (or
  /// kNone), and the vertex colours if `coloured`. `faces`: the faces that may lie under the patch.
  /// Where both vary within one face and patch, the product of their means stands for the mean of
  /// their product.
  Vec3 mean(std::size_t i, Index texture_index, bool coloured,
            const std::vector<Index>& faces) const {
    const TextureMean* texture = texture_index == kNone ? nullptr : &textures_[texture_index];
    const PlaneFrame frame =
        makeFrame(mesh_.centroid[i], mesh_.normal[i], axisAcross(mesh_.normal[i]));
    Sum sum;
    for (const Candidate& candidate : nearestFirst(i, frame, faces)) {
      for (const Mapped& triangle : flattened(candidate.face, coloured, frame)) {
        for (std::size_t t = mesh_.piece_offset[i]; t < mesh_.piece_offset[i + 1]; ++t) {
          add(texture, triangle, mesh_.pieces[t], frame, sum);
        }
      }
      if (sum.area >= kCovered * mesh_.area[i]) break;
    }
    if (sum.area > 0) return sum.colour / sum.area;
    // No face lies under the patch (the face is almost perpendicular): we take one corner's value.
    const std::size_t corner = scene_.face_offset[mesh_.source_face[i]];
    return (texture == nullptr ? Vec3(1.0) : texture->at(scene_.texcoords[corner])) *
           (coloured ? scene_.colours[corner] : Vec3(1.0));
  }

 private:
  struct Sum {
    Vec3 colour{0.0};
    double area = 0;
  };

  /// The faces that look the same way: the source face first, then by distance from the patch's
  /// plane.
  std::vector<Candidate> nearestFirst(std::size_t i, const PlaneFrame& frame,
                                      const std::vector<Index>& faces) const {
    std::vector<Candidate> result = {{mesh_.source_face[i], -1.0}};
    for (const Index f : faces) {
      if (f == mesh_.source_face[i]) continue;
      const auto outline = scene_.face(f);
      const auto corner = [&](std::size_t k) { return scene_.vertices[outline[k]]; };
      const Vec3 area = vectorArea(outline.size(), corner);
      if (glm::dot(area, frame.n) <= 0) continue;
      // The point of the face's plane on the normal through the patch's centroid.
      const double height = glm::dot(corner(0) - frame.origin, area) / glm::dot(area, frame.n);
      result.push_back({f, std::abs(height)});
    }
    std::stable_sort(result.begin(), result.end(), [](const Candidate& a, const Candidate& b) {
      return a.distance < b.distance;
    });
    return result;
  }

  std::vector<Mapped> flattened(Index face, bool coloured, const PlaneFrame& frame) const {
    const auto outline = scene_.face(face);
    std::vector<Vec2> flat;
    flat.reserve(outline.size());
    for (const Index v : outline) flat.push_back(frame.flat(scene_.vertices[v]));
    std::vector<Mapped> result;
    const std::size_t first = scene_.face_offset[face];
    for (const auto& t : triangulateOutline(flat)) {
      Mapped triangle{{flat[t[0]], flat[t[1]], flat[t[2]]}, {}, {Vec3(1.0), Vec3(1.0), Vec3(1.0)}};
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

  /// Adds the part of a piece of the patch that lies in `triangle`.
  void add(const TextureMean* texture, const Mapped& triangle, const std::array<Index, 3>& piece,
           const PlaneFrame& frame, Sum& sum) const {
    std::vector<Vec2> part;
    part.reserve(piece.size());
    std::vector<Vec2> scratch;
    for (const Index v : piece) part.push_back(frame.flat(mesh_.vertices[v]));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2& a = triangle.p[k];
      const Vec2 along = triangle.p[(k + 1) % 3] - a;
      clipLoop(part, scratch, [&](const Vec2& p) { return cross2(along, p - a); });
    }
    const double area = polygonArea(part);
    if (!(area > 0)) return;
    const Vec3 texel = texture == nullptr ? Vec3(1.0) : meanOver(*texture, triangle, part);
    sum.colour += area * texel * triangle.colourAt(polygonCentroid(part));
    sum.area += area;
  }

  static Vec3 meanOver(const TextureMean& texture, const Mapped& triangle,
                       const std::vector<Vec2>& part) {
    std::vector<Vec2> uv;
    Vec2 low(std::numeric_limits<double>::infinity());
    Vec2 high = -low;
    for (const Vec2& p : part) {
      uv.push_back(triangle.map(p));
      low = glm::min(low, uv.back());
      high = glm::max(high, uv.back());
    }
    const Vec2 extent = high - low;
    if (std::abs(polygonArea(uv)) > 1e-6 * glm::dot(extent, extent)) return texture.over(uv);
    // The map is a line or a point (palettes, gradients): we take the texels at the middles of
    // equal parts of the polygon's fan.
    constexpr int kParts = 32;
    Vec3 colour(0.0);
    double total = 0;
    for (std::size_t k = 2; k < part.size(); ++k) {
      const Vec2 a = (part[k - 1] - part[0]) / double(kParts);
      const Vec2 b = (part[k] - part[0]) / double(kParts);
      for (int r = 0; r < kParts; ++r) {
        for (int s = 0; r + s < kParts; ++s) {
          const Vec2 corner = part[0] + double(r) * a + double(s) * b;
          const double area = std::max(0.0, cross2(a, b));  // below 0 by rounding only
          colour += area * texture.at(triangle.map(corner + (a + b) / 3.0));
          total += area;
          if (r + s + 1 == kParts) continue;
          colour += area * texture.at(triangle.map(corner + (a + b) * (2.0 / 3.0)));
          total += area;
        }
      }
    }
    return total > 0 ? colour / total : texture.at(uv[0]);
  }

  const Scene& scene_;
  const PatchMesh& mesh_;
  std::span<const TextureMean> textures_;
};

/// Which surfaces have a reflectance or emission that changes from point to point.
struct Varying {
  std::vector<bool> textured;
  std::vector<bool> coloured;

  explicit Varying(const Scene& scene)
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
  bool at(Index surface) const { return textured[surface] || coloured[surface]; }
};

/// For every front patch whose material varies, the faces of its surface whose boxes meet its own.
std::vector<std::vector<Index>> facesNear(const Scene& scene, const PatchMesh& mesh,
                                          const Varying& varying) {
  std::vector<Index> patches;
  std::vector<Index> first_boxes;
  std::vector<Box3> boxes;
  for (Index i = 0; i < mesh.size(); ++i) {
    if (mesh.side[i] != 0 || !(mesh.area[i] > 0) || !varying.at(mesh.surface[i])) continue;
    Box3 box;
    for (const Index v : mesh.outline(i)) box.add(mesh.vertices[v]);
    // Rounding or welding may separate patch and face, so we add a little of the patch's own size.
    first_boxes.push_back(Index(boxes.size()));
    boxes.push_back(box.grown(1e-3 * glm::length(box.high - box.low)));
    patches.push_back(i);
  }
  std::vector<std::vector<Index>> near(mesh.size());
  if (patches.empty()) return near;
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
    if (scene.face_surface[f] == mesh.surface[patches[p]]) near[patches[p]].push_back(f);
  }
  return near;
}

}  // namespace

void PatchMaterials::requireSizes(std::size_t patches) const {
  if (bands < 1) {
    throw InputError(fmt::format("materials: {} bands; 1 or more are needed", bands));
  }
  const std::size_t needed = patches * std::size_t(bands);
  const auto check = [&](const char* what, std::size_t size) {
    if (size == needed) return;
    throw InputError(
        fmt::format("materials: {} {} are given, {} patches of {} bands take {}: a row of all "
                    "bands for each patch; set `bands` to what a row holds",
                    size, what, patches, bands, needed));
  };
  check("reflectances", reflectance.size());
  check("emissions", emission.size());
  if (sky.empty() || sky.size() == std::size_t(bands)) return;
  throw InputError(
      fmt::format("materials: the sky has {} bands, the patches have {}; give it as many, or none "
                  "where it is dark",
                  sky.size(), bands));
}

PatchMaterials patchMaterials(const Scene& scene, const PatchMesh& mesh) {
  PatchMaterials result;
  result.reflectance.resize(3 * mesh.size());
  result.emission.resize(3 * mesh.size());
  result.sky = {scene.sky.x, scene.sky.y, scene.sky.z};
  const auto put = [](std::vector<double>& values, std::size_t i, const Vec3& value) {
    for (int b = 0; b < 3; ++b) values[3 * i + std::size_t(b)] = value[b];
  };
  std::vector<TextureMean> textures;
  textures.reserve(scene.textures.size());
  for (const Texture& texture : scene.textures) textures.emplace_back(texture);
  const PatchTexture patch_texture(scene, mesh, textures);
  const Varying varying(scene);
  const std::vector<std::vector<Index>> near = facesNear(scene, mesh, varying);
  parallelFor(mesh.size(), 64, [&](std::size_t i) {
    const Material& material = scene.materials[scene.surfaces[mesh.surface[i]].material];
    Vec3 reflectance = material.reflectance;
    Vec3 emission = material.emission;
    const Index surface = mesh.surface[i];
    if (mesh.side[i] == 0 && mesh.area[i] > 0 && varying.at(surface)) {
      const auto used = [&](Index texture) { return varying.textured[surface] ? texture : kNone; };
      const Index texture = used(material.texture);
      if (texture != kNone || varying.coloured[surface]) {
        reflectance *= patch_texture.mean(i, texture, varying.coloured[surface], near[i]);
      }
      if (used(material.emission_texture) != kNone) {
        emission *= patch_texture.mean(i, material.emission_texture, false, near[i]);
      }
    }
    put(result.reflectance, i, reflectance);
    put(result.emission, i, emission);
  });
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.side[i] == 0) continue;
    for (std::size_t b = 0; b < 3; ++b) {
      result.reflectance[3 * i + b] = result.reflectance[3 * mesh.twin[i] + b];
      result.emission[3 * i + b] = result.emission[3 * mesh.twin[i] + b];
    }
  }
  return result;
}

std::vector<Index> emittingUnknowns(const PatchMesh& mesh, const PatchMaterials& materials) {
  materials.requireSizes(mesh.size());
  const auto bands = std::size_t(materials.bands);
  std::vector<std::uint8_t> emits(mesh.unknowns(), 0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto emission = std::span(materials.emission).subspan(i * bands, bands);
    if (std::any_of(emission.begin(), emission.end(), [](double m) { return m > 0; })) {
      emits[mesh.unknownOf(i)] = 1;
    }
  }
  std::vector<Index> unknowns;
  for (Index u = 0; u < emits.size(); ++u) {
    if (emits[u] != 0) unknowns.push_back(u);
  }
  return unknowns;
}

}  // namespace radiosity
