// Light by row as comma-separated values.
#include <fmt/format.h>

#include <iterator>

#include "base/csv.h"
#include "base/figure_text.h"
#include "radiosity/light.h"
#include "radiosity/matrix_files.h"
#include "results/checked_file.h"

namespace radiosity {

namespace {

std::string lightColumns(int bands, bool photometric) {
  std::string columns;
  for (const char* quantity : {"radiosity", "irradiance", "net_flux"}) {
    for (int b = 1; b <= bands; ++b) {
      columns += bands == 1 ? fmt::format(",{}_W_per_m2", quantity)
                            : fmt::format(",{}_{}_W_per_m2", quantity, b);
    }
  }
  return columns + (photometric ? ",illuminance_lx,luminance_cd_per_m2" : "");
}

}  // namespace

void writeLightCsv(const std::string& path, std::span<const std::string> names,
                   std::span<const double> area, const Solution& solution, bool photometric) {
  const auto bands = std::size_t(solution.bands);
  const bool lux = photometric && isPhotometric(solution.bands);
  const PhotometricRows of_rows = lux ? photometricRows(solution) : PhotometricRows();
  CheckedFile file(path);
  file.write("row,name,area_m2" + lightColumns(solution.bands, lux) + "\n");
  for (std::size_t i = 0; i < names.size(); ++i) {
    fmt::memory_buffer line;
    const auto out = std::back_inserter(line);
    fmt::format_to(out, "{},{},{}", i + 1, csvField(names[i]), areaFigure(area[i]));
    const double* radiosity = &solution.radiosity[i * bands];
    const double* irradiance = &solution.irradiance[i * bands];
    for (std::size_t b = 0; b < bands; ++b) fmt::format_to(out, ",{}", radiosity[b]);
    for (std::size_t b = 0; b < bands; ++b) fmt::format_to(out, ",{}", irradiance[b]);
    for (std::size_t b = 0; b < bands; ++b) {
      fmt::format_to(out, ",{}", radiosity[b] - irradiance[b]);
    }
    if (lux) fmt::format_to(out, ",{},{}", of_rows.illuminance[i], of_rows.luminance[i]);
    fmt::format_to(out, "\n");
    file.write(line.data(), line.size());
  }
  file.commit();
}

}  // namespace radiosity
