// A scene as its file describes it: faces, surfaces, materials, cameras. Geometry is in metres,
// double precision, as the file has it: nothing is welded, merged or dropped here.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/light.h"
#include "radiosity/option_line.h"

namespace [[gnu::visibility("default")]] radiosity {

enum class Severity { info, warning, loud };

/// One thing a reader of the scene should know; `text` is one line and names the element.
struct Note {
  Severity severity = Severity::info;
  std::string text;
};

/// Linear RGB texels, row-major, top row first; finite and >= 0, as a reflectance at most 1.
struct Texture {
  std::string name;
  int width = 0;
  int height = 0;
  std::vector<float> texels;  ///< width * height * 3, linear
  bool repeat = true;         ///< outside [0,1]: repeat (true) or clamp to the edge
};

/// An ideal diffuse material. Bands are linear RGB (Rec. 709 primaries).
struct Material {
  std::string name;
  Vec3 reflectance{0.5};  ///< rho, 0 to 1
  Vec3 emission{0.0};     ///< radiant exitance M = pi L in W/m^2 (the file gives radiance L)
  bool two_sided = false;
  Index texture = kNone;           ///< into Scene::textures; multiplies `reflectance`
  Index emission_texture = kNone;  ///< into Scene::textures; multiplies `emission`

  /// W/m^2/sr: the radiance of `emission`, the same in each direction.
  Vec3 radiance() const { return emission / std::numbers::pi; }
};

/// Faces of one object (or node) with one material. The unit people name on the command line.
struct Surface {
  std::string object;  ///< object, group or node name
  Index material = kNone;
  /// "object/material", or one name if both have the same or the object has no material. It is
  /// unique in the scene and the key of results.
  std::string name;
};

/// A pinhole camera. `up` need not be perpendicular to the view direction.
struct Camera {
  std::string name;
  Vec3 eye{0.0};
  Vec3 target{0.0, 0.0, -1.0};
  Vec3 up{0.0, 1.0, 0.0};
  double vertical_fov = 0.7;  ///< full angle, radians, 0 to pi
  double aspect = 0.0;        ///< width / height; 0: the picture's own
};

/// Structure of arrays. F faces are polygons of 3 or more corners (concave ones allowed),
/// counter-clockwise seen from the front.
struct Scene {
  std::string file;                       ///< where it came from, for messages
  std::vector<Vec3> vertices;             ///< metres
  std::vector<std::size_t> face_offset;   ///< F + 1, into corners; front() is 0
  std::vector<Index> corners;             ///< vertex of each corner
  std::vector<Vec2> texcoords;            ///< one per corner, or empty; (0,0) is the top left of
                                          ///< the first texel, v grows downwards (as in glTF)
  std::vector<Vec3> colours;              ///< one per corner, or empty: a factor of the material's
                                          ///< reflectance, 0 to 1, linear between corners
  std::vector<Index> face_surface;        ///< F
  std::vector<std::size_t> face_element;  ///< F: line in an OBJ, ASCII STL, View3D or Radiance
                                          ///< file; number of the element in a .msh or .inp; else
                                          ///< of the face or cell in the primitive (glTF) or in the
                                          ///< file
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Camera> cameras;
  /// Those without a surface, of other names each; strengths are red, green and blue.
  std::vector<Light> lights{uniformSky({0, 0, 0})};
  Up up = Up::y;           ///< the defaults of cameras and the places of the sun depend on it
  std::string unit = "m";  ///< the file's unit before conversion: mm, cm, m, in, ft
  std::vector<Note> notes;

