#include "radiosity/light.h"
#include "radiosity/vtk.h"

namespace radiosity {

std::vector<CellField> materialFields(const PatchMaterials& materials) {
  return {{"reflectance", "", materials.bands, materials.reflectance},
          {"emission", "W/m^2", materials.bands, materials.emission}};
}

std::vector<CellField> factorFields(const FormFactors& factors) {
  std::vector<CellField> fields{{"row_sum", "", 1, factors.fronts},
                                {"backs", "", 1, factors.backs},
                                {"sky", "", 1, factors.sky}};
  if (!factors.error.empty()) fields.push_back({"error", "", 1, factors.error});
  return fields;
}

std::vector<CellField> lightFields(const Solution& solution, bool photometric) {
  std::vector<double> net(solution.radiosity.size());
  for (std::size_t k = 0; k < net.size(); ++k) {
    net[k] = solution.radiosity[k] - solution.irradiance[k];
  }
  std::vector<CellField> fields = {{"radiosity", "W/m^2", solution.bands, solution.radiosity},
                                   {"irradiance", "W/m^2", solution.bands, solution.irradiance},
                                   {"net_flux", "W/m^2", solution.bands, std::move(net)}};
  if (photometric && isPhotometric(solution.bands)) {
    PhotometricRows rows = photometricRows(solution);
    fields.push_back({"illuminance", "lx", 1, std::move(rows.illuminance)});
    fields.push_back({"luminance", "cd/m^2", 1, std::move(rows.luminance)});
  }
  return fields;
}

std::vector<CellField> heatFields(const HeatSolution& heat) {
  return {{"temperature", "K", 1, heat.temperature},
          {"radiosity", "W/m^2", heat.bands, heat.radiosity},
          {"irradiance", "W/m^2", heat.bands, heat.irradiance},
          {"net_flux", "W/m^2", 1, heat.net_flux},
          {"convection", "W/m^2", 1, heat.convection}};
}

}  // namespace radiosity
