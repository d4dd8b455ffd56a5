// Readers of matrix files, one for each format.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "radiosity/matrix_files.h"

namespace radiosity {

/// Sets the accounts for a file without them: the sky gets 1 minus the row sum.
void setDefaultAccounts(NamedFactors& factors);

/// Returns `area` (N values), or those of the file if `area` is empty. Errors: InputError for
/// another number.
std::vector<double> chosenAreas(const std::string& path, std::span<const double> area,
                                std::vector<double> of_file);

inline constexpr std::string_view kMatrixMarketMark = "%%MatrixMarket";
MatrixFile readMatrixMarket(const std::string& path, std::span<const double> area,
                            Progress& progress);

/// The header line "View3D 3.3.1 0 1 0 6", or that of another program.
struct View3dHeader {
  int format = 0;  ///< 0 text, 1 binary
  bool enclosure = false;
  bool script = false;  ///< with emittances: script-F
  std::size_t rows = 0;
};
std::optional<View3dHeader> parseView3dHeader(std::string_view line);
MatrixFile readView3d(const std::string& path, std::span<const double> area);

}  // namespace radiosity
