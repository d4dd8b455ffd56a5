// Writes light at points as a comma-separated table (RFC 4180).
#include <fmt/format.h>

#include "base/csv.h"
#include "radiosity/results.h"
#include "results/checked_file.h"

namespace radiosity {

namespace {

constexpr std::array kCube = {Measured::x_plus,  Measured::x_minus, Measured::y_plus,
                              Measured::y_minus, Measured::z_plus,  Measured::z_minus};

std::string illuminanceHeader(const PointLightValues& light) {
  std::string header = "x_m,y_m,z_m,nx,ny,nz,illuminance_lx,direct_lx,indirect_lx,cylindrical_lx";
  for (const Measured face : kCube) header += fmt::format(",facing_{}_lx", axisOf(face));
  for (const Measured side : uprightSides(light.up)) {
    header += fmt::format(",semicylindrical_{}_lx", axisOf(side));
  }
  for (const char* of : {"irradiance", "direct", "indirect"}) {
    for (int b = 1; b <= light.bands; ++b) {
      header += light.bands == 1 ? fmt::format(",{}_W_per_m2", of)
                                 : fmt::format(",{}_{}_W_per_m2", of, b);
    }
  }
  if (light.open_lux > 0) header += ",daylight_factor_percent";
  return header + ",standard_error,in_body,points\n";
}

std::string illuminanceCells(const PointLightValues& light, std::size_t k) {
  using enum Measured;
  std::string cells = fmt::format(",{},{},{},{}", light.lux(k, facing), light.directLux(k, facing),
                                  light.indirectLux(k, facing), light.lux(k, cylinder));
  for (const Measured face : kCube) cells += fmt::format(",{}", light.lux(k, face));
  for (const Measured side : uprightSides(light.up)) {
    cells += fmt::format(",{}", light.semicylindricalLux(k, side));
  }
  const std::span<const double> direct = light.directOf(k, facing);
  const std::span<const double> indirect = light.indirectOf(k, facing);
  for (std::size_t b = 0; b < direct.size(); ++b) {
    cells += fmt::format(",{}", direct[b] + indirect[b]);
  }
  for (const std::span<const double>& part : {direct, indirect}) {
    for (const double value : part) cells += fmt::format(",{}", value);
  }
  if (light.open_lux > 0) cells += fmt::format(",{}", light.daylightFactor(k));
  return cells + fmt::format(",{},{}", light.error[k], int(light.inside[k]));
}

}  // namespace

void writeIlluminance(const std::string& path, std::span<const MeasuringPoints> sets,
                      const PointLightValues& light) {
  CheckedFile file(path);
  file.write(illuminanceHeader(light));
  std::size_t first = 0;
  for (const MeasuringPoints& set : sets) {
    for (std::size_t k = 0; k < set.size(); ++k) {
      const Vec3& at = set.at[k];
      const Vec3& n = set.normal[k];
      file.write(fmt::format("{},{},{},{},{},{}{},{}\n", at.x, at.y, at.z, n.x, n.y, n.z,
                             illuminanceCells(light, first + k), csvField(set.name)));
    }
    first += set.size();
  }
  file.commit();
}

}  // namespace radiosity
