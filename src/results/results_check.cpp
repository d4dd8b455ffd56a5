#include "results/results_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <string_view>

#include "base/made.h"
#include "elements/element_parts.h"
#include "elements/element_roots.h"

namespace radiosity {

namespace {

class Checker {
 public:
  explicit Checker(const std::string& path) : path_(path) {}
  void require(bool good, std::string_view object, std::string_view what) const {
    if (!good) fail(object, what);
  }
  [[noreturn]] void fail(std::string_view object, std::string_view what) const {
    throw InputError(fmt::format("{}: {} {}; make the file again with the command that wrote it",
                                 path_, object, what));
  }
  /// Checks that `offset` cuts [0, count) into `parts` ranges.
  void offsets(const std::vector<std::size_t>& offset, std::size_t parts, std::size_t count,
               std::string_view object) const {
    require(offset.size() == parts + 1 && offset.front() == 0 && offset.back() == count &&
                std::is_sorted(offset.begin(), offset.end()),
            object, fmt::format("does not divide {} values into {} parts", count, parts));
  }
  /// The same with parts of `least` values or more.
  void offsets(const std::vector<std::size_t>& offset, std::size_t parts, std::size_t count,
               std::size_t least, std::string_view object) const {
    offsets(offset, parts, count, object);
    for (std::size_t k = 0; k < parts; ++k) {
      if (offset[k + 1] - offset[k] >= least) continue;
      fail(object, fmt::format("gives {} less than {} values", k, least));
    }
  }
  void indices(std::span<const Index> index, std::size_t limit, bool none_allowed,
               std::string_view object) const {
    for (std::size_t k = 0; k < index.size(); ++k) {
      if (index[k] < limit || (none_allowed && index[k] == kNone)) continue;
      fail(object, fmt::format("points beyond the {} elements there are, at {}", limit, k));
    }
  }
  /// Checks that every value is within `least` and `most`.
  template <class Values>
  void within(const Values& values, double least, double most, std::string_view object) const {
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto value = double(values[k]);
      if (!(value >= least && value <= most)) fail(object, fmt::format("holds {} at {}", value, k));
    }
  }
  /// Checks that vectors are of length 1, or 0 where `may_vanish(k)`.
  template <class MayVanish>
  void unit(const std::vector<Vec3>& normals, const MayVanish& may_vanish,
            std::string_view object) const {
    constexpr double kRounding = 1e-6;  // of programs that keep normals in single precision
    for (std::size_t k = 0; k < normals.size(); ++k) {
      const double length = glm::length(normals[k]);
      if (std::abs(length - 1) <= kRounding || (length == 0 && may_vanish(k))) continue;
      fail(object, fmt::format("holds a normal of length {} at {}", length, k));
    }
  }
  template <class T>
  void length(const std::vector<T>& values, std::size_t count, std::string_view object) const {
    require(values.size() == count, object,
            fmt::format("has {} values, not {}", values.size(), count));
  }

