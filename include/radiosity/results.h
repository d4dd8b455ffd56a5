// The results file (HDF5) and every format that goes out. Every writer writes a temporary file in
// the same folder and renames it: a failed run leaves nothing half-written.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace radiosity {

/// What a results file holds; an absent stage was not computed or was dropped. Each stage has a
/// `key`: a text of the options that made it and of the stage before it. A stage is reused only
/// where the key matches.
struct Results {
  std::string version;  ///< of the program that wrote it
  std::optional<Scene> scene;
  std::optional<MeshResult> mesh;
  std::string mesh_key;
  std::optional<FormFactors> factors;
  std::string factors_key;
  std::optional<PatchMaterials> materials;  ///< what the solution was made with
  std::optional<Solution> solution;
  std::string solution_key;
};

/// True for a file that starts with the HDF5 signature (whatever its name).
bool isResultsFile(const std::string& path);

/// Reads all stages. InputError: no such file, not a results file, a damaged or foreign dataset
/// (named). `with_factors` false: the matrix is left out (its accounts and report are read).
Results readResults(const std::string& path, bool with_factors = true);

/// Writes every stage present. Layout: /scene, /mesh, /form_factors (data, indices, indptr, shape:
/// scipy's csr_matrix; row_sum, backs, sky, area, normal, centroid), /solution. The matrix is
/// written row block by row block.
void writeResults(const std::string& path, const Results& results, Progress& progress);

/// Bytes writeResults() will put on disk, within a few kB.
std::size_t estimateResultsBytes(const Results& results);

/// MatrixMarket coordinate real general, 1-based, 17 significant digits: F as stored.
void writeMatrixMarket(const std::string& path, const ExchangeMatrix& matrix, Progress& progress);

/// The patches as they are: .obj (outlines, one group a surface) or .glb (triangles), by extension.
void writeMesh(const std::string& path, const PatchMesh& mesh);

/// Lit mesh, glTF 2.0 binary: white base colour, KHR_materials_unlit, COLOR_0 = exposed linear
/// value in [0,1], the exposure in `extras`, true radiosity in the float attribute _RADIOSITY; one
/// mesh primitive a surface and side. radiosity: N * 3.
void writeLitGlb(const std::string& path, const PatchMesh& mesh, std::span<const double> radiosity,
                 double ev, double crease);

/// EXR: linear float RGBA as given. `metadata`: name, value pairs.
/// PNG: 8 bits; linear images get the sRGB curve, display-referred ones are stored as they are.
void writeImage(const std::string& path, const Image& image, bool display_referred,
                std::span<const std::pair<std::string, std::string>> metadata = {});

/// Reads any image OpenImageIO knows, as it stands in the file (no colour conversion).
Image readImage(const std::string& path);

}  // namespace radiosity
