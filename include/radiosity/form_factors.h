// Form factors by hemicube (Cohen & Greenberg 1985): F_ij, the fraction of what leaves i that
// reaches j, seen from one eye at each patch's centroid.
#pragma once

#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

struct FormFactorOptions {
  int resolution = 256;    ///< pixels along an edge of the hemicube's top face; even, 16 to 4096
  std::uint64_t seed = 1;  ///< of the random turns about each normal
  bool random_turns = true;
  bool symmetrize = false;  ///< merge both estimates of each pair, then restore closure
  Precision precision = Precision::single;
  std::size_t memory_limit = 0;  ///< bytes; 0: no limit
  bool simd = true;              ///< false: the scalar twin (same bits)
  void validate() const;
};

/// What the computation did, skipped and found.
struct FormFactorReport {
  std::size_t hemicubes = 0;
  std::size_t empty_rows = 0;           ///< degenerate patches: no hemicube
  std::size_t polygons = 0;             ///< planar polygons of the mesh
  std::size_t rasterised_polygons = 0;  ///< polygon-face fills, summed over hemicubes and faces
  std::size_t skipped_own_plane = 0;    ///< polygons never looked at: the eye lies in their plane
  std::size_t skipped_horizon = 0;      ///< behind the eye's horizon
  std::size_t skipped_facing_away = 0;  ///< back faces of closed solids seen from outside
  std::size_t skipped_face = 0;         ///< polygon-face pairs outside the face's pyramid
  std::size_t pixels = 0;               ///< resolved, summed over hemicubes
  std::string simd_target;              ///< e.g. "AVX3", "scalar"
  double seconds = 0;
  std::size_t matrix_bytes = 0;
  std::size_t estimated_bytes = 0;  ///< what was announced before the run
  double reciprocity_residual = 0;  ///< of the raw rows
  double largest_row_error = 0;     ///< max |fronts + backs + sky - 1| over non-empty rows
  bool closed = false;              ///< no hemicube has a sky pixel
  bool symmetrized = false;
  ClosureReport closure;    ///< where symmetrized
  std::vector<Note> notes;  ///< surfaces seen from behind, ...
};

/// The matrix and each row's three accounts, which sum to 1: seen fronts (the row sum), seen
/// backs, sky. N values each, 0 in the row of a degenerate patch.
struct FormFactors {
  ExchangeMatrix matrix;
  std::vector<double> fronts;
  std::vector<double> backs;
  std::vector<double> sky;
  /// Area-weighted share of the scene's view that ends on each surface's back, by surface.
  std::vector<double> backs_by_surface;
  std::string method = "hemicube";
  FormFactorReport report;
};

/// One hemicube a patch, all cores. Raw rows, as they were seen, unless `symmetrize`.
/// Errors: RunError where the estimate exceeds `memory_limit` (with the numbers).
FormFactors computeFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress);

/// Bytes computeFormFactors() will hold at once for this mesh: an estimate, made from a sample of
/// rows, printed before memory is spent.
std::size_t estimateFormFactorBytes(const PatchMesh& mesh, const FormFactorOptions& options);

}  // namespace radiosity
