// Light by row as comma-separated values.
#include <fmt/format.h>

#include <iterator>

#include "base/csv.h"
#include "base/figure_text.h"
#include "radiosity/matrix_files.h"
#include "results/checked_file.h"

namespace radiosity {

void writeLightCsv(const std::string& path, std::span<const std::string> names,
                   std::span<const double> area, const Solution& solution) {
  const auto bands = std::size_t(solution.bands);
  CheckedFile file(path);
  std::string header = "row,name,area_m2";
  for (const char* quantity : {"radiosity", "irradiance", "net_flux"}) {
    for (std::size_t b = 0; b < bands; ++b) {
      header += bands == 1 ? fmt::format(",{}", quantity) : fmt::format(",{}_{}", quantity, b + 1);
    }
  }
  file.write(header + "\n");
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
    fmt::format_to(out, "\n");
    file.write(line.data(), line.size());
  }
  file.commit();
}

}  // namespace radiosity
