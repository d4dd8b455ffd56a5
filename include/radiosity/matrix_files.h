// Form-factor matrices in files of this and other programs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/solve.h"
#include "radiosity/tables.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Rows that sum to more than this would send out more light than there is.
inline constexpr double kMostRowSum = 1 + 1e-4;

struct MatrixFile {
  std::string path;
  NamedFactors factors;            ///< numbered; names are empty if the file has none
  bool has_areas = true;           ///< else areas are 1
  bool has_accounts = true;        ///< else backs are 0, and sky is 1 - the row sum
  std::vector<double> emissivity;  ///< N; empty: the file has none
};

/// True if readMatrixFile() reads the file and it is no results file; its first line decides.
bool isMatrixFile(const std::string& path);

/// Reads a results file (.h5) with form factors; MatrixMarket, coordinate or array, real or
/// integer, general or symmetric, with areas, accounts and names if writeMatrixMarket() put them
/// into comments; or View3D's view factors, text or binary. `areas`: N, m^2, replace the file's.
/// Errors: InputError that names file and line, for other files, a matrix that is not N x N, an
/// entry beyond N, given twice, negative or not finite, View3D's script-F (emit = 1), which are no
/// form factors, and another number of areas.
MatrixFile readMatrixFile(const std::string& path, Progress& progress,
                          std::span<const double> areas = {});

/// As writeMatrixMarket() of results.h, with a comment line per row, "% row I area A sky S backs B
/// name NAME", which readMatrixFile() reads and other programs skip.
void writeMatrixMarket(const std::string& path, const NamedFactors& factors, Progress& progress);

/// Row sums (over surfaces) and reciprocity of one matrix.
struct MatrixAccount {
  double least_sum = 0;  ///< of rows with area
  double largest_sum = 0;
  double mean_sum = 0;                ///< by area
  std::optional<double> reciprocity;  ///< as reciprocityResidual(); none: areas are not known
};

/// The difference of B from A.
struct MatrixComparison {
  double relative_l2 = 0;  ///< sqrt(sum A_i (B_ij - A_ij)^2 / sum A_i A_ij^2), A_i the areas
  bool weighted = true;    ///< false: neither file has areas, rows weigh alike
  double largest = 0;      ///< max |B_ij - A_ij|
  std::size_t row = 0;     ///< its place, from 0
  std::size_t column = 0;
  double a = 0;  ///< the values there
  double b = 0;
  double area_difference = 0;              ///< largest relative one, if both have areas
  std::optional<std::size_t> renamed_row;  ///< the first, from 0, whose names differ
  MatrixAccount account_a;
  MatrixAccount account_b;
  /// The rows of each name (of surfaces), in order of their share; empty without names.
  struct OfName {
    std::string name;
    std::size_t rows = 0;
    double relative_l2 = 0;  ///< within its rows
    double largest = 0;
  };
  std::vector<OfName> names;
};

/// Compares row by row. Areas and names are those of A, else of B. InputError if the sizes differ.
MatrixComparison compareMatrices(const MatrixFile& a, const MatrixFile& b, Progress& progress);

/// Reflectance and emission of rows, from a table with a header: `row` (from 1) or `name` (rows of
/// that name), * for all rows that no other line names, `reflectance` and `emission` (exitance,
/// W/m^2); for several bands `reflectance_1`, `reflectance_2`, ... Without reflectance it is 1 -
/// the file's emissivity. Errors: InputError that names file and line: unknown columns and names,
/// values out of range, a row given twice or not at all.
PatchMaterials readRowMaterials(const std::string& path, const MatrixFile& matrix);

/// Areas of rows, m^2: a number a line, or the column area_m2 of a table with a header, by its
/// column `row` (from 1) if it has one, else in order. Errors: as above.
std::vector<double> readAreas(const std::string& path);

/// Form factors from elsewhere, as solve() takes them; `sky` and `backs`: N, the share of each row
/// that goes there. report.notes warns of rows that sum to more than 1 and, if the areas are known,
/// of pairs that are far from reciprocal: such a matrix makes or loses energy.
FormFactors factorsOfMatrix(std::shared_ptr<const ExchangeMatrix> matrix, std::vector<double> sky,
                            std::vector<double> backs, bool has_areas = true);

/// The same of a file, with its error figures.
FormFactors factorsOfFile(const MatrixFile& file);

/// Writes a line per row: row (from 1), name, area_m2, radiosity, irradiance and net_flux B - H by
/// band ("radiosity_1_W_per_m2"). `photometric`: then illuminance_lx and luminance_cd_per_m2, of
/// bands that have them (light.h).
void writeLightCsv(const std::string& path, std::span<const std::string> names,
                   std::span<const double> area, const Solution& solution,
                   bool photometric = false);

}  // namespace radiosity
