#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/input_file.h"
#include "scene/obj/obj_materials.h"
#include "scene/obj/obj_scan.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Texture coordinates of a face's corners; empty unless all corners have finite ones. The origin
/// of an OBJ's texture is its bottom left corner.
std::vector<Vec2> faceTexcoords(const ObjScan& scan, std::size_t face) {
  std::vector<Vec2> result;
  for (std::size_t k = scan.face_offset[face]; k < scan.face_offset[face + 1]; ++k) {
    if (scan.corner_texcoord[k] == kNone) return {};
    const Vec2 uv = scan.texcoords[scan.corner_texcoord[k]];
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return {};
    result.emplace_back(uv.x, 1 - uv.y);
  }
  return result;
}

/// Colours of a face's corners; empty if the file has none. Corners without one have no effect on
/// a material; without a material they have the default reflectance.
std::vector<Vec3> faceColours(const ObjScan& scan, std::size_t face, const SceneOptions& options) {
  std::vector<Vec3> result;
  if (scan.colours.empty()) return result;
  const double none = scan.faces[face].material == kNone ? options.default_reflectance : 1.0;
  for (std::size_t k = scan.face_offset[face]; k < scan.face_offset[face + 1]; ++k) {
    const Vec3& colour = scan.colours[scan.corners[k]];
    result.push_back(factorOfColour(colour, options.vertex_colours).value_or(Vec3(none)));
  }
  return result;
}

void addFaces(const ObjScan& scan, std::span<const Index> material_of, Index no_material,
              const SceneOptions& options, SceneBuilder& builder) {
  for (std::size_t f = 0; f < scan.faces.size(); ++f) {
    const ObjFace& face = scan.faces[f];
    const std::size_t first = scan.face_offset[f];
    const Index material = face.material == kNone ? no_material : material_of[face.material];
    builder.addFace(std::span(scan.corners).subspan(first, scan.face_offset[f + 1] - first),
                    faceTexcoords(scan, f), builder.surface(scan.objects[face.object], material),
                    face.line, faceColours(scan, f, options));
  }
}

/// Adds the default material for faces without any material; all objects share it. kNone if there
/// are no such faces.
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
  scene.notes.push_back(noMaterialNote(names, !scan.colours.empty(), options));
  std::string name = kNoMaterial;
  while (std::any_of(scene.materials.begin(), scene.materials.end(),
                     [&](const Material& m) { return m.name == name; })) {
    name += "#none";
  }
  scene.materials.push_back(defaultMaterial(name, options));
  if (!scan.colours.empty()) scene.materials.back().reflectance = Vec3(1.0);
  return Index(scene.materials.size() - 1);
}

void noteInherited(const ObjScan& scan, std::span<const Index> material_of, Scene& scene) {
  FeatureNotes notes;
  for (const auto& [object, material_name] : scan.inherited) {
    const Material& material = scene.materials[material_of[material_name]];
    const bool emits = material.emission != Vec3(0.0);
    notes.add(fmt::format("no usemtl of their own, so they go on with material {} of the object "
                          "before{}",
                          material.name, emits ? ", which EMITS LIGHT" : ""),
              scan.objects[object], emits ? Severity::loud : Severity::warning);
  }
  notes.appendTo(scene.notes);
}

}  // namespace

Scene loadObj(const std::string& path, const SceneOptions& options) {
  const ObjScan scan =
      scanObj(path, readWholeFile(path), options.vertex_colours != VertexColours::unused);
  Scene scene;
  scene.file = path;
  scene.notes = scan.notes;
  scene.cameras = scan.cameras;
  scene.vertices = scan.vertices;
  const std::vector<Index> material_of = readObjMaterials(scan, options, scene);
  noteInherited(scan, material_of, scene);
  const Index no_material = addNoMaterial(scan, options, scene);
  SceneBuilder builder(scene, options);
  addFaces(scan, material_of, no_material, options, builder);
  builder.finish();
  return scene;
}

}  // namespace radiosity
