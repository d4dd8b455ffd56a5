#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <sstream>
#include <type_traits>

#include "scene/obj_materials.h"
#include "scene/obj_scan.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/text.h"

namespace radiosity {

namespace {

static_assert(std::is_same_v<tinyobj::real_t, double>, "link the double build of tinyobjloader");

/// The polygons of the file, in file order.
struct Polygons {
  tinyobj::attrib_t attributes;
  tinyobj::mesh_t mesh;
};

Polygons parseGeometry(const std::string& path, const ObjScan& scan) {
  Polygons polygons;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warnings;
  std::string errors;
  std::istringstream stream(scan.geometry);
  const bool triangulate = false;
  const bool good = tinyobj::LoadObj(&polygons.attributes, &shapes, &materials, &warnings, &errors,
                                     &stream, nullptr, triangulate);
  // The scan has refused what the library would drop, so nothing may be missing here.
  if (!good || shapes.size() != 1 || shapes[0].mesh.num_face_vertices.size() != scan.faces.size()) {
    throw InputError(fmt::format("{}: cannot be read as Wavefront OBJ ({}); export it again", path,
                                 onOneLine(errors + warnings)));
  }
  polygons.mesh = std::move(shapes[0].mesh);
  return polygons;
}

/// Texture coordinates of a face's corners; empty unless all corners have them. The origin of an
/// OBJ's texture is its bottom left corner.
std::vector<Vec2> faceTexcoords(const Polygons& polygons, std::size_t first, std::size_t count) {
  std::vector<Vec2> result;
  for (std::size_t k = first; k < first + count; ++k) {
    const int t = polygons.mesh.indices[k].texcoord_index;
    if (t < 0) return {};
    result.emplace_back(polygons.attributes.texcoords[2 * std::size_t(t)],
                        1 - polygons.attributes.texcoords[2 * std::size_t(t) + 1]);
  }
  return result;
}

void addFaces(const ObjScan& scan, const Polygons& polygons, std::span<const Index> material_of,
              Index no_material, SceneBuilder& builder) {
  std::size_t first = 0;
  std::vector<Index> corners;
  for (std::size_t f = 0; f < scan.faces.size(); ++f) {
    const ObjFace& face = scan.faces[f];
    const std::size_t count = polygons.mesh.num_face_vertices[f];
    corners.clear();
    for (std::size_t k = first; k < first + count; ++k) {
      corners.push_back(Index(polygons.mesh.indices[k].vertex_index));
    }
    const Index material = face.material == kNone ? no_material : material_of[face.material];
    const Index surface = builder.surface(scan.objects[face.object], material);
    builder.addFace(corners, faceTexcoords(polygons, first, count), surface, face.line);
    first += count;
  }
}

/// Objects with a face that names no material at all share one default material. Returns it, or
/// kNone where there are none.
Index addNoMaterial(const ObjScan& scan, const SceneOptions& options, Scene& scene) {
  std::vector<bool> bare(scan.objects.size(), false);
  for (const ObjFace& face : scan.faces) {
    if (face.material == kNone) bare[face.object] = true;
  }
  std::vector<std::string> names;
  for (std::size_t k = 0; k < bare.size(); ++k) {
    if (bare[k]) names.push_back(scan.objects[k]);
  }
  if (names.empty()) return kNone;
  scene.notes.push_back(
      {Severity::warning, fmt::format("no material, reflectance {}: {}",
                                      options.default_reflectance, joinNames(names))});
  std::string name = "default";
  while (std::any_of(scene.materials.begin(), scene.materials.end(),
                     [&](const Material& m) { return m.name == name; })) {
    name += "#none";
  }
  scene.materials.push_back(defaultMaterial(name, options));
  return Index(scene.materials.size() - 1);
}

void noteInherited(const ObjScan& scan, std::span<const Index> material_of, Scene& scene) {
  for (const auto& [object, material_name] : scan.inherited) {
    const Material& material = scene.materials[material_of[material_name]];
    const bool emits = material.emission != Vec3(0.0);
    scene.notes.push_back(
        {emits ? Severity::loud : Severity::warning,
         fmt::format("object {} has no usemtl of its own and goes on with material {} of the "
                     "object before{}",
                     scan.objects[object], material.name, emits ? ", which EMITS LIGHT" : "")});
  }
}

}  // namespace

Scene loadObj(const std::string& path, const SceneOptions& options) {
  const ObjScan scan = scanObj(path, readWholeFile(path));
  const Polygons polygons = parseGeometry(path, scan);
  Scene scene;
  scene.file = path;
  scene.notes = scan.notes;
  scene.cameras = scan.cameras;
  scene.vertices = scan.vertices;
  const std::vector<Index> material_of = readObjMaterials(scan, options, scene);
  noteInherited(scan, material_of, scene);
  const Index no_material = addNoMaterial(scan, options, scene);
  SceneBuilder builder(scene);
  addFaces(scan, polygons, material_of, no_material, builder);
  builder.finish();
  return scene;
}

}  // namespace radiosity