  std::size_t faceCount() const { return face_surface.size(); }
  std::span<const Index> face(std::size_t f) const {
    return {corners.data() + face_offset[f], face_offset[f + 1] - face_offset[f]};
  }
  const Material& materialOf(std::size_t f) const {
    return materials[surfaces[face_surface[f]].material];
  }
};

/// A scene from data in memory: triangles of vertices in metres, counter-clockwise seen from the
/// front, each of one material. `triangle_material`: one a triangle, or none if there is one
/// material. Surfaces are the materials, by name. Errors: as validate().
Scene sceneOfTriangles(std::span<const Vec3> vertices,
                       std::span<const std::array<Index, 3>> triangles,
                       std::span<const Material> materials,
                       std::span<const Index> triangle_material = {});

/// Checks a scene made by hand: every index is in range, every number finite, each reflectance in
/// [0, 1] and each name given once. Errors: InputError that names the element. meshScene() calls
/// it; readers of files ensure the same.
void validate(const Scene& scene);

/// What the colours of vertices in a file mean. glTF says so itself (linear), other formats do not.
enum class VertexColours { unused, linear, srgb };

/// Changes to a scene that has been read: applyOverrides(). NAMEs are as it takes them.
struct SceneOverrides {
  std::vector<std::string> set;  ///< "NAME.PROPERTY=VALUE"
  std::string materials_file;    ///< JSON {"NAME": {"reflectance": .., "emission": ..}}
  std::vector<std::string> one_sided;
  std::vector<std::string> two_sided;  ///< applied after one_sided
  std::vector<std::string> flip;       ///< their faces are turned over
  std::vector<std::string> without;    ///< their faces are left out
  std::optional<Up> up;                ///< replaces Scene::up, which depends on the format
  std::vector<Light> lights;           ///< each replaces that of its name in Scene::lights
  /// Throws InputError unless all lights are in range.
  void validate() const;

  /// A line an option (option_line.h), but for lights.
  static void describe(auto& list, auto& o) {
    list({.name = "set",
          .value = "NAME.PROPERTY=VALUE",
          .help = "Override a surface, material or object, those that a pattern matches ('*wall*') "
                  "or all: reflectance (0 to 1), emission (exitance, W/m^2) or radiance "
                  "(W/m^2/sr), which replace a texture, or tint, which keeps it and multiplies; "
                  "one number or three (R,G,B). May be repeated"},
         o.set);
    list({.name = "materials_file",
          .option = "materials",
          .value = "FILE.json",
          .help = R"(Overrides from a file: {{"NAME": {{"reflectance": [R,G,B], )"
                  R"("emission": [R,G,B]}}}})"},
         o.materials_file);
    list({.name = "one_sided",
          .value = "NAME|all",
          .help = "Make surfaces one-sided: black from behind, but they block. May be repeated"},
         o.one_sided);
    list({.name = "two_sided",
          .value = "NAME|all",
          .help = "Make surfaces two-sided, after those that become one-sided. May be repeated"},
         o.two_sided);
    list({.name = "flip",
          .value = "NAME|all",
          .help = "Turn surfaces over: a room that faces outward, a cap that faces the other way. "
                  "May be repeated"},
         o.flip);
    list({.name = "without",
          .value = "NAME",
          .help = "Leave surfaces out, for instance glass, which is solid here. May be repeated"},
         o.without);
    list({.name = "up",
          .value = "y|z",
          .help = "Axis that points up, for cameras that nobody gave: y or z (default: z in .stl, "
                  ".3mf, .rad, .msh, .inp, .vs3 and VTK's files, else y)"},
         o.up);
  }
};

/// How a file is read, and what is changed then. The defaults are those of the README.
struct SceneOptions : SceneOverrides {
  std::string unit;                  ///< mm|cm|m|in|ft; empty: the file's, else metres
  bool kd_is_srgb = false;           ///< Kd and base colour of an OBJ are sRGB, linearise them
  double default_reflectance = 0.5;  ///< of faces without a material; 0 to 1
  /// Of formats that do not say it: factors of the reflectance, or the reflectance itself of faces
  /// without a material.
  VertexColours vertex_colours = VertexColours::unused;
  bool textures = true;    ///< false: the material's factor alone
  double max_image = 100;  ///< largest texture, in millions of pixels; above 0
  /// Of the spheres, cylinders, cones and rings of a .rad: how far the facets that stand for one
  /// may lie off it, over its radius.
  double curve_deviation = 0.005;
  /// Throws InputError naming the option and its range.
  void validate() const;

