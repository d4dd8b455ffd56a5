#include "gather/passes.h"

#include <algorithm>
#include <numbers>

namespace radiosity {
namespace {

FormFactorOptions eyeOptions(const GatherOptions& options) {
  FormFactorOptions eye;
  eye.resolution = options.resolution;
  eye.seed = options.seed;
  eye.random_turns = options.random_turns;
  eye.simd = options.simd;
  return eye;
}

template <class Value>
std::size_t bytesOf(const std::vector<Value>& values) {
  return values.size() * sizeof(Value);
}

}  // namespace

GatherScene::GatherScene(const PatchMesh& patch_mesh, const PatchMaterials& of_patches,
                         const GatherOptions& options)
    : mesh(patch_mesh),
      at(options.at),
      resolution(options.resolution),
      simd(options.simd),
      rows(patch_mesh, eyeOptions(options)),
      sky(of_patches.sky) {
  if (at == GatherAt::patches) {
    standAtPatches(of_patches, options);
  } else {
    standAtVertices(of_patches, options);
  }
  for (std::size_t k = 0; k < materials.emission.size(); ++k) {
    double& largest = materials.largest_emission[k % 3];
    largest = std::max(largest, double(materials.emission[k]));
  }
}

void GatherScene::standAtPatches(const PatchMaterials& of_patches, const GatherOptions& options) {
  eyes = patchEyes(mesh, options);
  area = mesh.area;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (int b = 0; b < 3; ++b) {
      materials.emission.push_back(float(of_patches.emission[i][b]));
      materials.reflectance.push_back(float(of_patches.reflectance[i][b]));
    }
  }
}

void GatherScene::standAtVertices(const PatchMaterials& of_patches, const GatherOptions& options) {
  const CornerGroups groups = cornerGroups(mesh, options.crease);
  eyes = vertexEyes(mesh, groups, options);
  eye_of_corner = groups.of_corner;
  basis.emplace(mesh);
  const std::vector<double> weights = basis->areaWeights();
  area.assign(groups.size(), 0.0);
  materials.emission.assign(3 * groups.size(), 0.0F);
  materials.reflectance.assign(3 * groups.size(), 0.0F);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    // As differences to the first patch: what is the same all round stays it to the bit.
    const Index first = groups.patchesOf(g).front();
    Vec3 emission(0.0);
    Vec3 reflectance(0.0);
    for (std::size_t k = 0; k < groups.cornersOf(g).size(); ++k) {
      const Index patch = groups.patchesOf(g)[k];
      const double weight = weights[groups.cornersOf(g)[k]];
      area[g] += weight;
      emission += weight * (of_patches.emission[patch] - of_patches.emission[first]);
      reflectance += weight * (of_patches.reflectance[patch] - of_patches.reflectance[first]);
    }
    if (!(area[g] > 0)) continue;
    for (int b = 0; b < 3; ++b) {
      const std::size_t k = 3 * g + std::size_t(b);
      materials.emission[k] = float(of_patches.emission[first][b] + emission[b] / area[g]);
      materials.reflectance[k] = float(of_patches.reflectance[first][b] + reflectance[b] / area[g]);
    }
  }
}

double GatherScene::largestSource(std::size_t band) const {
  return std::max(materials.largest_emission[band], std::numbers::pi * sky[int(band)]);
}

std::size_t GatherScene::bytes() const {
  return rows.sharedBytes() + bytesOf(eyes) + bytesOf(area) + bytesOf(eye_of_corner) +
         bytesOf(materials.emission) + bytesOf(materials.reflectance) +
         (basis ? basis->bytes() : 0);
}

Gatherer::Gatherer(const GatherScene& scene, const std::vector<float>& radiosity)
    : scene_(scene), radiosity_(radiosity), hemicube_(scene.rows.makeHemicube()) {
  if (scene.basis) {
    view_.emplace(scene.mesh, *scene.basis, scene.rows.scene().scale, scene.resolution, scene.simd,
                  scene.eye_of_corner, radiosity);
  }
}

Gatherer::Received Gatherer::look(std::size_t k) {
  const Eye& eye = scene_.eyes[k];
  if (view_)
    view_->begin(eyeFrame(eye.position * scene_.rows.scene().scale, eye.normal, eye.angle));
  const HemicubeView& view =
      *(seen_ = &scene_.rows.lookFrom(eye.position, eye.normal, eye.angle, eye.own, hemicube_,
                                      hidden_, view_ ? &*view_ : nullptr));
  Received received{{}, view.fronts, view.backs, view.sky};
  if (view_) {
    received.irradiance = view_->irradiance();
    return received;
  }
  for (std::size_t j = 0; j < scene_.mesh.size(); ++j) {
    const double weight = view.items[j];
    if (weight == 0) continue;
    for (std::size_t b = 0; b < 3; ++b) received.irradiance[b] += weight * radiosity_[3 * j + b];
  }
  return received;
}

std::span<const double> Gatherer::backsBySurface() const {
  return view_ ? view_->backsBySurface() : seen_->items.subspan(scene_.mesh.size());
}

}  // namespace radiosity
