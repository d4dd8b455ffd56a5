// Form factors between named surfaces, and the files that people and other programs take them from.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Surfaces under fewer names. Patches and form factors know nothing of it: only tables do.
struct SurfaceGroups {
  std::vector<std::string> names;  ///< G: the groups in the order given, then surfaces of none
  std::vector<Index> of_surface;   ///< into names, by surface
  std::vector<Note> notes;         ///< surfaces that more than one group asks for
};

/// Each of `groups` is "NAME=PATTERN". PATTERN is the name of a surface ("object/material") or a
/// pattern of the shell: * any text (slashes too), ? a character, [abc] one of some. A surface goes
/// to the first group that matches it; a NAME given again adds to its group; what no group asks for
/// is under its own name. Errors: InputError naming the option for a text that is none of this, a
/// pattern that matches nothing (with the names there are), a group left without a surface, and a
/// group that has the name of a surface outside it.
SurfaceGroups groupSurfaces(std::span<const std::string> surfaces,
                            std::span<const std::string> groups = {});

/// Form factors with a name for each row: between groups of surfaces, or between patches.
struct NamedFactors {
  std::vector<std::string> names;  ///< N; where `numbered` those of the surfaces, not unique
  /// Rows are unknowns and go by their number from 0: patches, or the clusters that share unknowns.
  bool numbered = false;
  std::shared_ptr<const ExchangeMatrix> matrix;  ///< N x N, F[a, b] from a to b, and the areas
  std::vector<double> sky;                       ///< N, what of a row goes to the sky
  std::vector<double> backs;                     ///< N, what goes to black backs
  /// N error figures, as FormFactors::error, of the row from a to the single unknowns: its 2-norm
  /// is below the mean of the unknowns' figures by area (Minkowski's inequality), in as many rows
  /// as theirs hold. Empty: the method has none.
  std::vector<double> error;
  std::vector<std::size_t> members;  ///< N, how many unknowns a row stands for
  std::vector<Index> row_of;         ///< the row of each unknown
  bool closed = false;               ///< no patch sees the sky
  std::string sky_name = "sky";      ///< of the receiver that is no surface

  std::size_t size() const { return names.size(); }
  /// How far off F[a, b] may be: at most sqrt(members[b]) times the figure of row a
  /// (Cauchy-Schwarz), and, where A_a F_ab = A_b F_ba is stored once, what the same says of
  /// F[b, a]. NaN where there are no figures.
  double entryError(std::size_t a, std::size_t b) const;
  /// |A_a F_ab - A_b F_ba|, m^2; 0 by construction in a symmetric matrix.
  double reciprocityResidual(std::size_t a, std::size_t b) const;
};

/// F[a, b] = sum over i in a, j in b of A_i F_ij / A_a, in double precision; sky and backs are
/// means by area. A two-sided surface has both sides in one row. Patches that share unknowns are of
/// one surface, so that clusters are grouped as patches are. One pass over the matrix, wherever it
/// is. A group without area has a row of zeros. Errors: InputError where `groups` is of another
/// number of surfaces; Cancelled.
NamedFactors factorsBetween(const PatchMesh& mesh, const FormFactors& factors,
                            const SurfaceGroups& groups, Progress& progress);

/// The rows of the matrix as they are, which must outlive the result.
NamedFactors factorsOfUnknowns(const PatchMesh& mesh, const FormFactors& factors);

/// Of each row of `factors`: 1 - reflectance, the mean over its area and all bands.
std::vector<double> emissivities(const NamedFactors& factors, const PatchMesh& mesh,
                                 const PatchMaterials& materials);

enum class TableLayout {
  wide,  ///< a row a surface, a column a receiver
  tall   ///< a row a pair; of numbered rows those that are not 0
};

// Each writes its file whole or not at all, numbers in the fewest digits that read back alike.
// Errors: InputError where a receiver has another one's name (the sky's, "backs"), of numbered rows
// where what is written has N^2 values and they are above kMostTableValues; as CheckedFile;
// Cancelled.

inline constexpr std::size_t kMostTableValues = 100'000'000;

// What the writers below refuse in the names and the number of rows, before there are form factors:
// InputError. Of `rows` count names, numbered and sky_name.

/// Of .csv, .json and .md.
void checkTableRows(const std::string& path, const NamedFactors& rows, TableLayout layout);
void checkEnergyPlusRows(const std::string& path, const NamedFactors& rows,
                         const std::string& zone);
void checkView3dRows(const std::string& path, const NamedFactors& rows);

/// Comma-separated (RFC 4180), with a header. Wide: name, area_m2, a column a receiver, the sky's,
/// backs, sum (of these; 1 but for the errors), error (of the row), reciprocity_m2 (the row's
/// largest residual). Tall: from, to, form_factor, error, reciprocity_m2. Where there are no error
/// figures, no columns of them.
void writeFactorsCsv(const std::string& path, const NamedFactors& factors, TableLayout layout,
                     Progress& progress);
/// The same as one object: names, area_m2, error, sky_name and, wide, form_factors (N x N), sky,
/// backs, entry_error, reciprocity_m2 (N x N); tall, a list `pairs`.
void writeFactorsJson(const std::string& path, const NamedFactors& factors, TableLayout layout,
                      Progress& progress);
/// A table in Markdown, `digits` significant ones. `most`: of the rows; a line says what is left.
std::string factorsMarkdown(const NamedFactors& factors, TableLayout layout, int digits = 6,
                            std::size_t most = std::size_t(-1));
void writeFactorsMarkdown(const std::string& path, const NamedFactors& factors, TableLayout layout);

/// The object ZoneProperty:UserViewFactors:BySurfaceName of an EnergyPlus input file: N^2 entries
/// from, to, F in twelve digits, at most 1 (its dictionary's limit). Names are surfaces' there:
/// without commas, semicolons, exclamation marks and line breaks, at most 100 characters, different
/// also in one case, else InputError. What goes to sky and backs has no place in it: EnergyPlus
/// takes a zone to be closed. `zone`: a Zone, ZoneList or enclosure.
void writeEnergyPlus(const std::string& path, const NamedFactors& factors, const std::string& zone,
                     Progress& progress);

/// The file of view factors that View3D writes as text (out = 0) and its companions read: a line
/// "program version 0 encl 0 N", areas, N rows of F, emissivities. encl is 1 where the scene is
/// closed. InputError for a row without area, by which readers divide.
void writeView3d(const std::string& path, const NamedFactors& factors,
                 std::span<const double> emissivity, Progress& progress);

/// A line an entry that is not 0: i, j and F[i, j], numbered from 0; j = N is the sky, j = N + 1
/// are black backs. Comment lines, with #, say so and name the rows.
void writeTriplets(const std::string& path, const NamedFactors& factors, Progress& progress);
/// The same in plain HDF5: row and column (int32), form_factor (f64); area, sky, backs and error
/// (N each); names. Nothing beyond N: sky and backs are on their own.
void writeTripletsHdf5(const std::string& path, const NamedFactors& factors, Progress& progress);

}  // namespace radiosity
