// The scene cut into patches: planar, conforming, each with its origin in the scene.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/option_line.h"
#include "radiosity/report_line.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Planar polygons: the coarse faces of the scene, coplanar neighbours of a surface merged, cut
/// where others touch or cross. They are the occluders and are rasterised. A polygon is one or more
/// loops: outer ones counter-clockwise about `normal`, holes clockwise; the inside is even-odd.
/// Neighbouring polygons share their edges vertex for vertex (no T-junctions), except with
/// faces_as_patches on a file that has them.
struct PlanarPolygons {
  std::vector<std::size_t> loop_offset;    ///< P + 1, into loop_begin: loops of polygon p
  std::vector<std::size_t> corner_offset;  ///< L + 1, into corners: corners of loop l
  std::vector<Index> corners;              ///< vertices (of PatchMesh::vertices)
  std::vector<Vec3> normal;                ///< P, unit, of the front
  std::vector<Vec3> origin;                ///< P, a point of the plane, inside or near the polygon
  std::vector<Index> surface;              ///< P
  std::vector<Index> index_in_surface;     ///< P; with surface name the identity, which breaks ties
  std::vector<std::uint8_t> back_is_patch;  ///< P, 1: the back carries patches too (two-sided)

  std::size_t size() const { return normal.size(); }
  std::size_t loopBegin(std::size_t p) const { return loop_offset[p]; }
  std::size_t loopEnd(std::size_t p) const { return loop_offset[p + 1]; }
  std::span<const Index> loop(std::size_t l) const {
    return {corners.data() + corner_offset[l], corner_offset[l + 1] - corner_offset[l]};
  }
};

/// A connected set of one-sided polygons proved to be a closed surface that neither touches nor
/// crosses itself: it separates two regions, and its fronts face one of them.
struct ClosedSurface {
  std::vector<Index> polygons;  ///< into PatchMesh::polygons, ascending
  Vec3 lower{0.0};              ///< its box, metres
  Vec3 upper{0.0};
  bool is_solid = true;  ///< fronts face the unbounded region: a body; else a room
};

/// Bodies and rooms enclosed by the polygons of a mesh.
struct Enclosures {
  std::vector<ClosedSurface> surfaces;  ///< bodies and rooms
  std::vector<Index> surface_of;        ///< P, into surfaces; kNone: of no proved surface
  /// P, 1: a polygon on the same corners faces the other way, so that its front hides this one's
  /// back.
  std::vector<std::uint8_t> covered;
  /// N, 1: the patch is proved to see no sky, since it looks into a bounded space; also for a patch
  /// without an area.
  std::vector<std::uint8_t> enclosed;
  bool closed = false;  ///< all patches are enclosed, and there are some
};

/// N patches, structure of arrays, double precision. All fronts come first, then the backs of
/// two-sided patches; a back has its own centroid, normal (flipped) and corners (reversed).
struct PatchMesh {
  std::vector<Vec3> vertices;                ///< metres
  std::vector<std::size_t> corner_offset;    ///< N + 1, into corners
  std::vector<Index> corners;                ///< outline, counter-clockwise seen from its side
  std::vector<std::size_t> piece_offset;     ///< N + 1, in triangles, into pieces
  std::vector<std::array<Index, 3>> pieces;  ///< triangles that tile each patch, same orientation
  std::vector<Vec3> centroid;                ///< N; area centroid, moved inside for concave patches
  std::vector<Vec3> normal;                  ///< N, unit; 0 for a degenerate patch
  std::vector<double> area;                  ///< N, m^2; 0 for a degenerate patch
  std::vector<Index> polygon;                ///< N, into polygons; kNone for a degenerate patch
  std::vector<Index> surface;                ///< N, into surface_names
  std::vector<Index> index_in_surface;  ///< N; with surface name the identity, which gives seeds
  std::vector<Index> source_face;       ///< N, face of the Scene
  std::vector<std::uint8_t> side;       ///< N, 0 front, 1 back
  std::vector<Index> twin;              ///< N, the patch on the other side, or kNone
  PlanarPolygons polygons;
  std::vector<std::string> surface_names;  ///< as Scene::surfaces, in order
  /// Metres: what is nearer touches. Absent: 1e-7 of the diagonal. The mesh has less for a small
  /// `weld`, and for small things.
  std::optional<double> coincidence;
  /// Enclosures of `polygons`. meshScene() finds them. A mesh from elsewhere may lack them; each
  /// user then finds them anew. Code that changes vertices or polygons by hand must reset them.
  std::optional<Enclosures> enclosures;

