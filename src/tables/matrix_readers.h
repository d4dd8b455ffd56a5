// Readers of matrices, a format a file.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "radiosity/matrix_files.h"

namespace radiosity {

/// Accounts of a file that has none: sky is what rows lack of 1.
void setDefaultAccounts(NamedFactors& factors);

/// `area`: N, or empty for those of the file. InputError for another number.
std::vector<double> chosenAreas(const std::string& path, std::span<const double> area,
                                std::vector<double> of_file);

inline constexpr std::string_view kMatrixMarketMark = "%%MatrixMarket";
MatrixFile readMatrixMarket(const std::string& path, std::span<const double> area,
                            Progress& progress);

/// "View3D 3.3.1 0 1 0 6", or the same by another program.
struct View3dHeader {
  int format = 0;  ///< 0 text, 1 binary
  bool enclosure = false;
  bool script = false;  ///< with emittances: script-F
  std::size_t rows = 0;
};
std::optional<View3dHeader> parseView3dHeader(std::string_view line);
MatrixFile readView3d(const std::string& path, std::span<const double> area);

}  // namespace radiosity