 private:
  const std::string& path_;
};

void checkScene(const Checker& check, const Scene& s) {
  check.offsets(s.face_offset, s.faceCount(), s.corners.size(), 3, "/scene/face_offset");
  check.indices(s.corners, s.vertices.size(), false, "/scene/corners");
  if (!s.texcoords.empty()) check.length(s.texcoords, s.corners.size(), "/scene/texcoords");
  if (!s.colours.empty()) check.length(s.colours, s.corners.size(), "/scene/colours");
  check.indices(s.face_surface, s.surfaces.size(), false, "/scene/face_surface");
  check.length(s.face_element, s.faceCount(), "/scene/face_element");
  for (const Surface& surface : s.surfaces) {
    check.indices({{surface.material}}, s.materials.size(), false, "/scene/surfaces/material");
  }
  for (const Material& material : s.materials) {
    check.indices({{material.texture}}, s.textures.size(), true, "/scene/materials/texture");
    check.indices({{material.emission_texture}}, s.textures.size(), true,
                  "/scene/materials/emission_texture");
  }
  for (std::size_t k = 0; k < s.textures.size(); ++k) {
    const Texture& t = s.textures[k];
    const std::string object = fmt::format("/scene/texels/{}", k);
    check.require(t.width > 0 && t.height > 0 &&
                      t.texels.size() == 3 * std::size_t(t.width) * std::size_t(t.height),
                  object, "is not width x height texels");
    check.within(t.texels, 0, HUGE_VAL, object);
  }
  for (const Camera& camera : s.cameras) {
    check.require(camera.vertical_fov > 0 && camera.vertical_fov < std::numbers::pi,
                  "/scene/cameras/vertical_fov", "is not within 0 and pi");
    check.require(camera.aspect >= 0, "/scene/cameras/aspect", "is below 0");
  }
  try {
    validate(s);
  } catch (const InputError& error) {
    check.fail("/scene", fmt::format("cannot be used: {}", error.what()));
  }
}

void checkPolygons(const Checker& check, const PatchMesh& m) {
  const PlanarPolygons& p = m.polygons;
  const std::size_t loops = p.corner_offset.empty() ? 0 : p.corner_offset.size() - 1;
  // A mesh made without polygons has empty offsets.
  if (p.size() == 0 && p.loop_offset.empty() && p.corner_offset.empty()) return;
  check.offsets(p.loop_offset, p.size(), loops, 1, "/mesh/polygons/loop_offset");
  check.offsets(p.corner_offset, loops, p.corners.size(), 3, "/mesh/polygons/corner_offset");
  check.indices(p.corners, m.vertices.size(), false, "/mesh/polygons/corners");
  check.unit(
      p.normal, [](std::size_t) { return false; }, "/mesh/polygons/normal");
  check.length(p.origin, p.size(), "/mesh/polygons/origin");
  check.length(p.surface, p.size(), "/mesh/polygons/surface");
  check.indices(p.surface, m.surface_names.size(), false, "/mesh/polygons/surface");
  check.length(p.index_in_surface, p.size(), "/mesh/polygons/index_in_surface");
  check.indices(p.index_in_surface, p.size(), false, "/mesh/polygons/index_in_surface");
  check.length(p.back_is_patch, p.size(), "/mesh/polygons/back_is_patch");
  check.within(p.back_is_patch, 0, 1, "/mesh/polygons/back_is_patch");
}

/// Checks that fronts come before backs, and that every back has its front: of the same polygon,
/// and with as many corners.
void checkSides(const Checker& check, const PatchMesh& m) {
  check.within(m.side, 0, 1, "/mesh/side");
  check.require(std::ranges::is_sorted(m.side), "/mesh/side", "has fronts after backs");
  for (std::size_t i = 0; i < m.size(); ++i) {
    const Index twin = m.twin[i];
    if (twin == kNone && m.side[i] == 0) continue;
    if (twin == kNone) check.fail("/mesh/side", fmt::format("has a back without a front at {}", i));
    const bool fits = m.twin[twin] == i && m.side[twin] != m.side[i] &&
                      m.polygon[twin] == m.polygon[i] && m.surface[twin] == m.surface[i] &&
                      m.outline(twin).size() == m.outline(i).size();
    if (!fits) check.fail("/mesh/twin", fmt::format("names no other side of {}", i));
  }
}

/// Checks what is said of each patch once all lengths and indices are right.
void checkPatches(const Checker& check, const PatchMesh& m) {
  check.within(m.area, 0, HUGE_VAL, "/mesh/area");
  check.unit(
      m.normal, [&](std::size_t i) { return m.area[i] == 0; }, "/mesh/normal");
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (m.area[i] > 0 && m.piece_offset[i + 1] == m.piece_offset[i]) {
      check.fail("/mesh/piece_offset", fmt::format("gives {} no triangle", i));
    }
    if (m.polygons.size() == 0) continue;
    const Index polygon = m.polygon[i];
    if (polygon == kNone ? m.area[i] > 0 : m.polygons.surface[polygon] != m.surface[i]) {
      check.fail("/mesh/polygon", fmt::format("gives {} none of its surface's", i));
    }
  }
  checkSides(check, m);
}

