// The results file (HDF5) and all output formats. Every writer writes a temporary file in the same
// folder and renames it: a failed run leaves no half-written file.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/gather.h"
#include "radiosity/heat.h"
#include "radiosity/illuminance.h"
#include "radiosity/light_basis.h"
#include "radiosity/lightmap.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/radiant_temperature.h"
#include "radiosity/render.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The value of a stage, if there is one, and its key: a text of the options and inputs that made
/// it. A stage is reused only if its key is the one asked for.
template <class T>
struct Keyed {
  std::optional<T> value;
  std::string key;

  explicit operator bool() const { return value.has_value(); }
  // The value must be there. NOLINTBEGIN(bugprone-unchecked-optional-access)
  T& operator*() { return *value; }
  const T& operator*() const { return *value; }
  T* operator->() { return &*value; }
  const T* operator->() const { return &*value; }
  // NOLINTEND(bugprone-unchecked-optional-access)
};

/// The contents of a results file; an absent stage was not computed or was dropped.
struct Results {
  std::string version;  ///< of the program that wrote it
  std::optional<Scene> scene;
  Keyed<MeshResult> mesh;
  Keyed<FormFactors> factors;
  std::optional<PatchMaterials> materials;  ///< of the solution
  Keyed<Solution> solution;
  Keyed<Elements> elements;  ///< light after the solution, of all patches
  Keyed<Gathered> gathered;  ///< by the gather method
  Keyed<HeatSolution> heat;  ///< radiative exchange
  Keyed<LightBasis> basis;   ///< light of single lamps
};

/// A stage stands after the one that it is made from.
enum class Stage { mesh, form_factors, solution, elements, gather, heat, basis };

template <class T>
struct StageOf {
  Stage stage;
  const char* group;  ///< in the file
  const char* name;   ///< for people
  Keyed<T> Results::*value;
  std::optional<Stage> from = {};  ///< the stage that it is made from; none: the scene alone
};

/// What there is to know of every stage, in the order of Stage: files, the pipeline's rules of what
/// is kept and discarded, and reports are loops over it.
inline constexpr std::tuple kStages{
    StageOf<MeshResult>{Stage::mesh, "mesh", "mesh", &Results::mesh},
    StageOf<FormFactors>{Stage::form_factors, "form_factors", "form factors", &Results::factors,
                         Stage::mesh},
    StageOf<Solution>{Stage::solution, "solution", "solution", &Results::solution,
                      Stage::form_factors},
    StageOf<Elements>{Stage::elements, "elements", "elements", &Results::elements, Stage::solution},
    StageOf<Gathered>{Stage::gather, "gather", "gathered light", &Results::gathered, Stage::mesh},
    StageOf<HeatSolution>{Stage::heat, "heat", "heat exchange", &Results::heat,
                          Stage::form_factors},
    StageOf<LightBasis>{Stage::basis, "basis", "single lamps", &Results::basis,
                        Stage::form_factors}};

template <Stage stage>
inline constexpr auto kStage = std::get<std::size_t(stage)>(kStages);

/// Calls `visit` with the StageOf of each stage, in their order.
template <class Visit>
void forEachStage(const Visit& visit) {
  std::apply([&](const auto&... stage) { (visit(stage), ...); }, kStages);
}

/// True for a file that starts with the HDF5 signature (whatever its name).
bool isResultsFile(const std::string& path);

/// True for an HDF5 file of another program, which results must not replace.
bool isForeignHdf5(const std::string& path);

/// The scene in a results file, without its stages; none if the file has none or cannot be read.
std::optional<Scene> sceneInResults(const std::string& path);

/// Reads all stages. InputError: no such file, not a results file, a damaged or foreign dataset
/// (named). `with_factors` false: the matrix is left out (its accounts and report are read).
/// `scratch`: holds the matrix; null: it is in memory.
Results readResults(const std::string& path, bool with_factors = true,
                    std::shared_ptr<ScratchMemory> scratch = nullptr);

