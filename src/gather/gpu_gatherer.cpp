#include "gather/gpu_gatherer.h"

#include <tbb/enumerable_thread_specific.h>

#include <numbers>

#include "base/parallel.h"
#include "formfactor/hemicube/gpu_rows.h"

namespace radiosity {
namespace {

/// Adds the facets of all patches, and the means of corners that they refer to.
void addFacets(const GatherScene& scene, GpuField& field) {
  const PatchMesh& mesh = scene.mesh;
  for (const Vec3& vertex : mesh.vertices) {
    field.vertices.push_back(vertex * scene.rows.scene().scale);
  }
  field.first_facet.push_back(0);
  field.first_of_mean.push_back(0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    bool has_inside = false;
    const auto mean = Index(field.eyes + field.first_of_mean.size() - 1);
    for (const BasisFacet& facet : scene.basis->facets(i)) {
      GpuFacet& made = field.facets.emplace_back();
      made.area = facet.area;
      made.count = std::uint32_t(facet.count);
      for (std::size_t k = 0; k < made.count; ++k) {
        const bool inside = facet.corner[k] == BasisFacet::kInside;
        made.vertex[k] = facet.vertex[k];
        made.source[k] = inside ? mean : scene.eye_of_corner[facet.corner[k]];
        has_inside = has_inside || inside;
      }
    }
    field.first_facet.push_back(std::uint32_t(field.facets.size()));
    if (!has_inside) continue;
    for (std::size_t c = mesh.corner_offset[i]; c < mesh.corner_offset[i + 1]; ++c) {
      field.mean_of.push_back(scene.eye_of_corner[c]);
    }
    field.first_of_mean.push_back(std::uint32_t(field.mean_of.size()));
  }
}

GpuField fieldOf(const GatherScene& scene) {
  GpuField field;
  field.bands = scene.bands;
  field.eyes = scene.size();
  field.patches = scene.mesh.size();
  field.emission = scene.source;
  field.reflectance = scene.materials.reflectance;
  field.sky = background(scene.lights, int(scene.bands));
  field.sky.resize(scene.bands, 0.0);  // no light: dark
  for (double& radiance : field.sky) radiance *= std::numbers::pi;
  if (scene.basis) addFacets(scene, field);
  return field;
}

}  // namespace

GpuGatherer::GpuGatherer(const GatherScene& scene, std::unique_ptr<GpuEye> eye)
    : scene_(scene), eye_(std::move(eye)), problem_(eye_->prepare(fieldOf(scene))) {
  for (std::size_t k = 0; k < scene.size(); ++k) {
    if (scene.eyes[k].looks) looking_.push_back(Index(k));
  }
}

std::string GpuGatherer::pass(const std::function<void(std::size_t, const Seen&)>& take,
                              Progress& progress) {
  if (!problem_.empty()) return problem_;
  const std::size_t patches = scene_.mesh.size();
  const auto resolution = std::size_t(scene_.resolution);
  std::vector<std::uint8_t> hidden;
  tbb::enumerable_thread_specific<GpuRowReader> readers;
  return eye_->gather(
      looking_.size(),
      [&](std::size_t k, GpuView& view, std::span<std::uint32_t> words) {
        const Eye& eye = scene_.eyes[looking_[k]];
        const PlacedEye placed =
            scene_.rows.place(eye.position, eye.normal, eye.angle, eye.own, hidden);
        describeEye(placed, hidden, view, words);
        view.source = looking_[k];
      },
      [&](const GpuRows& rows) {
        parallelFor(rows.count, 1, [&](std::size_t k) {
          const HemicubeView& view = readers.local().read(rows, k, patches);
          take(looking_[rows.first + k], {{rows.irradiance.subspan(k * scene_.bands, scene_.bands),
                                           view.fronts, view.backs, view.sky},
                                          view.items.subspan(patches)});
        });
        counts_.hemicubes += rows.count;
        counts_.pixels += rows.count * 3 * resolution * resolution;
        progress.advance(rows.count);
        return !progress.cancelled();
      });
}

}  // namespace radiosity
