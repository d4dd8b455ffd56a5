#include "page/elements.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/made.h"
#include "elements/direct_bands.h"
#include "page/header.h"
#include "page/lamps.h"
#include "page/surfaces.h"
#include "results/lit_triangles.h"
#include "results/lit_vertices.h"

namespace radiosity::page {

namespace {

/// What a slider changes: the emission of a material, or a light without a surface.
struct ElementLamp {
  Index material = kNone;
  Index light = kNone;  ///< of PatchMaterials::lights
  Index number = 0;     ///< of the header's lights
};

std::vector<ElementLamp> lampsOf(const Scene& scene, const PatchMesh& mesh,
                                 const PatchMaterials& materials) {
  std::vector<ElementLamp> lamps;
  for (const Emitter& emitter : emittersOf(scene, mesh, materials)) {
    lamps.push_back({.material = Index(emitter.material)});
  }
  Index number = 0;
  for (Index l = 0; l < materials.lights.size(); ++l) {
    if (!materials.lights[l].shines()) continue;
    const std::vector<Light> direct = aimedLights({&materials.lights[l], 1});
    if (!direct.empty() && direct[0].strength == materials.lights[l].strength) {
      lamps.push_back({.light = l, .number = number});
    }
    ++number;
  }
  lamps.resize(std::min(lamps.size(), kMostElementLamps));
  return lamps;
}

/// What emits, with bands of its own for each lamp. Without reflectances: direct light has none.
PatchMaterials bandsOfLamps(const Scene& scene, const PatchMesh& mesh,
                            const PatchMaterials& materials, std::span<const ElementLamp> lamps) {
  const auto own = std::size_t(materials.bands);
  const std::size_t all = own * lamps.size();
  PatchMaterials split;
  split.bands = int(all);
  split.emission.resize(mesh.size() * all);
  split.lights = materials.lights;
  for (Light& light : split.lights) light.strength.assign(all, 0.0);
  for (std::size_t k = 0; k < lamps.size(); ++k) {
    if (lamps[k].light != kNone) {
      std::ranges::copy(materials.lights[lamps[k].light].strength,
                        split.lights[lamps[k].light].strength.begin() + std::ptrdiff_t(k * own));
      continue;
    }
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (scene.surfaces[mesh.surface[i]].material != lamps[k].material) continue;
      for (std::size_t b = 0; b < own; ++b) {
        split.emission[i * all + k * own + b] = materials.emission[i * own + b];
      }
    }
  }
  return split;
}

/// Whether two patches turn irradiance into the same radiosity, whatever a viewer changes.
bool alike(const PatchMesh& mesh, const PatchMaterials& materials, Index a, Index b) {
  if (a == b) return true;
  if (mesh.surface[a] != mesh.surface[b]) return false;
  const auto bands = std::size_t(materials.bands);
  const auto same = [&](const std::vector<double>& values) {
    return std::equal(values.begin() + std::ptrdiff_t(a * bands),
                      values.begin() + std::ptrdiff_t((a + 1) * bands),
                      values.begin() + std::ptrdiff_t(b * bands));
  };
  return same(materials.emission) && same(materials.reflectance);
}

/// Irradiance in place of radiosity.
SurfaceLight irradianceOf(const SurfaceLight& light, const Solution& solution) {
  SurfaceLight shown;
  shown.elements = light.elements;
  shown.patches = rgbOf(solution.irradiance, solution.bands);
  shown.emission.assign(light.emission.size(), 0.0);
  shown.reflectance.assign(light.reflectance.size(), 1.0);
  return shown;
}

/// What each lamp gives directly to vertices: its share of their irradiance.
class LampShares {
 public:
  /// `elements`: none: there are no lamps.
  LampShares(Pipeline& pipeline, const Elements* elements, Progress& progress)
      : bands_(std::size_t(pipeline.materials().bands)) {
    if (elements == nullptr) return;
    const PatchMesh& mesh = pipeline.mesh().mesh;
    const PatchMaterials& materials = pipeline.materials();
    lamps_ = lampsOf(pipeline.scene(), mesh, materials);
    if (lamps_.empty()) return;
    field_ = directBands(mesh, bandsOfLamps(pipeline.scene(), mesh, materials, lamps_),
                         pipeline.options().elements, elements->direct, progress);
    if (field_.elements.empty()) lamps_.clear();
    lookup_.emplace(mesh, elements->roots);
    shares_.resize(lamps_.size());
  }

