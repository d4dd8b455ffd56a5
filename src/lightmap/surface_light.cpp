#include "lightmap/surface_light.h"

#include <array>
#include <cmath>
#include <optional>
#include <tuple>

namespace radiosity {
namespace {

/// The cosine of 15 degrees, the tolerance for faces that are not planar: the mesh may cut them
/// into triangles along another diagonal.
constexpr double kSameFace = 0.966;

}  // namespace

LightOnSurfaces::LightOnSurfaces(const PatchMesh& mesh, const SurfaceLight& light,
                                 LightmapShows shows)
    : mesh_(mesh), light_(light), shows_(shows), lookup_(mesh, light.elements->roots) {
  const Elements& elements = *light.elements;
  std::map<std::pair<Index, int>, std::pair<std::vector<std::array<Index, 3>>, std::vector<Index>>>
      found;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const std::size_t root = elements.roots.of_patch[i];
    // Either all roots of a patch were evaluated or none.
    if (root == elements.roots.of_patch[i + 1] || elements.indirect.elements[root].corners == 0)
      continue;
    auto& [triangles, patches] = found[{mesh.surface[i], int(mesh.side[i])}];
    for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
      triangles.push_back(mesh.pieces[t]);
      patches.push_back(Index(i));
    }
  }
  for (auto& [of_side, pieces] : found) {
    patches_.emplace(
        std::piecewise_construct, std::forward_as_tuple(of_side),
        std::forward_as_tuple(mesh, std::move(pieces.first), std::move(pieces.second)));
  }
}

const LightOnSurfaces::Patches* LightOnSurfaces::of(Index surface, int side) const {
  const auto found = patches_.find({surface, side});
  return found == patches_.end() ? nullptr : &found->second;
}

Vec3 LightOnSurfaces::valueAt(Index patch, const Vec3& point) const {
  const Elements& elements = *light_.elements;
  const auto bands = std::size_t(elements.bands);
  const std::size_t root = lookup_.rootAt(patch, point);
  const Vec2 place = lookup_.place(root, point);
  std::array<double, 3> sum{};
  const std::span<double> of_bands(sum.data(), bands);
  lookup_.add(elements.direct, root, place, of_bands);
  lookup_.add(elements.indirect, root, place, of_bands);
  if (shows_ == LightmapShows::radiosity) {
    for (std::size_t b = 0; b < bands; ++b) {
      const std::size_t k = patch * bands + b;
      sum[b] = light_.emission[k] + light_.reflectance[k] * sum[b];
    }
  }
  return bands == 1 ? Vec3(sum[0]) : Vec3(sum[0], sum[1], sum[2]);
}

bool LightOnSurfaces::at(Index surface, int side, const Vec3& point, const Vec3& normal,
                         Vec3& value) const {
  value = Vec3(0.0);
  const Patches* patches = of(surface, side);
  if (patches == nullptr) return false;
  std::optional<NearestPoint> nearest = patches->index.nearest(point, normal, HUGE_VAL, kSameFace);
  if (!nearest) nearest = patches->index.nearest(point, normal, HUGE_VAL);
  if (!nearest) return false;
  const auto& corner = patches->triangles[nearest->triangle];
  const Vec3 on = nearest->weights.x * mesh_.vertices[corner[0]] +
                  nearest->weights.y * mesh_.vertices[corner[1]] +
                  nearest->weights.z * mesh_.vertices[corner[2]];
  value = valueAt(patches->patch[nearest->triangle], on);
  return true;
}

bool LightOnSurfaces::isNear(Index surface, int side, const Vec3& point, const Vec3& normal,
                             double reach) const {
  const Patches* patches = of(surface, side);
  return patches != nullptr && patches->index.nearest(point, normal, reach, kSameFace).has_value();
}

}  // namespace radiosity
