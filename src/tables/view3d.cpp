// The view factor file of View3D (G. N. Walton; View3D User Manual 3.3, "View Factor Output File").
#include <fmt/format.h>

#include <iterator>

#include "radiosity/spelling.h"
#include "radiosity/version.h"
#include "results/checked_file.h"
#include "tables/table_rows.h"

namespace radiosity {

namespace {

std::string lineOf(std::span<const double> values) {
  return fmt::format("{}\n", fmt::join(values.begin(), values.end(), " "));
}

void requireAreas(const std::string& path, const NamedFactors& factors) {
  for (std::size_t a = 0; a < factors.size(); ++a) {
    if (factors.matrix->area()[a] > 0) continue;
    throw InputError(fmt::format(
        "{}: {} {} has no area, by which View3D's readers divide; join it with another ({})", path,
        factors.numbered ? "patch" : "surface", labelOf(factors, a), spelled("groups")));
  }
}

}  // namespace

void writeView3d(const std::string& path, const NamedFactors& factors,
                 std::span<const double> emissivity, Progress& progress) {
  requireAreas(path, factors);
  checkView3dRows(path, factors);
  if (emissivity.size() != factors.size()) {
    throw InputError(fmt::format("{}: {} emissivities are given for {} rows", path,
                                 emissivity.size(), factors.size()));
  }
  CheckedFile file(path);
  // Readers expect a line of 31 characters.
  file.write(fmt::format("{:<30}\n", fmt::format("radiosity {} 0 {} 0 {}", RADIOSITY_VERSION,
                                                 factors.closed ? 1 : 0, factors.size())));
  file.write(lineOf(factors.matrix->area()));
  forDenseRows(factors, "writing the table", progress,
               [&](std::size_t, const std::vector<double>& row) { file.write(lineOf(row)); });
  file.write(lineOf(emissivity));
  file.commit();
}

}  // namespace radiosity
