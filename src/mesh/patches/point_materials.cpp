#include "radiosity/point_materials.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "base/geometry/box_tree.h"
#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "mesh/patches/faces_under_patches.h"
#include "mesh/patches/texture_mean.h"

namespace radiosity {

namespace {

/// A triangle of a face under a patch.
struct Textured {
  std::array<Vec3, 3> p;
  std::array<Vec2, 3> uv;
  std::array<Vec3, 3> colour;

  /// Barycentric coordinates of a point, seen along the triangle's normal.
  Vec3 weights(const Vec3& q) const {
    const Vec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double whole = glm::dot(normal, normal);
    const auto share = [&](const Vec3& a, const Vec3& b) {
      return glm::dot(glm::cross(b - a, q - a), normal) / whole;
    };
    return {share(p[1], p[2]), share(p[2], p[0]), share(p[0], p[1])};
  }
  /// Of texture coordinates, over that in space.
  double areaRatio() const {
    const double area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    return std::abs(cross2(uv[1] - uv[0], uv[2] - uv[0])) / area;
  }
};

/// Above this many triangles under a patch a point looks into a tree.
constexpr std::size_t kMany = 16;

/// Triangles of faces under a patch, the nearest faces first.
struct Underlay {
  std::vector<Textured> triangles;
  std::unique_ptr<const BoxTree> tree;  // of many
  double reach = 0;                     // metres from the patch to the faces, at most

  void addTree() {
    std::vector<Box3> boxes(triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t) {
      for (const Vec3& corner : triangles[t].p) boxes[t].add(corner);
    }
    tree = std::make_unique<const BoxTree>(boxes);
  }
};

double least(const Vec3& weights) { return std::min({weights.x, weights.y, weights.z}); }

template <class Value>
Value mixed(const std::array<Value, 3>& values, const Vec3& weights) {
  return weights.x * values[0] + weights.y * values[1] + weights.z * values[2];
}

/// The triangle at a point: the first that holds it, else the one that it is least outside of.
class Search {
 public:
  Search(const Underlay& underlay, const Vec3& point) : underlay_(underlay), point_(point) {
    if (underlay.tree) {
      Box3 box;
      box.add(point);
      underlay.tree->query(box.grown(underlay.reach), [&](Index t) {
        look(t);
        return true;
      });
    }
    if (triangle_ != kNone) return;
    for (Index t = 0; t < underlay.triangles.size() && !holds_; ++t) look(t);
  }

  const Textured& triangle() const { return underlay_.triangles[triangle_]; }
  /// Within the triangle: faces may have been moved apart by welding, or by rounding.
  Vec3 weights() const {
    const Vec3 inside = glm::max(weights_, 0.0);
    return inside / (inside.x + inside.y + inside.z);
  }

 private:
  void look(Index t) {
    const Vec3 here = underlay_.triangles[t].weights(point_);
    const bool holds = least(here) >= 0;
    const bool better = holds ? !holds_ || t < triangle_
                              : !holds_ && (triangle_ == kNone || least(here) > least(weights_));
    if (!better) return;
    triangle_ = t;
    weights_ = here;
    holds_ = holds;
  }

  const Underlay& underlay_;
  const Vec3& point_;
  Index triangle_ = kNone;
  Vec3 weights_{0.0};
  bool holds_ = false;
};

}  // namespace

struct PointMaterials::Data {
  const Scene& scene;
  std::vector<TextureMean> means;
  std::vector<Index> material;     // of each patch
  std::vector<Index> front;        // of each patch: itself, or the patch on the other side
  std::vector<Underlay> underlay;  // of fronts
  std::vector<Vec3> emission;      // of each patch, W/m^2

  Vec3 texel(Index texture, const Textured& triangle, const Vec2& uv, double spacing) const {
    if (texture == kNone || scene.texcoords.empty()) return Vec3(1.0);
    const Texture& image = scene.textures[texture];
    const double texels = triangle.areaRatio() * double(image.width) * double(image.height);
    return means[texture].filtered(uv, spacing * std::sqrt(texels));
  }
};

PointMaterials::PointMaterials(const Scene& scene, const PatchMesh& mesh,
                               const PatchMaterials& materials,
                               std::span<const std::uint8_t> wanted) {
  auto data = std::make_unique<Data>(Data{scene, {}, {}, {}, {}, {}});
  data->means.reserve(scene.textures.size());
  for (const Texture& texture : scene.textures) data->means.emplace_back(texture);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    data->material.push_back(scene.surfaces[mesh.surface[i]].material);
    data->front.push_back(mesh.side[i] == 0 ? Index(i) : mesh.twin[i]);
    const double* emission = &materials.emission[3 * i];
    data->emission.emplace_back(emission[0], emission[1], emission[2]);
  }
  std::vector<std::uint8_t> fronts;
  if (!wanted.empty()) {
    fronts.assign(mesh.size(), 0);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (wanted[i] != 0) fronts[data->front[i]] = 1;
    }
  }
  const VaryingSurfaces varying(scene);
  const FacesUnderPatches faces(scene, mesh, varying, fronts);
  data->underlay.resize(mesh.size());
  parallelFor(mesh.size(), 64, [&](std::size_t i) {
    if (!faces.varies(i) || (!fronts.empty() && fronts[i] == 0)) return;
    std::vector<Textured>& list = data->underlay[i].triangles;
    const bool coloured = varying.coloured[mesh.surface[i]];
    faces.forParts(i, coloured, [&](const FlatTriangle& triangle, const auto&, double) {
      Textured found{{}, triangle.uv, triangle.colour};
      for (std::size_t k = 0; k < 3; ++k) found.p[k] = scene.vertices[triangle.vertex[k]];
      // A patch of several pieces has several parts in one triangle.
      if (list.empty() || list.back().p != found.p) list.push_back(found);
    });
    data->underlay[i].reach = faces.reachOf(i);
    if (list.size() > kMany) data->underlay[i].addTree();
  });
  data_ = std::move(data);
}

PointMaterials::~PointMaterials() = default;

bool PointMaterials::varies(std::size_t patch) const {
  return !data_->underlay[data_->front[patch]].triangles.empty();
}

PointMaterials::Values PointMaterials::at(std::size_t patch, const Vec3& point,
                                          double spacing) const {
  const Search search(data_->underlay[data_->front[patch]], point);
  const Textured& found = search.triangle();
  const Vec3 weights = search.weights();
  const Material& material = data_->scene.materials[data_->material[patch]];
  const Vec2 uv = mixed(found.uv, weights);
  const Vec3 colour = mixed(found.colour, weights);
  Values values;
  values.reflectance =
      material.reflectance * colour * data_->texel(material.texture, found, uv, spacing);
  if (material.emission_texture == kNone || data_->scene.texcoords.empty()) return values;
  const Vec3 emission =
      material.emission * data_->texel(material.emission_texture, found, uv, spacing);
  const Vec3& mean = data_->emission[patch];
  for (int b = 0; b < 3; ++b) values.emission_factor[b] = mean[b] > 0 ? emission[b] / mean[b] : 0.0;
  return values;
}

std::shared_ptr<const PointMaterials> pointMaterials(const Scene& scene, const PatchMesh& mesh,
                                                     const PatchMaterials& materials,
                                                     std::span<const std::uint8_t> wanted) {
  const VaryingSurfaces varying(scene);
  for (Index s = 0; s < scene.surfaces.size(); ++s) {
    if (varying.at(s))
      return std::make_shared<const PointMaterials>(scene, mesh, materials, wanted);
  }
  return nullptr;
}

}  // namespace radiosity
