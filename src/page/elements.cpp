#include "page/elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "elements/direct_bands.h"
#include "page/header.h"
#include "page/lamps.h"
#include "page/surfaces.h"
#include "results/lit_triangles.h"

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

/// The vertices of the triangles: corners at one point of one surface's light and material are one.
class ElementVertices {
 public:
  explicit ElementVertices(const PatchMesh& mesh, const PatchMaterials& materials)
      : mesh_(mesh), materials_(materials) {}

  /// The corner's vertex, and whether it is new: then it is the last.
  std::pair<std::uint32_t, bool> of(const LitCorner& corner, Index patch) {
    const Vec3& h = corner.radiosity;
    const std::array<float, 3> value = {float(h.x), float(h.y), float(h.z)};
    std::vector<std::uint32_t>& known = at_point_[corner.point];
    for (const std::uint32_t v : known) {
      if (irradiance[v] == value && alike(patch_of[v], patch)) return {v, false};
    }
    const auto added = std::uint32_t(patch_of.size());
    known.push_back(added);
    patch_of.push_back(patch);
    irradiance.push_back(value);
    return {added, true};
  }

  std::vector<std::uint32_t> patch_of;
  std::vector<std::array<float, 3>> irradiance;  ///< W/m^2

 private:
  /// Whether both patches turn irradiance into the same radiosity, whatever a viewer changes.
  bool alike(Index a, Index b) const {
    if (a == b) return true;
    if (mesh_.surface[a] != mesh_.surface[b]) return false;
    const auto bands = std::size_t(materials_.bands);
    const auto same = [&](const std::vector<double>& values) {
      return std::equal(values.begin() + std::ptrdiff_t(a * bands),
                        values.begin() + std::ptrdiff_t((a + 1) * bands),
                        values.begin() + std::ptrdiff_t(b * bands));
    };
    return same(materials_.emission) && same(materials_.reflectance);
  }

  const PatchMesh& mesh_;
  const PatchMaterials& materials_;
  std::map<Index, std::vector<std::uint32_t>> at_point_;
};

/// Irradiance in place of radiosity.
SurfaceLight irradianceOf(const SurfaceLight& light, const Solution& solution) {
  SurfaceLight shown;
  shown.elements = light.elements;
  shown.patches = rgbOf(solution.irradiance, solution.bands);
  shown.emission.assign(light.emission.size(), 0.0);
  shown.reflectance.assign(light.reflectance.size(), 1.0);
  return shown;
}

constexpr double kWhole = 65535;

/// The shares of lamps in a vertex's irradiance, `lamps` times three, in 16 bits.
std::vector<std::uint16_t> sharesOf(std::span<const double> direct, std::size_t lamps, int bands,
                                    const std::array<float, 3>& irradiance) {
  std::vector<std::uint16_t> codes(3 * lamps);
  for (std::size_t b = 0; b < 3; ++b) {
    const auto at = [&](std::size_t k) {
      return std::max(0.0, direct[k * std::size_t(bands) + (bands == 1 ? 0 : b)]);
    };
    double whole = irradiance[b];
    double sum = 0;
    for (std::size_t k = 0; k < lamps; ++k) sum += at(k);
    whole = std::max(whole, sum);
    if (!(whole > 0)) continue;
    for (std::size_t k = 0; k < lamps; ++k) {
      codes[3 * k + b] = std::uint16_t(std::floor(kWhole * at(k) / whole));
    }
  }
  return codes;
}

}  // namespace

std::size_t addElements(Pipeline& pipeline, const SurfaceLight& light, double crease,
                        const Vec3& origin, Progress& progress, Container& container) {
  const PatchMesh& mesh = pipeline.mesh().mesh;
  const PatchMaterials& materials = pipeline.materials();
  std::vector<Vec3> positions;
  std::vector<float> irradiance;
  std::vector<std::uint32_t> triangles;
  ElementVertices vertices(mesh, materials);
  std::vector<ElementLamp> lamps;
  std::vector<std::vector<std::uint16_t>> shares;
  if (light.elements) {
    const Elements& elements = *light.elements;
    lamps = lampsOf(pipeline.scene(), mesh, materials);
    ElementField field;
    if (!lamps.empty()) {
      field = directBands(mesh, bandsOfLamps(pipeline.scene(), mesh, materials, lamps),
                          pipeline.options().elements, elements.direct, progress);
    }
    if (field.elements.empty()) lamps.clear();
    shares.resize(lamps.size());
    const ElementLookup lookup(mesh, elements.roots);
    const SurfaceLight shown = irradianceOf(light, pipeline.solution());
    const std::vector<double> corners = cornerValues(mesh, shown.patches, 3, crease);
    LitTriangles lit(mesh, shown.patches, corners, &shown);
    std::vector<LitCorner> triple;
    std::vector<double> direct(lamps.size() * std::size_t(materials.bands));
    for (Index i = 0; i < mesh.size(); ++i) {
      triple.clear();
      lit.append(i, triple);
      for (const LitCorner& corner : triple) {
        const auto [vertex, is_new] = vertices.of(corner, i);
        triangles.push_back(vertex);
        if (!is_new) continue;
        positions.push_back(lit.position(corner.point));
        std::ranges::fill(direct, 0.0);
        if (!lamps.empty()) {
          const std::size_t root = lookup.rootAt(i, positions.back());
          lookup.add(field, root, lookup.place(root, positions.back()), direct);
        }
        const auto codes =
            sharesOf(direct, lamps.size(), materials.bands, vertices.irradiance.back());
        for (std::size_t k = 0; k < lamps.size(); ++k) {
          shares[k].insert(shares[k].end(), codes.begin() + std::ptrdiff_t(3 * k),
                           codes.begin() + std::ptrdiff_t(3 * k + 3));
        }
      }
    }
    for (const auto& value : vertices.irradiance) {
      irradiance.insert(irradiance.end(), value.begin(), value.end());
    }
  }
  Container::Json described = Container::Json::array();
  for (std::size_t k = 0; k < lamps.size(); ++k) {
    const bool is_light = lamps[k].light != kNone;
    described.push_back(
        {{is_light ? "light" : "material", is_light ? lamps[k].number : lamps[k].material}});
    container.add("element_share_" + std::to_string(k), shares[k]);
  }
  container.header()["element_lamps"] = described;
  container.add("element_position", packed(positions, origin));
  container.add("element_triangle", triangles);
  container.add("element_irradiance", irradiance);
  container.add("element_patch", vertices.patch_of);
  return triangles.size() / 3;
}

}  // namespace radiosity::page
