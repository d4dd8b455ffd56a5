// Direct light, exactly, and indirect light by rays, at any point.
#include <bit>
#include <glm/geometric.hpp>

#include "elements/indirect_light.h"
#include "elements/light_sources.h"
#include "radiosity/elements.h"

namespace radiosity {

struct LightAtPoints::Inside {
  struct Rays {
    HemisphereSet set;
    ReflectedLight light;
    Rays(const LightSources& sources, const PatchMaterials& materials, std::size_t count,
         std::uint64_t seed)
        : set(count, seed),
          light(sources.surface(), sources.rays(), set, sources.sources(), materials.lights, seed) {
    }
  };

  Inside(const PatchMesh& mesh_given, const PatchMaterials& materials,
         std::span<const double> irradiance, const ElementOptions& options_given,
         std::span<const std::uint8_t> wanted, Progress& progress)
      : mesh(mesh_given),
        bands(std::size_t(materials.bands)),
        options(options_given),
        sources(mesh, materials, irradiance, options, wanted, true, progress) {
    for (int count = kFewestRays; count <= kMostRays; count *= 2) {
      rays.push_back(std::make_unique<Rays>(sources, materials, std::size_t(count), options.seed));
    }
  }

  SurfacePoint pointAt(std::size_t root, const Vec3& at, const Vec2& place) const;

  const PatchMesh& mesh;
  std::size_t bands;
  ElementOptions options;
  LightSources sources;
  std::vector<std::unique_ptr<Rays>> rays;  ///< kFewestRays rays, twice as many, ...
};

/// At smooth edges between facets the normal is interpolated between the corners.
SurfacePoint LightAtPoints::Inside::pointAt(std::size_t root, const Vec3& at,
                                            const Vec2& place) const {
  const ElementSurface& surface = sources.surface();
  const Index patch = surface.roots.patch[root];
  SurfacePoint point{at, at, at, mesh.normal[patch], mesh.polygon[patch]};
  if (surface.curved[root] == 0) return point;
  const auto normal = [&](std::size_t corner) {
    return surface.points[surface.vertex[root][corner]].normal;
  };
  const double u = place.x;
  const double v = place.y;
  const Vec3 sum = surface.roots.cornerCount(root) == 3
                       ? (1 - u - v) * normal(0) + u * normal(1) + v * normal(2)
                       : (1 - v) * ((1 - u) * normal(0) + u * normal(1)) +
                             v * ((1 - u) * normal(3) + u * normal(2));
  if (glm::length(sum) > 0) point.normal = glm::normalize(sum);
  return point;
}

LightAtPoints::LightAtPoints(const PatchMesh& mesh, const PatchMaterials& materials,
                             std::span<const double> irradiance, const ElementOptions& options,
                             std::span<const std::uint8_t> wanted, Progress& progress) {
  options.validate();
  requireSizes(mesh, materials, irradiance, wanted);
  inside_ = std::make_unique<Inside>(mesh, materials, irradiance, options, wanted, progress);
}

LightAtPoints::~LightAtPoints() = default;

int LightAtPoints::bands() const { return int(inside_->bands); }
const ElementRoots& LightAtPoints::roots() const { return inside_->sources.surface().roots; }
const ElementReport& LightAtPoints::report() const { return inside_->sources.report(); }

double LightAtPoints::add(std::size_t root, const Vec3& at, int rays, std::span<double> direct,
                          std::span<double> indirect) const {
  const LightSources& sources = inside_->sources;
  const Vec2 place = sources.lookup().place(root, at);
  const SurfacePoint point = inside_->pointAt(root, at, place);
  double noise = 0;
  if (const EmitterLight* emitters = sources.emitterLight()) {
    const Index leaf = sources.lookup().leafAt(sources.direct(), root, place);
    const ElementLights* lights = leaf == kNone ? nullptr : sources.directLights()[leaf].get();
    if (lights == nullptr || lights->kind != ElementLights::Kind::dark) {
      noise += emitters->irradiance(point, lights, direct);
    }
  }
  const std::size_t bands = indirect.size();
  thread_local std::vector<double> gathered;
  gathered.assign(bands, 0.0);
  const auto which = std::size_t(std::countr_zero(unsigned(rays / kFewestRays)));
  const double of_rays = inside_->rays[which]->light.irradiance(point, nullptr, gathered);
  const double* patch =
      sources.indirectOfPatches().data() + sources.surface().roots.patch[root] * bands;
  for (std::size_t b = 0; b < bands; ++b) indirect[b] += of_rays < 0 ? patch[b] : gathered[b];
  return noise + std::max(0.0, of_rays);
}

}  // namespace radiosity