  std::size_t size() const { return area.size(); }
  std::size_t frontCount() const;
  std::span<const Index> outline(std::size_t i) const {
    return {corners.data() + corner_offset[i], corner_offset[i + 1] - corner_offset[i]};
  }
};

/// Indices and form factors of more could not be handled.
inline constexpr double kMostPatches = 20e6;

struct MeshOptions {
  /// About how many (both sides counted once); 1 or more. If outlines alone take more cells, cells
  /// of a polygon are joined; a polygon is at least one patch.
  std::size_t patches = 2000;
  double max_edge = 0;  ///< metres; longest patch edge; 0: derived from `patches`
  /// Coincidence, as a fraction of the scene's diagonal, 0 to 1e-2; but never more than 1e-4 (or
  /// this, if it is more) of a small thing: connected faces of a surface.
  double weld = 1e-7;
  bool faces_as_patches = false;  ///< patch k is face k of the file; nothing welded, cut, reordered
  /// Throws InputError naming the option and its range.
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "patches",
          .help = "How finely the scene is cut: about how many patches, but at least one for each "
                  "planar piece"},
         o.patches, {.from = 1, .to = kMostPatches});
    list({.name = "max_edge",
          .value = "METRES",
          .unit = "m",
          .help = "Longest edge of a patch (default: derived from the number of patches)"},
         o.max_edge, {.from = 0});
    list({.name = "weld",
          .value = "FRACTION",
          .help = "Points closer than this fraction of the scene's diagonal are one"},
         o.weld, {.from = 0, .to = 0.01});
    list({.name = "faces_as_patches",
          .help = "Patch k is face k of the file: nothing is welded, cut or re-ordered"},
         o.faces_as_patches);
  }
};

/// The account of the area of one surface, m^2, one side.
struct SurfaceAreas {
  std::string name;
  double given = 0;       ///< area of the faces in the file
  double kept = 0;        ///< area of the patches (front side)
  double buried = 0;      ///< dropped: in contact, or inside a closed solid
  double overlapped = 0;  ///< dropped: coplanar overlap with a surface that wins
  double degenerate = 0;  ///< dropped: faces thinner than coincidence, and area that welding moved
                          ///< off (within coincidence of an edge; negative: on to)
};

/// The report of meshing: every figure that `radiosity mesh` prints.
struct MeshReport {
  std::vector<SurfaceAreas> surfaces;
  std::size_t welded_vertices = 0;
  std::size_t degenerate_faces = 0;
  std::size_t duplicate_faces = 0;
  std::size_t nonplanar_faces = 0;  ///< split into triangles
  double largest_deviation = 0;     ///< metres, of the non-planar faces
  std::size_t cuts = 0;             ///< contact and crossing segments that cut a polygon
  std::size_t split_edges = 0;      ///< edges of the file split at vertices on them
  std::size_t hidden_sides = 0;  ///< sides of two-sided planar polygons dropped: they see nothing
  std::size_t nonmanifold_edges = 0;
  std::size_t polygons = 0;
  std::size_t triangles = 0;    ///< patches that are triangles
  std::size_t quads = 0;        ///< patches with four corners; others are joined cells, or faces
  std::size_t t_junctions = 0;  ///< counted by an independent checker; 0 unless faces_as_patches
  std::size_t crossings = 0;    ///< faces_as_patches: pairs of faces that cross, not repaired
  double smallest_angle = 0;    ///< degrees, over all patches
  std::string smallest_angle_surface;
  double longest_edge = 0;  ///< metres
  std::vector<Note> notes;  ///< repairs, by name

