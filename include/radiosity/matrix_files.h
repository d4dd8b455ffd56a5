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

struct MatrixFile {
  std::string path;
  NamedFactors factors;            ///< numbered; names are empty where the file has none
  bool has_areas = true;           ///< else they are 1
  bool has_accounts = true;        ///< else backs are 0, and sky is what rows lack of 1
  std::vector<double> emissivity;  ///< N; empty: the file has none
};

/// True for what readMatrixFile() reads besides results files, by the file's first line.
bool isMatrixFile(const std::string& path);

/// A results file (.h5) with form factors; MatrixMarket, coordinate or array, real or integer,
/// general or symmetric, with areas, accounts and names where writeMatrixMarket() put them into
/// comments; or View3D's view factors, text or binary. `areas`: N, m^2, replace the file's. Errors:
/// InputError that names file and line: what is none of these, not N x N, above N, given twice,
/// negative or not finite; View3D's script-F (emit = 1), which are no form factors; areas of
/// another number.
MatrixFile readMatrixFile(const std::string& path, Progress& progress,
                          std::span<const double> areas = {});

/// writeMatrixMarket() of results.h, with a comment line a row, "% row I area A sky S backs B name
/// NAME", that readMatrixFile() takes up and others pass over.
void writeMatrixMarket(const std::string& path, const NamedFactors& factors, Progress& progress);

/// Row sums (over surfaces) and reciprocity of one matrix.
struct MatrixAccount {
  double least_sum = 0;  ///< of rows with area
  double largest_sum = 0;
  double mean_sum = 0;                ///< by area
  std::optional<double> reciprocity;  ///< as reciprocityResidual(); none: areas are not known
};

/// How far B is from A.
struct MatrixComparison {
  double relative_l2 = 0;  ///< sqrt(sum A_i (B_ij - A_ij)^2 / sum A_i A_ij^2), A_i the areas
  bool weighted = true;    ///< false: neither file has areas, rows weigh alike
  double largest = 0;      ///< max |B_ij - A_ij|
  std::size_t row = 0;     ///< where, from 0
  std::size_t column = 0;
  double a = 0;  ///< the values there
  double b = 0;
  double area_difference = 0;  ///< largest relative one, where both have areas
  MatrixAccount account_a;
  MatrixAccount account_b;
  /// By name, in order of their share: rows of one name (of surfaces); empty without names.
  struct OfName {
    std::string name;
    std::size_t rows = 0;
    double relative_l2 = 0;  ///< within its rows
    double largest = 0;
  };
  std::vector<OfName> names;
};

/// Row for row. Areas and names are those of A, else of B. InputError for matrices of other sizes.
MatrixComparison compareMatrices(const MatrixFile& a, const MatrixFile& b, Progress& progress);

/// Reflectance and emission of rows, from a table with a header: `row` (from 1) or `name` (rows of
/// that name; * for all that no other line names), `reflectance` and `emission` (exitance, W/m^2);
/// of several bands `reflectance_1`, `reflectance_2`, ... Without reflectance it is 1 - the file's
/// emissivity. Errors: InputError that names file and line: unknown columns and names, values out
/// of range, a row given twice or not at all.
PatchMaterials readRowMaterials(const std::string& path, const MatrixFile& matrix);

/// Areas of rows, m^2: a number a line, or the column area_m2 of a table with a header. Errors: as
/// above.
std::vector<double> readAreas(const std::string& path);

/// Form factors that others made, as solve() takes them; `sky` and `backs`: N, what of a row goes
/// there. report.notes warns of rows that sum to more than 1 and, where the areas are known, of
/// pairs that are far from reciprocal: such a matrix makes or loses energy.
FormFactors factorsOfMatrix(ExchangeMatrix matrix, std::vector<double> sky,
                            std::vector<double> backs, bool has_areas = true);

/// The same of a file, with its error figures.
FormFactors factorsOfFile(const MatrixFile& file);

/// A line a row: row (from 1), name, area_m2, radiosity, irradiance and net_flux B - H, W/m^2, by
/// band.
void writeLightCsv(const std::string& path, std::span<const std::string> names,
                   std::span<const double> area, const Solution& solution);

}  // namespace radiosity
