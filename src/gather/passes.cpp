#include "gather/passes.h"

#include <algorithm>

#include "base/steady_mean.h"
#include "formfactor/light_on_patches.h"

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
                         const GatherOptions& options, Progress& progress)
    : mesh(patch_mesh),
      bands(std::size_t(of_patches.bands)),
      at(options.at),
      resolution(options.resolution),
      simd(options.simd),
      rows(patch_mesh, eyeOptions(options)),
      lights(of_patches.lights) {
  if (at == GatherAt::patches) {
    standAtPatches(of_patches, options);
  } else {
    standAtVertices(of_patches, options);
  }
  findSources(progress);
}

void GatherScene::findSources(Progress& progress) {
  std::vector<LightOnPatches::Place> places;
  places.reserve(eyes.size());
  for (const Eye& eye : eyes) places.push_back({eye.position, eye.normal, eye.own});
  aimed = LightOnPatches(mesh).aimedAt(lights, places, int(bands), progress);
  source = materials.emission;
  largest_source.assign(bands, 0.0);
  for (std::size_t k = 0; k < source.size(); ++k) {
    source[k] = float(double(source[k]) + double(materials.reflectance[k]) * aimed[k]);
    double& largest = largest_source[k % bands];
    largest = std::max({largest, double(materials.emission[k]), byLights(k / bands, k % bands, 1)});
  }
}

double GatherScene::byLights(std::size_t eye, std::size_t band, double open) const {
  double irradiance = aimed[eye * bands + band];
  for (const Light& light : lights) irradiance += light.fromAround(band, open);
  return irradiance;
}

void GatherScene::standAtPatches(const PatchMaterials& of_patches, const GatherOptions& options) {
  eyes = patchEyes(mesh, options);
  area = mesh.area;
  materials.emission.assign(of_patches.emission.begin(), of_patches.emission.end());
  materials.reflectance.assign(of_patches.reflectance.begin(), of_patches.reflectance.end());
}

void GatherScene::standAtVertices(const PatchMaterials& of_patches, const GatherOptions& options) {
  const CornerGroups groups = cornerGroups(mesh, options.crease);
  eyes = vertexEyes(mesh, groups, options);
  eye_of_corner = groups.of_corner;
  basis.emplace(mesh);
  const std::vector<double> weights = basis->areaWeights();
  area.assign(groups.size(), 0.0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const std::size_t corner : groups.cornersOf(g)) area[g] += weights[corner];
  }
  const auto meanOf = [&](const std::vector<double>& values, std::size_t g, std::size_t band) {
    SteadyMean mean;
    for (std::size_t k = 0; k < groups.cornersOf(g).size(); ++k) {
      mean.add(weights[groups.cornersOf(g)[k]], values[bands * groups.patchesOf(g)[k] + band]);
    }
    return float(mean.value());
  };
  materials.emission.assign(bands * groups.size(), 0.0F);
  materials.reflectance.assign(bands * groups.size(), 0.0F);
  for (std::size_t k = 0; k < materials.emission.size(); ++k) {
    const std::size_t g = k / bands;
    if (!(area[g] > 0)) continue;
    materials.emission[k] = meanOf(of_patches.emission, g, k % bands);
    materials.reflectance[k] = meanOf(of_patches.reflectance, g, k % bands);
  }
}

bool GatherScene::isLit() const {
  return std::ranges::any_of(largest_source, [](double largest) { return largest > 0; });
}

std::size_t GatherScene::bytes() const {
  return rows.sharedBytes() + bytesOf(eyes) + bytesOf(area) + bytesOf(eye_of_corner) +
         bytesOf(materials.emission) + bytesOf(materials.reflectance) +
         (basis ? basis->bytes() : 0);
}

Gatherer::Gatherer(const GatherScene& scene, const std::vector<float>& radiosity)
    : scene_(scene),
      radiosity_(radiosity),
      hemicube_(scene.rows.makeHemicube()),
      irradiance_(scene.bands, 0.0) {
  if (scene.basis) {
    view_.emplace(scene.mesh, *scene.basis, scene.rows.scene().scale, scene.resolution, scene.simd,
                  scene.eye_of_corner, radiosity, scene.bands);
  }
}

Gatherer::Received Gatherer::look(std::size_t k) {
  const Eye& eye = scene_.eyes[k];
  if (view_)
    view_->begin(eyeFrame(eye.position * scene_.rows.scene().scale, eye.normal, eye.angle));
  const HemicubeView& view =
      *(seen_ = &scene_.rows.lookFrom(eye.position, eye.normal, eye.angle, eye.own, hemicube_,
                                      hidden_, view_ ? &*view_ : nullptr));
  const Received received{irradiance_, view.fronts, view.backs, view.sky};
  if (view_) {
    view_->irradiance(irradiance_);
    return received;
  }
  std::fill(irradiance_.begin(), irradiance_.end(), 0.0);
  const std::size_t bands = scene_.bands;
  for (std::size_t j = 0; j < scene_.mesh.size(); ++j) {
    const double weight = view.items[j];
    if (weight == 0) continue;
    for (std::size_t b = 0; b < bands; ++b) irradiance_[b] += weight * radiosity_[bands * j + b];
  }
  return received;
}

std::span<const double> Gatherer::backsBySurface() const {
  return view_ ? view_->backsBySurface() : seen_->items.subspan(scene_.mesh.size());
}

}  // namespace radiosity