void checkMesh(const Checker& check, const PatchMesh& m) {
  const std::size_t n = m.size();
  check.offsets(m.corner_offset, n, m.corners.size(), 3, "/mesh/corner_offset");
  check.indices(m.corners, m.vertices.size(), false, "/mesh/corners");
  check.offsets(m.piece_offset, n, m.pieces.size(), "/mesh/piece_offset");
  for (const auto& piece : m.pieces) {
    check.indices(piece, m.vertices.size(), false, "/mesh/pieces");
  }
  check.length(m.centroid, n, "/mesh/centroid");
  check.length(m.normal, n, "/mesh/normal");
  check.length(m.polygon, n, "/mesh/polygon");
  check.indices(m.polygon, m.polygons.size(), true, "/mesh/polygon");
  check.length(m.surface, n, "/mesh/surface");
  check.indices(m.surface, m.surface_names.size(), false, "/mesh/surface");
  check.length(m.index_in_surface, n, "/mesh/index_in_surface");
  check.indices(m.index_in_surface, n, false, "/mesh/index_in_surface");
  check.length(m.source_face, n, "/mesh/source_face");
  check.length(m.side, n, "/mesh/side");
  check.length(m.twin, n, "/mesh/twin");
  check.indices(m.twin, n, true, "/mesh/twin");
  checkPolygons(check, m);
  checkPatches(check, m);
}

/// Checks that an account has a number for each band.
void checkEnergy(const Checker& check, const EnergyAccount& energy, std::size_t bands,
                 std::string_view object) {
  for (const auto* values : {&energy.emitted, &energy.from_sky, &energy.absorbed, &energy.to_sky,
                             &energy.on_backs, &energy.imbalance}) {
    check.length(*values, bands, object);
  }
}

/// Checks what a person may have written over (the README of results says how).
void checkMaterials(const Checker& check, const PatchMaterials& m, const std::string& group) {
  check.within(m.reflectance, 0, 1, group + "/reflectance");
  check.within(m.emission, 0, HUGE_VAL, group + "/emission");
  for (const Light& light : m.lights) {
    check.within(light.strength, 0, HUGE_VAL, group + "/" + light.name);
  }
}

void checkSolution(const Checker& check, const Solution& s) {
  check.require(s.bands >= 1, "/solution/bands", "is not 1 or more");
  const bool empty = s.summary.status == SolveStatus::singular && s.radiosity.empty();
  check.length(s.irradiance, empty ? 0 : s.radiosity.size(), "/solution/irradiance");
  if (!empty)
    checkEnergy(check, s.summary.energy, std::size_t(s.bands), "/solution/summary/energy");
}

/// Checks a row of /elements/direct/elements or the like: its points exist, and the points of its
/// parts are its own.
void checkElement(const Checker& check, const ElementField& field, std::size_t e,
                  const std::string& object) {
  const Element& element = field.elements[e];
  const std::size_t n = element.corners;
  check.require(n == 0 || n == 3 || n == 4, object, "has elements of other than 3 or 4 corners");
  check.require(element.tested <= 1 && (n != 0 || element.tested == 0), object,
                "has elements that are tested as none can be");
  const std::size_t points = pointCount(n, element.tested != 0);
  check.require(points <= field.points.size() &&
                    (n == 0 || element.first_point <= field.points.size() - points),
                object, "points beyond its points");
  if (element.first_child == kNone) return;
  check.require(element.tested == 1 && element.first_child > e &&
                    element.first_child < field.elements.size() &&
                    field.elements.size() - element.first_child >= 4,
                object, "has elements whose parts are not four others after them");
  const Index* own = field.points.data() + element.first_point;
  for (std::size_t part = 0; part < 4; ++part) {
    const Element& child = field.elements[element.first_child + part];
    bool fits = child.corners == n && std::size_t(child.first_point) + n <= field.points.size();
    for (std::size_t k = 0; k < n && fits; ++k) {
      fits = field.points[child.first_point + k] == own[partsOf(n)[part][k]];
    }
    check.require(fits, object, "has a part whose corners are not its element's points");
  }
}