  /// A line an option of reading. Those in keys decide what is read; results files, which hold a
  /// scene that has been read, refuse them.
  static void describe(auto& list, auto& o) {
    list({.name = "unit",
          .value = "UNIT",
          .help = "Unit of the scene file: mm, cm, m, in or ft (default: the file's, else m)"},
         o.unit);
    list({.name = "kd_is_srgb",
          .option = "kd-is",
          .value = "linear|srgb",
          .help = "How Kd and base colours are written",
          .on = "srgb",
          .off = "linear"},
         o.kd_is_srgb);
    list({.name = "default_reflectance",
          .value = "RHO",
          .help = "Reflectance of faces without a material"},
         o.default_reflectance, {.from = 0, .to = 1});
    list({.name = "vertex_colours",
          .value = "off|linear|srgb",
          .help = "Multiply the reflectance by the colours of vertices, in linear or sRGB numbers; "
                  "without a material they are the reflectance (default off; glTF's are always "
                  "used, linear)"},
         o.vertex_colours);
    list({.name = "textures",
          .value = "on|off",
          .help = "Average textures over each patch (on, default) or use the material's factor "
                  "alone"},
         o.textures);
    // A Texture counts its pixels with an int.
    list({.name = "max_image",
          .value = "MEGAPIXELS",
          .unit = "megapixels",
          .help = "Largest image that is read, in millions of pixels (default 100: 8K textures; 1 "
                  "takes up to 30 MB while it is read)",
          .in_key = InKey::never},
         o.max_image, {.to = 2000, .above = 0});
    list({.name = "curve_deviation",
          .value = "SHARE",
          .help = "How far facets may lie off the spheres, cylinders, cones and rings of a .rad, "
                  "over their radius",
          .in_key = InKey::if_changed},
         o.curve_deviation, {.from = 1e-5, .to = 0.2});
  }
};

/// The extensions of the files that loadScene() reads: ".obj, .gltf, ...".
std::string sceneExtensions();

/// Reads a scene, its format told by the extension, and applies the overrides: .obj (+ .mtl),
/// .gltf, .glb, .stl, .3mf; Radiance's .rad; View3D's .vs3, .v3d; Gmsh's .msh (2.2, 4.1); .inp of
/// CalculiX and Abaqus; .ply, .off; VTK's .vtk, .vtp, .vtu; by Assimp .dae, .fbx, .3ds, .ifc, .dxf,
/// as files of CAD and modellers. Named groups (solids, physical groups, element sets, arrays of
/// cells) are surfaces. Face f of the scene is face f of the file, but one may become several
/// (View3D's with subsurfaces, triangles of a strip, curved ones of a .rad). Lines and points are
/// left out, and volumes if there are faces; without faces the skin of the volumes is the scene. An
/// OBJ has no cameras of its own; a comment line `# camera eye=x,y,z target=x,y,z up=x,y,z
/// fov=DEGREES` (file units, vertical field of view) is read as one. Errors: InputError, one line
/// with file, element and cure; RunError if the scene does not fit into memory.
Scene loadScene(const std::string& path, const SceneOptions& options = {});

/// Changes a scene already in memory (one that came back from a results file). NAME is a surface,
/// material or object, tried in that order, but the material comes first if a surface has its name
/// only because its object has it too. If nothing is called so, "all" is every surface, and a
/// pattern (src/base/name_pattern.h) every surface that it matches by its own name, its object's or
/// its material's. PROPERTY is reflectance, emission (exitance, W/m^2), radiance (W/m^2/sr) or tint
/// (a factor of the reflectance); VALUE is one number or three with commas. Reflectance and
/// emission replace a texture, tint keeps it. A surface that shares its material gets its own copy.
/// A note names materials of reflectance 1. Unknown names are an InputError that lists the existing
/// ones, the most similar first; so is leaving out all faces.
void applyOverrides(Scene& scene, const SceneOverrides& overrides);

/// One surface as `radiosity info` prints it.
struct SurfaceInfo {
  std::string name;
  std::string material;
  std::size_t faces = 0;
  double area = 0;        ///< m^2, one side
  Vec3 emitted_power{0};  ///< W per band, both sides if two-sided
};

/// A summary of the scene as read, with notes on likely mistakes, by name.
struct SceneInfo {
  std::vector<SurfaceInfo> surfaces;
  Vec3 lower{0.0};
  Vec3 upper{0.0};
  std::size_t triangles = 0;  ///< after triangulating polygons
  Vec3 emitted_power{0};      ///< W per band
  /// Every edge is shared by two faces, oppositely (after weld), or one closed part that faces
  /// inwards encloses all the rest.
  bool watertight = false;
  std::size_t open_edges = 0;  ///< used by one face alone
  std::vector<Note> problems;  ///< flipped normals, duplicates, degenerates, overlaps, no emitter
};

/// The likely lamp: a material or surface with the name of one ("ceiling_lamp", "Light.003"); else
/// the ceiling, by name or as the surface with most area that faces down; else the first surface.
/// The name is one that SceneOptions::set takes; empty in a scene without surfaces.
std::string likelyLamp(const Scene& scene);

/// Inspects a scene (does not change it). `weld`: coincidence, as a fraction of the diagonal.
SceneInfo inspectScene(const Scene& scene, double weld = 1e-7);

}  // namespace radiosity
