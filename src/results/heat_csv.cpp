// Writes heat exchange as comma-separated tables (RFC 4180), for spreadsheets and other programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/csv.h"
#include "base/figure_text.h"
#include "radiosity/results.h"
#include "results/checked_file.h"

namespace radiosity {

namespace {

/// All digits of a number; empty if it is not a number.
std::string cell(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

std::string bandColumns(const char* name, int bands) {
  if (bands == 1) return fmt::format(",{}_W_per_m2", name);
  std::string columns;
  for (int b = 1; b <= bands; ++b) columns += fmt::format(",{}_{}_W_per_m2", name, b);
  return columns;
}

/// The columns that patches and rows have in common.
std::string commonColumns(int bands) {
  return fmt::format("area_m2,temperature_K,net_flux_W_per_m2,convection_W_per_m2{}{}\n",
                     bandColumns("radiosity", bands), bandColumns("irradiance", bands));
}

std::string commonCells(const HeatSolution& heat, std::size_t i, double area) {
  const auto bands = std::size_t(heat.bands);
  std::string cells = fmt::format("{},{},{},{}", areaFigure(area), cell(heat.temperature[i]),
                                  cell(heat.net_flux[i]), cell(heat.convection[i]));
  for (const std::vector<double>* values : {&heat.radiosity, &heat.irradiance}) {
    for (std::size_t b = 0; b < bands; ++b)
      cells.append(",").append(cell((*values)[i * bands + b]));
  }
  return cells.append("\n");
}

}  // namespace

void writeHeatTable(const std::string& path, std::span<const SurfaceHeat> surfaces) {
  CheckedFile file(path);
  file.write(
      "surface,area_m2,temperature_K,lowest_K,highest_K,radiosity_W_per_m2,irradiance_W_per_m2,"
      "irradiance_error_W_per_m2,net_flux_W_per_m2,radiated_W,convected_W\n");
  for (const SurfaceHeat& s : surfaces) {
    file.write(fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", csvField(s.name),
                           areaFigure(s.area), cell(s.temperature), cell(s.lowest), cell(s.highest),
                           cell(s.radiosity), cell(s.irradiance),
                           cell(s.irradiance_error.value_or(NAN)), cell(s.net_flux),
                           cell(s.radiated), cell(s.convected)));
  }
  file.commit();
}

void writeHeatPatches(const std::string& path, const HeatSolution& heat, const PatchMesh& mesh) {
  CheckedFile file(path);
  file.write("patch,surface,side,x_m,y_m,z_m," + commonColumns(heat.bands));
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Vec3& at = mesh.centroid[i];
    file.write(fmt::format("{},{},{},{},{},{},{}", i, csvField(mesh.surface_names[mesh.surface[i]]),
                           mesh.side[i] == 0 ? "front" : "back", at.x, at.y, at.z,
                           commonCells(heat, i, mesh.area[i])));
  }
  file.commit();
}

void writeRadiantTemperatures(const std::string& path, std::span<const MeasuringPoints> sets,
                              const RadiantTemperatures& temperatures) {
  CheckedFile file(path);
  std::string header = "x_m,y_m,z_m,standing_K,seated_K";
  for (const char* face : kRadiantFaceNames) header += fmt::format(",plane_{}_K", face);
  file.write(header + ",surfaces_seen,points\n");
  std::size_t row = 0;
  for (const MeasuringPoints& set : sets) {
    for (std::size_t k = 0; k < set.size(); ++k, ++row) {
      const Vec3& at = set.at[k];
      std::string line = fmt::format("{},{},{},{},{}", at.x, at.y, at.z, temperatures.standing[row],
                                     temperatures.seated[row]);
      for (std::size_t face = 0; face < kRadiantFaces; ++face) {
        line += fmt::format(",{}", temperatures.plane[row * kRadiantFaces + face]);
      }
      file.write(fmt::format("{},{},{}\n", line, temperatures.surfaces[row], csvField(set.name)));
    }
  }
  file.commit();
}

void writeHeatRows(const std::string& path, const HeatSolution& heat,
                   std::span<const std::string> names, std::span<const double> area) {
  CheckedFile file(path);
  file.write("row,name," + commonColumns(heat.bands));
  for (std::size_t i = 0; i < area.size(); ++i) {
    file.write(fmt::format("{},{},{}", i + 1, csvField(names[i]), commonCells(heat, i, area[i])));
  }
  file.commit();
}

}  // namespace radiosity