/// Writes every stage present. HDF5 1.10 or newer reads it, every byte is under a checksum; small
/// things are attributes, arrays are datasets with their unit as an attribute. Layout:
///   /              format, format_version, version (of the program)
///   /scene         as Scene: vertices, corners, surfaces/, materials/, cameras/, textures/, notes/
///   /mesh          as PatchMesh; key, geometry_hash, polygons/, report/
///   /form_factors  csr_matrix((data, indices, indptr), shape) of scipy: data f32 or f64, indices
///                  int32 increasing in a row, indptr int64; row_sum (of data), fronts, backs, sky,
///                  error (figures of the rows; exact method), area; order (of storage, of the
///                  patches) if A_i F_ij = A_j F_ji was stored once a pair; normal, centroid,
///                  surface, surface_names (those of /mesh); method, key, geometry_hash, report/
///   /solution      radiosity, irradiance, reflectance, emission (N x bands), sky (an attribute of
///                  bands numbers; none: dark), summary/, key; of photometric lamps, for others to
///                  read, illuminance (lx) and luminance (cd/m^2), N
///   /elements      bands, key, report/; roots/ as ElementRoots: patch, corner (R x 4), of_patch;
///                  direct/ and indirect/ as ElementField: elements/ (a row an element, the first R
///                  the roots), points, vertices, values (V x bands, W/m^2)
///   /gather        radiosity, irradiance (L x bands, f32; L eyes), backs, sky, area, position;
///                  backs_by_surface;
///                  eye_of_corner (at vertices: the eye of every entry of /mesh/corners); at, key,
///                  summary/ with passes/ (a row a pass; bound is NaN if there is none)
///   /heat          temperature (N), net_flux, convection (N), radiosity, irradiance (N x bands),
///                  as HeatSolution; condition_table, condition_settings, condition_groups, the
///                  text of the conditions; key, summary/ with balance_W/
///   /basis         names (S), bands (of one source), radiosity, irradiance, reflectance, emission
///                  (N x S * bands, column s * bands + b), sky (S * bands numbers), summary/, key
/// The number of columns is that of bands: three from scene files, any number from a program.
/// The matrix is written row by row, never copied. Errors: RunError (disk full), Cancelled, and as
/// PatchMaterials::requireSizes(); `path` is then unchanged.
void writeResults(const std::string& path, const Results& results, Progress& progress);
/// The same with form factors that are not in results.factors, which is ignored: code that shares
/// them need not copy the matrix.
void writeResults(const std::string& path, const Results& results, const FormFactors& factors,
                  Progress& progress);

/// Brings the results file at `path` up to date with `results` without writing again what it has:
/// stages whose keys differ are appended, and the scene unless `same_scene`; one write of its first
/// page switches the file over to them. If killed at any moment, the file is unchanged or whole.
/// The form factors may be without their matrix. Returns false, with the file unchanged, if it does
/// not have the mesh and form factors of `results`, if another run extends it, if another program's
/// HDF5 wrote it, or if stages replaced in earlier runs take up half of it; then write it whole.
/// Errors: RunError (disk full), as PatchMaterials::requireSizes(); the file is then unchanged,
/// too.
bool updateResults(const std::string& path, const Results& results, bool same_scene);

/// Bytes writeResults() will put on disk, within 4 kB.
std::size_t estimateResultsBytes(const Results& results);

/// MatrixMarket coordinate real general, 1-based, 17 significant digits: F as stored, a row an
/// unknown.
void writeMatrixMarket(const std::string& path, const ExchangeMatrix& matrix, Progress& progress);

/// The patches as they are, by extension: .obj (outlines, one object a surface, in mesh order: face
/// k is front patch k) or .glb (triangles, one node a surface, flat). The back of a two-sided patch
/// is the same sheet and is not repeated.
void writeMesh(const std::string& path, const PatchMesh& mesh);

/// Lit mesh, glTF 2.0 binary: one node a surface, one primitive a side; white base colour,
/// KHR_materials_unlit, COLOR_0 = min(1, B / pi * 2^ev), linear: the radiance that writeImage()
/// shows at the same exposure (exposure_ev in the scene's `extras`); true B, W/m^2, in the float
/// attribute _RADIOSITY. Values are interpolated as cornerValues() does. Coordinates are the
/// scene's; far from the origin a node translation carries them. radiosity: N * 3.
void writeLitGlb(const std::string& path, const PatchMesh& mesh, std::span<const double> radiosity,
                 double ev, double crease);
/// The same from radiosities at the corners (mesh.corners.size() * 3).
void writeLitGlb(const std::string& path, const PatchMesh& mesh, std::span<const double> radiosity,
                 std::span<const double> corners, double ev);
/// The same of light as pictures show it: of elements, if `light` has evaluated ones. An element
/// that neither field cuts further is cut into triangles, with B = E + rho * H at its corners and
/// linear in between. An edge that neighbours cut has corners there, too, so that triangles meet
/// corner to corner. Returns the number of triangles in the file.
std::size_t writeLitGlb(const std::string& path, const PatchMesh& mesh, const SurfaceLight& light,
                        double ev, double crease);

/// The lightmap's entry in the file of a mesh.
struct LightmapFile {
  std::string image;   ///< the name of the map's file
  double ev = 0;       ///< exposure that suits a picture of the scene
  std::string source;  ///< the glTF file that the scene was read from; empty: another kind of file
};