/// Checks that the elements are a forest over `roots`: every other element is a part of exactly
/// one.
void checkField(const Checker& check, const ElementField& field, const Elements& all,
                const std::string& object) {
  const std::string elements = object + "/elements";
  const std::size_t roots = all.roots.size();
  check.require(field.elements.size() >= roots, elements, "has fewer elements than roots");
  // The number is an attribute: any number, and its product with bands may be 0 again.
  check.require(field.vertices <= field.values.size(), object + "/vertices",
                "is more than there are values");
  check.length(field.values, field.vertices * std::size_t(all.bands), object + "/values");
  check.indices(field.points, field.vertices, false, object + "/points");
  std::vector<std::uint8_t> parents(field.elements.size(), 0);
  for (std::size_t e = 0; e < field.elements.size(); ++e) {
    const Element& element = field.elements[e];
    check.require(e >= roots || element.corners == 0 || element.corners == all.roots.cornerCount(e),
                  elements, "has a root with other corners than /elements/roots");
    check.require(e < roots || element.corners != 0, elements, "has a part without corners");
    checkElement(check, field, e, elements);
    if (element.first_child == kNone) continue;
    for (std::size_t part = 0; part < 4; ++part) {
      const std::size_t child = element.first_child + part;
      check.require(child >= roots && parents[child]++ == 0, elements,
                    "has parts of two elements, or of none");
    }
  }
  check.require(std::count(parents.begin() + std::ptrdiff_t(roots), parents.end(), 0) == 0,
                elements, "has parts of two elements, or of none");
}

void checkElements(const Checker& check, const Elements& e, const Results& results) {
  check.require(e.bands >= 1, "/elements/bands", "is not 1 or more");
  check.require(results.mesh && results.solution, "/elements", "comes without mesh and solution");
  check.require(e.bands == made(results.solution).bands, "/elements/bands",
                "is not that of /solution");
  // The mesh determines the roots.
  const ElementRoots roots = elementRoots(made(results.mesh).mesh);
  check.require(e.roots.patch == roots.patch && e.roots.corner == roots.corner &&
                    e.roots.of_patch == roots.of_patch,
                "/elements/roots", "is not of the patches of /mesh");
  checkField(check, e.direct, e, "/elements/direct");
  checkField(check, e.indirect, e, "/elements/indirect");
}

/// Checks shares of what leaves a patch, which lie within 0 and 1 but for their error.
template <class Value>
void checkShares(const Checker& check, const std::vector<Value>& shares, std::string_view object) {
  constexpr double kMostError = 0.1;  // hemicubes of few pixels, exact rows at a loose tolerance
  check.within(shares, -kMostError, HUGE_VAL, object);
}

void checkGathered(const Checker& check, const Gathered& g, const PatchMesh& mesh) {
  const std::size_t eyes = g.area.size();
  check.require(g.bands >= 1, "/gather/bands", "is not 1 or more");
  check.length(g.radiosity, std::size_t(g.bands) * eyes, "/gather/radiosity");
  check.length(g.irradiance, std::size_t(g.bands) * eyes, "/gather/irradiance");
  check.length(g.backs, eyes, "/gather/backs");
  check.length(g.sky, eyes, "/gather/sky");
  checkShares(check, g.backs, "/gather/backs");
  checkShares(check, g.sky, "/gather/sky");
  checkShares(check, g.backs_by_surface, "/gather/backs_by_surface");
  check.within(g.area, 0, HUGE_VAL, "/gather/area");
  check.length(g.backs_by_surface, mesh.surface_names.size(), "/gather/backs_by_surface");
  check.length(g.position, eyes, "/gather/position");
  if (g.at == GatherAt::patches) {
    check.length(g.area, mesh.size(), "/gather/area");
    check.length(g.eye_of_corner, 0, "/gather/eye_of_corner");
  } else {
    check.length(g.eye_of_corner, mesh.corners.size(), "/gather/eye_of_corner");
    check.indices(g.eye_of_corner, eyes, false, "/gather/eye_of_corner");
  }
}

void checkHeat(const Checker& check, const HeatSolution& heat, std::size_t patches) {
  check.require(heat.bands >= 1, "/heat/bands", "is not 1 or more");
  check.length(heat.radiosity, std::size_t(heat.bands) * patches, "/heat/radiosity");
  check.length(heat.irradiance, std::size_t(heat.bands) * patches, "/heat/irradiance");
  check.length(heat.net_flux, patches, "/heat/net_flux");
  check.length(heat.convection, patches, "/heat/convection");
  check.length(heat.temperature, patches, "/heat/temperature");
}

