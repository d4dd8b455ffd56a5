// Form factors between named surfaces, and their files for people and other programs.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/names.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/surface_groups.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Form factors with a name for each row: between groups of surfaces, or between patches.
struct NamedFactors {
  std::vector<std::string> names;  ///< N; if `numbered`, those of the surfaces, not unique
  /// Rows are patches and go by their number from 0.
  bool numbered = false;
  std::shared_ptr<const ExchangeMatrix> matrix;  ///< N x N, F[a, b] from a to b, and the areas
  std::vector<double> sky;                       ///< N, the share of a row that goes to the sky
  std::vector<double> backs;                     ///< N, the share that goes to black backs
  /// N error figures, as FormFactors::error, of the row from a to the single patches: its 2-norm
  /// is below the mean of the patches' figures by area (Minkowski's inequality), in as many rows
  /// as theirs. Empty: the method has none.
  std::vector<double> error;
  std::vector<std::size_t> members;  ///< N, the number of patches of a row
  std::vector<Index> row_of;         ///< the row of each patch
  bool closed = false;               ///< no patch sees the sky
  std::string sky_name = "sky";      ///< of the receiver that is no surface

  std::size_t size() const { return names.size(); }
  /// A limit of the error of F[a, b]: sqrt(members[b]) times the figure of row a (Cauchy-Schwarz);
  /// if A_a F_ab = A_b F_ba is stored once, the smaller of it and the limit from F[b, a]. NaN
  /// without figures.
  double entryError(std::size_t a, std::size_t b) const;
  /// |A_a F_ab - A_b F_ba|, m^2; 0 by construction in a symmetric matrix.
  double reciprocityResidual(std::size_t a, std::size_t b) const;
};

/// F[a, b] = sum over i in a, j in b of A_i F_ij / A_a, in double precision; sky and backs are
/// means by area. A two-sided surface has both sides in one row. Takes one pass over the matrix,
/// wherever it is. A group without area has a row of zeros. Errors: InputError if `groups` has
/// another number of surfaces; Cancelled.
NamedFactors factorsBetween(const PatchMesh& mesh, const FormFactors& factors,
                            const SurfaceGroups& groups, Progress& progress);

/// The same between about `count` nodes, clusters of patches of one surface and side that are near
/// each other and face alike (mesh/clusters), of at least one a surface; patches if there are no
/// more. Named "SURFACE", or "SURFACE 1", "SURFACE 2", ... in the order of its first patches, with
/// " back" at the end for the back of a two-sided surface. Throws Cancelled.
NamedFactors factorsBetweenNodes(const PatchMesh& mesh, const FormFactors& factors,
                                 std::size_t count, Progress& progress);

/// The rows of the matrix as they are. Errors: as pairsOf().
NamedFactors factorsOfPatches(const PatchMesh& mesh, const FormFactors& factors);

/// Of each row of `factors`: 1 - reflectance, the mean over its area and all bands.
std::vector<double> emissivities(const NamedFactors& factors, const PatchMesh& mesh,
                                 const PatchMaterials& materials);

enum class TableLayout {
  wide,      ///< a row a surface, a column a receiver
  long_rows  ///< a row a pair; with numbered rows only pairs that are not 0
};
inline constexpr NameTable<TableLayout, 2> kTableLayoutNames{
    {{TableLayout::wide, "wide"}, {TableLayout::long_rows, "long"}}};

// Each writes its file whole or not at all, with numbers in the fewest digits that read back alike.
// Errors: InputError if a receiver has another one's name (the sky's, "backs"), or if numbered rows
// would write N^2 values, more than kMostTableValues; as CheckedFile; Cancelled.

inline constexpr std::size_t kMostTableValues = 100'000'000;

// Check the names and the number of rows for the writers below, before there are form factors:
// InputError. Only names, numbered and sky_name of `rows` matter.

/// For .csv, .json and .md.
void checkTableRows(const std::string& path, const NamedFactors& rows, TableLayout layout);
void checkEnergyPlusRows(const std::string& path, const NamedFactors& rows,
                         const std::string& zone);
void checkView3dRows(const std::string& path, const NamedFactors& rows);

/// Comma-separated (RFC 4180), with a header. Wide: name, area_m2, a column a receiver, the sky's,
/// backs, sum (of these; 1 except for errors), error (of the row), reciprocity_m2 (the row's
/// largest residual). Long: from, to, area_m2, form_factor, error, reciprocity_m2. Without error
/// figures their columns are left out.
void writeFactorsCsv(const std::string& path, const NamedFactors& factors, TableLayout layout,
                     Progress& progress);
/// The same as one object: names, area_m2, error, sky_name and, wide, form_factors (N x N), sky,
/// backs, entry_error, reciprocity_m2 (N x N); long, a list `pairs`.
void writeFactorsJson(const std::string& path, const NamedFactors& factors, TableLayout layout,
                      Progress& progress);
/// A Markdown table, `digits` significant digits, at most `most` rows; a line counts the rest.
std::string factorsMarkdown(const NamedFactors& factors, TableLayout layout, int digits = 6,
                            std::size_t most = std::size_t(-1));
void writeFactorsMarkdown(const std::string& path, const NamedFactors& factors, TableLayout layout);

/// The object ZoneProperty:UserViewFactors:BySurfaceName of an EnergyPlus input file: N^2 entries
/// from, to, F in twelve digits, at most 1 (its dictionary's limit). Names are those of its
/// surfaces: without commas, semicolons, exclamation marks and line breaks, at most 100 characters,
/// different even without case, else InputError. Sky and backs are left out: EnergyPlus takes a
/// zone to be closed. `zone`: a Zone, ZoneList or enclosure.
void writeEnergyPlus(const std::string& path, const NamedFactors& factors, const std::string& zone,
                     Progress& progress);

/// The file of view factors that View3D writes as text (out = 0) and its companions read: a line
/// "program version 0 encl 0 N", areas, N rows of F, emissivities. encl is 1 if the scene is
/// closed. InputError for a row without area, by which readers divide.
void writeView3d(const std::string& path, const NamedFactors& factors,
                 std::span<const double> emissivity, Progress& progress);

/// Writes a line per entry that is not 0: i, j and F[i, j], numbered from 0; j = N is the sky,
/// j = N + 1 are black backs. Comment lines, with #, say so and name the rows.
void writeTriplets(const std::string& path, const NamedFactors& factors, Progress& progress);
/// The same in plain HDF5: row and column (int32), form_factor (f64); area, sky, backs and error (N
/// each); names. Columns end at N: sky and backs are on their own.
void writeTripletsHdf5(const std::string& path, const NamedFactors& factors, Progress& progress);

}  // namespace radiosity