  void addVertex(Index patch, const Vec3& position, const LitVertices::Triple& irradiance) {
    if (lamps_.empty()) return;
    direct_.assign(lamps_.size() * bands_, 0.0);
    const ElementLookup& lookup = made(lookup_);
    const std::size_t root = lookup.rootAt(patch, position);
    lookup.add(field_, root, lookup.place(root, position), direct_);
    for (double& value : direct_) value = std::max(0.0, value);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t band = bands_ == 1 ? 0 : c;
      double sum = 0;
      for (std::size_t k = 0; k < lamps_.size(); ++k) sum += direct_[k * bands_ + band];
      const double whole = std::max(double(irradiance[c]), sum);
      for (std::size_t k = 0; k < lamps_.size(); ++k) {
        const double code = whole > 0 ? kWhole * direct_[k * bands_ + band] / whole : 0.0;
        shares_[k].push_back(std::uint16_t(std::floor(code)));
      }
    }
  }

  void addTo(Container& container) const {
    Container::Json described = Container::Json::array();
    for (std::size_t k = 0; k < lamps_.size(); ++k) {
      const bool is_light = lamps_[k].light != kNone;
      described.push_back(
          {{is_light ? "light" : "material", is_light ? lamps_[k].number : lamps_[k].material}});
      container.add("element_share_" + std::to_string(k), shares_[k]);
    }
    container.header()["element_lamps"] = described;
  }

 private:
  static constexpr double kWhole = 65535;

  std::size_t bands_;
  std::vector<ElementLamp> lamps_;
  ElementField field_;
  std::optional<ElementLookup> lookup_;
  std::vector<double> direct_;                      ///< at a vertex, the bands of each lamp
  std::vector<std::vector<std::uint16_t>> shares_;  ///< of each lamp, three a vertex
};

/// The lit mesh. Corners at one point of one surface's light and material are one vertex.
struct LitElements {
  std::vector<Vec3> positions;
  std::vector<float> irradiance;  ///< three a vertex, W/m^2
  std::vector<Index> patches;
  std::vector<Index> triangles;
};

LitElements litElements(Pipeline& pipeline, const SurfaceLight& light, double crease,
                        LampShares& shares) {
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const SurfaceLight shown = irradianceOf(light, pipeline.solution());
  const std::vector<double> corners = cornerValues(mesh, shown.patches, 3, crease);
  LitTriangles lit(mesh, shown.patches, corners, &shown);
  LitVertices vertices;
  LitElements found;
  std::vector<LitCorner> triple;
  for (Index i = 0; i < mesh.size(); ++i) {
    triple.clear();
    lit.append(i, triple);
    const auto may_be = [&](Index vertex) {
      return alike(mesh, pipeline.materials(), found.patches[vertex], i);
    };
    for (const LitCorner& corner : triple) {
      const auto [vertex, is_new] = vertices.of(corner, may_be);
      found.triangles.push_back(vertex);
      if (!is_new) continue;
      const LitVertices::Triple& value = vertices.radiosity().back();
      found.patches.push_back(i);
      found.positions.push_back(lit.position(corner.point));
      found.irradiance.insert(found.irradiance.end(), value.begin(), value.end());
      shares.addVertex(i, found.positions.back(), value);
    }
  }
  return found;
}

}  // namespace

std::size_t addElements(Pipeline& pipeline, const SurfaceLight& light, double crease,
                        const Vec3& origin, Progress& progress, Container& container) {
  LampShares shares(pipeline, light.elements.get(), progress);
  LitElements lit;
  if (light.elements) lit = litElements(pipeline, light, crease, shares);
  shares.addTo(container);
  container.add("element_position", packed(lit.positions, origin));
  container.add("element_triangle", lit.triangles);
  container.add("element_irradiance", lit.irradiance);
  container.add("element_patch", lit.patches);
  return lit.triangles.size() / 3;
}

}  // namespace radiosity::page