void checkBasis(const Checker& check, const LightBasis& basis, std::size_t patches) {
  check.require(basis.bands >= 1, "/basis/bands", "is not 1 or more");
  check.require(!basis.names.empty(), "/basis/names", "is empty");
  const std::size_t columns = basis.names.size() * std::size_t(basis.bands);
  check.require(std::size_t(basis.materials.bands) == columns, "/basis/reflectance",
                fmt::format("has {} columns, not {} of each of {} sources", basis.materials.bands,
                            basis.bands, basis.names.size()));
  check.length(basis.materials.reflectance, columns * patches, "/basis/reflectance");
  check.length(basis.materials.emission, columns * patches, "/basis/emission");
  check.length(basis.solution.radiosity, columns * patches, "/basis/radiosity");
  check.length(basis.solution.irradiance, columns * patches, "/basis/irradiance");
  checkMaterials(check, basis.materials, "/basis");
  checkEnergy(check, basis.solution.summary.energy, columns, "/basis/summary/energy");
}

/// Checks that there is one row for each unknown.
void checkFactors(const Checker& check, const FormFactors& factors, const Results& results) {
  const std::size_t rows = results.mesh ? results.mesh->mesh.size() : factors.fronts.size();
  check.length(factors.fronts, rows, "/form_factors/fronts");
  check.length(factors.backs, rows, "/form_factors/backs");
  check.length(factors.sky, rows, "/form_factors/sky");
  if (!factors.error.empty()) check.length(factors.error, rows, "/form_factors/error");
  checkShares(check, factors.fronts, "/form_factors/fronts");
  checkShares(check, factors.backs, "/form_factors/backs");
  checkShares(check, factors.sky, "/form_factors/sky");
  checkShares(check, factors.backs_by_surface, "/form_factors/backs_by_surface");
  check.within(factors.error, 0, HUGE_VAL, "/form_factors/error");
  if (results.mesh && !factors.backs_by_surface.empty()) {
    check.length(factors.backs_by_surface, results.mesh->mesh.surface_names.size(),
                 "/form_factors/backs_by_surface");
  }
}

}  // namespace

void checkResults(const std::string& path, const Results& results) {
  const Checker check(path);
  if (results.scene) checkScene(check, *results.scene);
  if (results.mesh) checkMesh(check, results.mesh->mesh);
  if (results.solution) checkSolution(check, *results.solution);
  if (results.elements) checkElements(check, *results.elements, results);

  if (results.gathered) {
    check.require(bool(results.mesh), "/gather", "comes without /mesh");
    if (results.mesh) checkGathered(check, *results.gathered, results.mesh->mesh);
  }
  if (results.heat) {
    check.require(bool(results.mesh), "/heat", "comes without /mesh");
    if (results.mesh) checkHeat(check, *results.heat, results.mesh->mesh.size());
  }
  if (results.basis) {
    check.require(bool(results.mesh), "/basis", "comes without /mesh");
    if (results.mesh) checkBasis(check, *results.basis, results.mesh->mesh.size());
  }

  // All stages must have the same N patches.
  std::optional<std::size_t> n;
  const auto same = [&](std::size_t count, std::string_view object) {
    if (!n) n = count;
    check.require(count == *n, object, fmt::format("has {} patches, not {}", count, *n));
  };
  if (results.mesh) {
    same(results.mesh->mesh.size(), "/mesh");
    if (results.scene) {
      check.indices(results.mesh->mesh.source_face, results.scene->faceCount(), false,
                    "/mesh/source_face");
      const std::vector<Surface>& surfaces = results.scene->surfaces;
      check.require(
          std::ranges::equal(results.mesh->mesh.surface_names, surfaces, {}, {}, &Surface::name),
          "/mesh/surface_names", "are not those of /scene/surfaces");
    }
  }
  if (results.factors) {
    checkFactors(check, *results.factors, results);
    if (!results.mesh) same(results.factors->fronts.size(), "/form_factors/fronts");
  }
  if (results.materials) {
    checkMaterials(check, *results.materials, "/solution");
    const auto bands = std::size_t(results.materials->bands);
    same(results.materials->reflectance.size() / bands, "/solution/reflectance");
    same(results.materials->emission.size() / bands, "/solution/emission");
  }
  if (results.solution && !results.solution->radiosity.empty()) {
    same(results.solution->radiosity.size() / std::size_t(results.solution->bands),
         "/solution/radiosity");
  }
}

}  // namespace radiosity
