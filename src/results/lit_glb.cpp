// The solution as a glTF mesh that shows it in any viewer, without lights.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "radiosity/results.h"
#include "results/glb.h"
#include "results/mesh_export.h"

namespace radiosity {

namespace {

using Triple = std::array<float, 3>;

/// The triangles of one surface and side. Corners that meet at a vertex with the same radiosity
/// are one vertex of the file; where the values part (at a crease) there are as many as values.
class LitPrimitive {
 public:
  LitPrimitive(const GlbWriter& glb, const PatchMesh& mesh, std::span<const double> radiosity,
               std::span<const double> corner_radiosity, double scale)
      : glb_(glb),
        mesh_(mesh),
        radiosity_(radiosity),
        corner_radiosity_(corner_radiosity),
        scale_(scale) {}

  void add(Index patch) {
    for (std::size_t t = mesh_.piece_offset[patch]; t < mesh_.piece_offset[patch + 1]; ++t) {
      for (const Index v : mesh_.pieces[t]) triangles.push_back(vertexOf(v, valueAt(patch, v)));
    }
  }

  GlbVertices vertices;
  std::vector<Index> triangles;

 private:
  Triple valueAt(Index patch, Index vertex) const {
    const auto outline = mesh_.outline(patch);
    const auto found = std::find(outline.begin(), outline.end(), vertex);
    // A piece may have a vertex inside the patch; there the patch's own value stands.
    const double* value = found == outline.end()
                              ? &radiosity_[3 * std::size_t(patch)]
                              : &corner_radiosity_[3 * (mesh_.corner_offset[patch] +
                                                        std::size_t(found - outline.begin()))];
    return {float(value[0]), float(value[1]), float(value[2])};
  }

  Index vertexOf(Index vertex, const Triple& value) {
    std::vector<Index>& known = at_vertex_[vertex];
    for (const Index k : known) {
      if (vertices.radiosity[k] == value) return k;
    }
    const auto added = Index(vertices.count());
    known.push_back(added);
    glb_.addPosition(vertices, mesh_.vertices[vertex]);
    vertices.radiosity.push_back(value);
    Triple colour{};
    for (std::size_t b = 0; b < 3; ++b) {
      colour[b] = float(std::clamp(double(value[b]) * scale_, 0.0, 1.0));
    }
    vertices.colour.push_back(colour);
    return added;
  }

  const GlbWriter& glb_;
  const PatchMesh& mesh_;
  std::span<const double> radiosity_;
  std::span<const double> corner_radiosity_;
  double scale_;
  std::unordered_map<Index, std::vector<Index>> at_vertex_;
};

void checkArguments(const std::string& path, const PatchMesh& mesh,
                    std::span<const double> radiosity, double ev) {
  if (radiosity.size() != 3 * mesh.size()) {
    throw InputError(fmt::format(
        "{}: a lit mesh of {} patches needs {} values, not {}: three bands each; make colours of "
        "others, of one by rgbOf()",
        path, mesh.size(), 3 * mesh.size(), radiosity.size()));
  }
  for (std::size_t k = 0; k < radiosity.size(); ++k) {
    if (std::isfinite(radiosity[k])) continue;
    throw RunError(fmt::format("{}: the radiosity of patch {} of {} is {}; solve again", path,
                               k / 3, mesh.surface_names[mesh.surface[k / 3]], radiosity[k]));
  }
  if (!std::isfinite(ev) || std::abs(ev) > 1000) {
    throw InputError(fmt::format("{}: exposure {} is not within -1000 to 1000", path, ev));
  }
}

void checkCorners(const std::string& path, const PatchMesh& mesh, std::span<const double> corners) {
  if (corners.size() != 3 * mesh.corners.size()) {
    throw InputError(fmt::format("{}: a lit mesh of {} corners needs {} values at them, not {}",
                                 path, mesh.corners.size(), 3 * mesh.corners.size(),
                                 corners.size()));
  }
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (std::isfinite(corners[k])) continue;
    throw RunError(fmt::format("{}: the radiosity at vertex {} is {}; gather again", path,
                               mesh.corners[k / 3], corners[k]));
  }
}

}  // namespace

void writeLitGlb(const std::string& path, const PatchMesh& mesh, std::span<const double> radiosity,
                 double ev, double crease) {
  checkArguments(path, mesh, radiosity, ev);
  writeLitGlb(path, mesh, radiosity, cornerValues(mesh, radiosity, 3, crease), ev);
}

void writeLitGlb(const std::string& path, const PatchMesh& mesh, std::span<const double> radiosity,
                 std::span<const double> corners, double ev) {
  checkArguments(path, mesh, radiosity, ev);
  checkCorners(path, mesh, corners);
  GlbWriter glb(floatOrigin(mesh));
  glb.useExtension("KHR_materials_unlit");
  glb.setExtras({{"exposure_ev", ev},
                 {"COLOR_0", "min(1, B / pi * 2^exposure_ev), linear Rec. 709"},
                 {"_RADIOSITY", "B in W/m^2, linear Rec. 709"}});
  // White, since a reader multiplies COLOR_0 by it; rough and no metal for readers without unlit.
  const int material =
      glb.addMaterial({{"name", "radiosity"},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}},
                         {"metallicFactor", 0.0},
                         {"roughnessFactor", 1.0}}},
                       {"extensions", {{"KHR_materials_unlit", GlbWriter::Json::object()}}}});
  // The picture shows radiance L = B / pi; the same exposure makes both look the same.
  const double scale = std::exp2(ev) / std::numbers::pi;
  std::array<std::vector<std::vector<Index>>, 2> by_side;
  for (int side = 0; side < 2; ++side) {
    by_side[std::size_t(side)] =
        patchesBySurface(mesh, [&](std::size_t i) { return mesh.side[i] == side; });
  }
  for (std::size_t s = 0; s < mesh.surface_names.size(); ++s) {
    std::vector<GlbWriter::Json> primitives;
    for (const auto& patches : by_side) {
      LitPrimitive primitive(glb, mesh, radiosity, corners, scale);
      for (const Index i : patches[s]) primitive.add(i);
      if (primitive.triangles.empty()) continue;
      primitives.push_back(glb.addPrimitive(primitive.vertices, primitive.triangles, material));
    }
    if (!primitives.empty()) glb.addNode(mesh.surface_names[s], std::move(primitives));
  }
  glb.write(path);
}

}  // namespace radiosity
