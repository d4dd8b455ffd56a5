#include "page/elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/made.h"
#include "elements/direct_bands.h"
#include "page/header.h"
#include "page/lamps.h"
#include "page/surfaces.h"
#include "page/texture_pieces.h"
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

/// The lit mesh. Corners at one point of one surface's light and material are one vertex, unless
/// their texture coordinates or colours differ.
class LitElements {
 public:
  LitElements(Pipeline& pipeline, const SurfaceLight& light, double crease, LampShares& shares)
      : mesh_(pipeline.mesh().mesh),
        materials_(pipeline.materials()),
        shown_(irradianceOf(light, pipeline.solution())),
        corners_(cornerValues(mesh_, shown_.patches, 3, crease)),
        lit_(mesh_, shown_.patches, corners_, &shown_),
        pieces_(pipeline.scene(), mesh_),
        shares_(shares) {
    std::vector<LitCorner> triples;
    for (Index i = 0; i < mesh_.size(); ++i) {
      triples.clear();
      lit_.append(i, triples);
      const bool varies = pieces_.enter(i);
      for (std::size_t t = 0; t < triples.size(); t += 3) {
        const Corners corners = {triples[t], triples[t + 1], triples[t + 2]};
        if (varies) {
          addPieces(i, corners);
        } else {
          for (const LitCorner& corner : corners) addCorner(i, corner, {});
        }
      }
    }
  }

  std::size_t count() const { return triangles_.size() / 3; }

  void addTo(const Vec3& origin, Container& container) const {
    container.add("element_position", packed(positions_, origin));
    container.add("element_triangle", triangles_);
    container.add("element_irradiance", irradiance_);
    container.add("element_patch", patches_);
    if (!pieces_.anyVaries()) return;
    container.add("element_texture_place", places_);
    if (pieces_.anyColours()) container.add("element_colour", colours_);
  }

 private:
  using Corners = std::array<LitCorner, 3>;

  void addPieces(Index patch, const Corners& corners) {
    const std::array<Vec3, 3> at = {lit_.position(corners[0].point),
                                    lit_.position(corners[1].point),
                                    lit_.position(corners[2].point)};
    pieces_.cut(at, [&](const Piece& piece) {
      for (const PieceCorner& corner : piece) {
        const Vec3& w = corner.weights;
        const auto* whole = std::ranges::find(kCorners, w);
        if (whole != kCorners.end()) {
          addCorner(patch, corners[std::size_t(whole - kCorners.begin())], corner);
          continue;
        }
        const Vec3 light =
            w.x * corners[0].radiosity + w.y * corners[1].radiosity + w.z * corners[2].radiosity;
        const auto vertex = vertices_.add({float(light.x), float(light.y), float(light.z)});
        triangles_.push_back(vertex);
        describeLast(patch, w.x * at[0] + w.y * at[1] + w.z * at[2], corner);
      }
    });
  }

  void addCorner(Index patch, const LitCorner& corner, const PieceCorner& there) {
    const auto may_be = [&](Index vertex) {
      return alike(mesh_, materials_, patches_[vertex], patch) && hasPlace(vertex, there);
    };
    const auto [vertex, is_new] = vertices_.of(corner, may_be);
    triangles_.push_back(vertex);
    if (is_new) describeLast(patch, lit_.position(corner.point), there);
  }

  bool hasPlace(Index vertex, const PieceCorner& there) const {
    if (!pieces_.anyVaries()) return true;
    const auto same = [](float is, double other) { return is == float(other); };
    return same(places_[2 * vertex], there.uv.x) && same(places_[2 * vertex + 1], there.uv.y) &&
           (!pieces_.anyColours() || (colours_[3 * vertex] == codeOf(there.colour.x) &&
                                      colours_[3 * vertex + 1] == codeOf(there.colour.y) &&
                                      colours_[3 * vertex + 2] == codeOf(there.colour.z)));
  }

  /// What the vertex that was added last has beside its light.
  void describeLast(Index patch, const Vec3& position, const PieceCorner& there) {
    const LitVertices::Triple& value = vertices_.radiosity().back();
    patches_.push_back(patch);
    positions_.push_back(position);
    irradiance_.insert(irradiance_.end(), value.begin(), value.end());
    shares_.addVertex(patch, position, value);
    if (!pieces_.anyVaries()) return;
    places_.insert(places_.end(), {float(there.uv.x), float(there.uv.y)});
    if (!pieces_.anyColours()) return;
    const Vec3& c = there.colour;
    colours_.insert(colours_.end(), {codeOf(c.x), codeOf(c.y), codeOf(c.z)});
  }

  static std::uint16_t codeOf(double colour) { return std::uint16_t(std::lround(65535 * colour)); }
  static constexpr std::array<Vec3, 3> kCorners = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

  const PatchMesh& mesh_;
  const PatchMaterials& materials_;
  SurfaceLight shown_;
  std::vector<double> corners_;
  LitTriangles lit_;
  TexturePieces pieces_;
  LampShares& shares_;
  LitVertices vertices_;
  std::vector<Vec3> positions_;
  std::vector<float> irradiance_;  ///< three a vertex, W/m^2
  std::vector<Index> patches_;
  std::vector<float> places_;           ///< two a vertex, texture coordinates
  std::vector<std::uint16_t> colours_;  ///< three a vertex, of 65535
  std::vector<Index> triangles_;
};

}  // namespace

std::size_t addElements(Pipeline& pipeline, const SurfaceLight& light, double crease,
                        const Vec3& origin, Progress& progress, Container& container) {
  LampShares shares(pipeline, light.elements.get(), progress);
  if (!light.elements) {
    shares.addTo(container);
    container.add("element_position", std::vector<float>());
    container.add("element_triangle", std::vector<std::uint32_t>());
    container.add("element_irradiance", std::vector<float>());
    container.add("element_patch", std::vector<std::uint32_t>());
    return 0;
  }
  const LitElements lit(pipeline, light, crease, shares);
  shares.addTo(container);
  lit.addTo(origin, container);
  return lit.count();
}

}  // namespace radiosity::page