  static void describe(auto& list, auto& r) {
    list({"quads", "quads"}, r.quads);
    list({"triangles", "triangles"}, r.triangles);
    list({"polygons", "planar polygons"}, r.polygons);
    list({"longest_edge", "longest edge", "m"}, r.longest_edge);
    list({"smallest_angle", "smallest angle", "deg"}, r.smallest_angle);
    list({"smallest_angle_surface", "  on surface"}, r.smallest_angle_surface);
    list({"t_junctions", "T-junctions"}, r.t_junctions);
    list({"cuts", "cuts where faces meet"}, r.cuts);
    list({"split_edges", "edges split"}, r.split_edges);
    list({"welded_vertices", "vertices welded"}, r.welded_vertices);
    list({"degenerate_faces", "degenerate faces"}, r.degenerate_faces);
    list({"duplicate_faces", "duplicate faces"}, r.duplicate_faces);
    list({"nonplanar_faces", "non-planar faces"}, r.nonplanar_faces);
    list({"largest_deviation", "  largest deviation", "m"}, r.largest_deviation);
    list({"hidden_sides", "hidden sides dropped"}, r.hidden_sides);
    list({"nonmanifold_edges", "non-manifold edges"}, r.nonmanifold_edges);
    list({"crossings", "crossings not repaired"}, r.crossings);
    list.table("surfaces", r.surfaces, [](auto& column) {
      column("name", &SurfaceAreas::name);
      column("given", &SurfaceAreas::given, "m^2");
      column("kept", &SurfaceAreas::kept, "m^2");
      column("buried", &SurfaceAreas::buried, "m^2");
      column("overlapped", &SurfaceAreas::overlapped, "m^2");
      column("degenerate", &SurfaceAreas::degenerate, "m^2");
    });
    list.notes(r.notes);
  }
};

struct MeshResult {
  PatchMesh mesh;
  MeshReport report;
};

/// Cuts the scene into patches. Errors: InputError if the scene has no face with area, and as
/// validate().
MeshResult meshScene(const Scene& scene, const MeshOptions& options, Progress& progress);

/// Takes n log n in the polygons, except for rooms that contain others. Throws Cancelled.
Enclosures findEnclosures(const PatchMesh& mesh, Progress& progress);

/// T-junctions of any mesh: vertices that lie inside an edge of a patch (closer than
/// `tolerance` metres) without being one of its ends. Brute force by a grid; knows nothing of how
/// the mesh was made.
std::size_t countTJunctions(const PatchMesh& mesh, double tolerance);

/// Interior angles in degrees: the smallest over all patches of non-zero area.
double smallestAngle(const PatchMesh& mesh);

/// Reflectance and emission of every patch, in any number of bands: one for heat (1 - emissivity
/// and exitance), three for colours, more for spectra. A band knows nothing of the others.
struct PatchMaterials {
  int bands = 3;                    ///< 1 or more
  std::vector<double> reflectance;  ///< N * bands, row-major, 0 to 1
  std::vector<double> emission;     ///< N * bands, exitance, W/m^2
  std::vector<Light> lights;        ///< without a surface, with a strength for each band

  /// Errors: InputError naming the array whose size is not that of `patches` patches, and the size
  /// it should have.
  void requireSizes(std::size_t patches) const;
};

/// The scene's materials: linear Rec. 709 red, green and blue, textures averaged over the patch's
/// area, and Scene::lights.
PatchMaterials patchMaterials(const Scene& scene, const PatchMesh& mesh);

/// The patches, ascending, that emit in some band. Errors as requireSizes().
std::vector<Index> emittingPatches(const PatchMesh& mesh, const PatchMaterials& materials);

/// Groups of patch corners that share one value in a smooth field. At every vertex a group holds
/// corners whose patches bend less than `crease` degrees and are linked by such neighbours on the
/// same side. Neighbours share a surface and an edge that no other patch touches.
struct CornerGroups {
  std::vector<Index> of_corner;      ///< the group of every entry of PatchMesh::corners
  std::vector<std::size_t> begin;    ///< G + 1, into corners and patches
  std::vector<std::size_t> corners;  ///< into PatchMesh::corners, group by group, by index in
                                     ///< surface: no sum depends on how patches are numbered
  std::vector<Index> patches;        ///< of each corner; a patch may hold several, side by side

  std::size_t size() const { return begin.size() - 1; }
  std::span<const std::size_t> cornersOf(std::size_t group) const {
    return {corners.data() + begin[group], begin[group + 1] - begin[group]};
  }
  std::span<const Index> patchesOf(std::size_t group) const {
    return {patches.data() + begin[group], begin[group + 1] - begin[group]};
  }
};
CornerGroups cornerGroups(const PatchMesh& mesh, double crease);

/// Identity of the geometry a form-factor matrix belongs to: vertices, patches, sides, surface
/// names. Not reflectance or emission. 16 hex digits.
std::string geometryHash(const PatchMesh& mesh);

}  // namespace radiosity