/// Writes the scene's own mesh with the map's texture coordinates, glTF 2.0 binary. Of a glTF file:
/// that file with its nodes, names, materials, textures, normals, coordinates and extras, all in
/// one file. A mesh of several nodes becomes one per node, a vertex between charts becomes several,
/// and a primitive whose backs have charts becomes two, of a one-sided copy of its material. Of
/// other files: flat triangles, a node a surface, with base colours and emission. The scene's
/// `extras` have `lightmap`: file, texCoord, shows, unit, radiance (how to make it of a texel),
/// exposure_ev. Returns n of TEXCOORD_n: 1, or the first that the file does not have. Errors:
/// InputError for a source that has changed since, RunError if the file cannot be written.
int writeLightmapGlb(const std::string& path, const Scene& scene, const Lightmap& map,
                     const LightmapFile& file);

/// .exr: 32-bit floats, linear, colours multiplied by alpha as the format asks (a pixel is then
/// what reaches it; a miss is 0,0,0,0). .png: 8 bits, colours not multiplied; linear images get the
/// sRGB curve, display-referred ones are stored as they are. .hdr: Radiance's RGBE, linear, colours
/// multiplied by alpha, which it does not have. `metadata`: name, value pairs.
/// `layers`: of .exr alone; their values are stored as they are, their units as attributes
/// ("depth.unit").
void writeImage(const std::string& path, const Image& image, bool display_referred,
                std::span<const std::pair<std::string, std::string>> metadata = {},
                std::span<const ImageLayer> layers = {});

/// Reads an image: numbers as stored (no curve is undone), alpha divided out if the format
/// multiplies by it.
Image readImage(const std::string& path);

/// A picture and the meaning of its numbers, as its file gives it.
struct ImageFile {
  Image image;
  bool bytes = false;    ///< whole numbers, mapped to [0, 1]: as a rule sRGB-coded
  std::string quantity;  ///< as given to writeImage() ("radiance"); empty: not given
};
/// `max_image`: in millions of pixels; a larger image is not unpacked. Errors: InputError if the
/// file is no image or too large, RunError if it does not fit into memory.
ImageFile readImageFile(const std::string& path, double max_image = 100);

/// A mesh with colours at its vertices, of this or another program: numbers as stored in the file,
/// metres and axes taken as they are.
struct LitMesh {
  std::string file;
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;  ///< T; counter-clockwise seen from the front
  std::vector<std::array<Vec3, 3>> colours;     ///< T, one a corner
  std::vector<Index> face;                 ///< T, the face of the file; polygons are cut into fans
  std::vector<Index> face_surface;         ///< by face, into surface_names
  std::vector<std::string> surface_names;  ///< nodes, or objects with their materials
  bool bytes = false;                      ///< whole numbers, mapped to [0, 1]
  bool radiosity = false;                  ///< from _RADIOSITY of writeLitGlb(): W/m^2
};

/// .glb, .gltf (_RADIOSITY, else COLOR_0), .ply (red, green, blue; ASCII and binary) and .obj
/// (`v x y z r g b`). Errors: InputError for a file without colours (with the cure), a damaged one.
LitMesh readLitMesh(const std::string& path);

/// Writes light at points: a header with units in its names, then a line a point: its place, the
/// way that it faces, its illuminance and what it is made of, lx; that of a cylinder, of the six
/// faces of a small cube and of half cylinders that face the four sides, lx; irradiance a band,
/// W/m^2, all, direct and indirect; the standard error over all light; 1 where the point stands in
/// a body; the name of its set. `light`: of all sets in turn. Errors: as the others, and
/// photometricOf().
void writeIlluminance(const std::string& path, std::span<const MeasuringPoints> sets,
                      const PointLightValues& light);

/// Writes radiant temperatures at points likewise, K: standing and seated, then of the faces of a
/// small cube; the share of surfaces in view; the name of the set. `temperatures`: of all sets in
/// turn.
void writeRadiantTemperatures(const std::string& path, std::span<const MeasuringPoints> sets,
                              const RadiantTemperatures& temperatures);

/// Writes heat exchange by surface: a header with units in its names, then a line a surface, all
/// digits; unknown cells are empty. Errors: as the others.
void writeHeatTable(const std::string& path, std::span<const SurfaceHeat> surfaces);
/// The same by patch, with its centroid; radiosity and irradiance a column a band.
void writeHeatPatches(const std::string& path, const HeatSolution& heat, const PatchMesh& mesh);
/// The same by row of a matrix, from 1, with its name, which may be empty. All have N entries.
void writeHeatRows(const std::string& path, const HeatSolution& heat,
                   std::span<const std::string> names, std::span<const double> area);

}  // namespace radiosity
