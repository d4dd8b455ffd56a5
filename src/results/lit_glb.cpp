// Writes the solution as a glTF mesh that any viewer shows without lights.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/results.h"
#include "results/glb.h"
#include "results/lit_vertices.h"
#include "results/mesh_export.h"

namespace radiosity {

namespace {

/// The triangles of one surface and side.
class LitPrimitive {
 public:
  LitPrimitive(const GlbWriter& glb, double scale) : glb_(glb), scale_(scale) {}

  void add(const LitTriangles& from, std::span<const LitCorner> corners) {
    for (const LitCorner& corner : corners) {
      const auto [vertex, is_new] = lit_.of(corner);
      triangles.push_back(vertex);
      if (is_new) appendVertex(from.position(corner.point), lit_.radiosity().back());
    }
  }

  GlbVertices vertices;
  std::vector<Index> triangles;

 private:
  void appendVertex(const Vec3& position, const LitVertices::Triple& value) {
    glb_.addPosition(vertices, position);
    vertices.radiosity.push_back(value);
    LitVertices::Triple colour{};
    for (std::size_t b = 0; b < 3; ++b) {
      colour[b] = float(std::clamp(double(value[b]) * scale_, 0.0, 1.0));
    }
    vertices.colour.push_back(colour);
  }

  const GlbWriter& glb_;
  double scale_;
  LitVertices lit_;
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

void checkFinite(const std::string& path, const PatchMesh& mesh, Index patch,
                 std::span<const LitCorner> corners) {
  for (const LitCorner& corner : corners) {
    const Vec3& b = corner.radiosity;
    if (std::isfinite(b.x + b.y + b.z)) continue;
    throw RunError(
        fmt::format("{}: the light of an element of patch {} of {} is not finite; solve "
                    "again",
                    path, patch, mesh.surface_names[mesh.surface[patch]]));
  }
}

/// Writes all triangles and returns their number.
std::size_t writeTriangles(const std::string& path, const PatchMesh& mesh, LitTriangles& lit,
                           double ev) {
  GlbWriter glb(floatOrigin(mesh.vertices));
  glb.useExtension("KHR_materials_unlit");
  glb.setExtras({{"exposure_ev", ev},
                 {"COLOR_0", "min(1, B / pi * 2^exposure_ev), linear Rec. 709"},
                 {"_RADIOSITY", "B in W/m^2, linear Rec. 709"}});
  // White, since readers multiply COLOR_0 by it; rough and not metallic, for readers without unlit.
  const int material =
      glb.addMaterial({{"name", "radiosity"},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}},
                         {"metallicFactor", 0.0},
                         {"roughnessFactor", 1.0}}},
                       {"extensions", {{"KHR_materials_unlit", GlbWriter::Json::object()}}}});
  // Pictures show radiance L = B / pi, so with the same exposure both look the same.
  const double scale = std::exp2(ev) / std::numbers::pi;
  std::array<std::vector<std::vector<Index>>, 2> by_side;
  for (int side = 0; side < 2; ++side) {
    by_side[std::size_t(side)] =
        patchesBySurface(mesh, [&](std::size_t i) { return mesh.side[i] == side; });
  }
  std::size_t count = 0;
  std::vector<LitCorner> corners;
  for (std::size_t s = 0; s < mesh.surface_names.size(); ++s) {
    std::vector<GlbWriter::Json> primitives;
    for (const auto& patches : by_side) {
      LitPrimitive primitive(glb, scale);
      for (const Index i : patches[s]) {
        corners.clear();
        lit.append(i, corners);
        checkFinite(path, mesh, i, corners);
        primitive.add(lit, corners);
      }
      if (primitive.triangles.empty()) continue;
      count += primitive.triangles.size() / 3;
      primitives.push_back(glb.addPrimitive(primitive.vertices, primitive.triangles, material));
    }
    if (!primitives.empty()) glb.addNode(mesh.surface_names[s], std::move(primitives));
  }
  glb.write(path);
  return count;
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
  LitTriangles lit(mesh, radiosity, corners);
  writeTriangles(path, mesh, lit, ev);
}

std::size_t writeLitGlb(const std::string& path, const PatchMesh& mesh, const SurfaceLight& light,
                        double ev, double crease) {
  checkArguments(path, mesh, light.patches, ev);
  const std::vector<double> corners =
      light.corners.empty() ? cornerValues(mesh, light.patches, 3, crease) : light.corners;
  checkCorners(path, mesh, corners);
  LitTriangles lit(mesh, light.patches, corners, light.elements ? &light : nullptr);
  return writeTriangles(path, mesh, lit, ev);
}

}  // namespace radiosity
