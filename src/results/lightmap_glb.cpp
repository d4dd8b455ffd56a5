// Writes the scene's own mesh with the coordinates of a lightmap.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "radiosity/results.h"
#include "results/glb.h"
#include "results/lightmap_gltf.h"

namespace radiosity {
namespace {

using Json = GlbWriter::Json;

Json extrasOf(const Lightmap& map, const LightmapFile& file, int set) {
  const bool arrives = map.shows == LightmapShows::irradiance;
  return {{"file", file.image},
          {"texCoord", set},
          {"shows", arrives ? "irradiance" : "radiosity"},
          {"unit", "W/m^2, linear Rec. 709"},
          {"radiance", arrives ? "baseColor * texel / pi + emissive" : "texel / pi"},
          {"exposure_ev", file.ev}};
}

/// Base colour and emission; emission above 1 needs the extension (`brighter`).
Json materialOf(const Material& material, bool& brighter) {
  const auto list = [](const Vec3& v) { return Json{v.x, v.y, v.z}; };
  const Vec3& rho = material.reflectance;
  Json json = {{"name", material.name},
               {"pbrMetallicRoughness",
                {{"baseColorFactor", {rho.x, rho.y, rho.z, 1.0}},
                 {"metallicFactor", 0.0},
                 {"roughnessFactor", 1.0}}}};
  const Vec3 radiance = material.radiance();
  const double most = std::max({radiance.x, radiance.y, radiance.z});
  if (!(most > 0)) return json;
  json["emissiveFactor"] = list(radiance / std::max(1.0, most));
  if (most <= 1) return json;
  brighter = true;
  json["extensions"] = {{"KHR_materials_emissive_strength", {{"emissiveStrength", most}}}};
  return json;
}

/// The triangles of one surface and side; corners of one chart share their vertices.
struct Primitive {
  GlbVertices vertices;
  std::vector<Index> triangles;
  std::map<std::pair<Index, Index>, Index> known;  ///< by vertex and chart

  void add(const GlbWriter& glb, const Scene& scene, const LightmapTriangle& triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vertex = scene.face(triangle.face)[triangle.corner[k]];
      const auto [place, fresh] =
          known.try_emplace({vertex, triangle.chart}, Index(vertices.count()));
      if (fresh) {
        glb.addPosition(vertices, scene.vertices[vertex]);
        vertices.lightmap.push_back({float(triangle.texcoord[k].x), float(triangle.texcoord[k].y)});
      }
      triangles.push_back(place->second);
    }
  }
};

/// Writes a node for each surface and a primitive for each side.
void writePlain(const std::string& path, const Scene& scene, const Lightmap& map,
                const Json& extras) {
  GlbWriter glb(floatOrigin(scene.vertices));
  glb.setExtras({{"lightmap", extras}});
  bool brighter = false;
  for (const Material& material : scene.materials) glb.addMaterial(materialOf(material, brighter));
  if (brighter) glb.useExtension("KHR_materials_emissive_strength");
  std::vector<std::array<Primitive, 2>> parts(scene.surfaces.size());
  for (const LightmapTriangle& triangle : map.triangles) {
    parts[scene.face_surface[triangle.face]][triangle.side].add(glb, scene, triangle);
  }
  for (std::size_t s = 0; s < parts.size(); ++s) {
    std::vector<Json> primitives;
    for (const Primitive& part : parts[s]) {
      if (part.triangles.empty()) continue;
      primitives.push_back(
          glb.addPrimitive(part.vertices, part.triangles, int(scene.surfaces[s].material)));
    }
    if (!primitives.empty()) glb.addNode(scene.surfaces[s].name, std::move(primitives));
  }
  glb.write(path);
}

}  // namespace

int writeLightmapGlb(const std::string& path, const Scene& scene, const Lightmap& map,
                     const LightmapFile& file) {
  if (file.source.empty()) {
    constexpr int kPlainSet = 1;
    writePlain(path, scene, map, extrasOf(map, file, kPlainSet));
    return kPlainSet;
  }
  LightmapGltf gltf(file.source, scene, map);
  gltf.setExtras(extrasOf(map, file, gltf.set()));
  gltf.write(path);
  return gltf.set();
}

}  // namespace radiosity
