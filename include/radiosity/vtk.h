// Patches with their quantities, for ParaView and other readers of VTK's files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"
#include "radiosity/heat.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/solve.h"

namespace [[gnu::visibility("default")]] radiosity {

/// A quantity of every patch, under the name that readers show.
struct CellField {
  std::string name;            ///< "net_flux"
  std::string unit;            ///< "W/m^2"; empty: a pure number
  int components = 1;          ///< 1 or more: bands
  std::vector<double> values;  ///< N * components, row-major
};

/// reflectance, and emission (exitance, W/m^2), by band.
std::vector<CellField> materialFields(const PatchMaterials& materials);

/// row_sum, backs and sky, the three accounts of a row; and error, its figure, if the method has
/// one.
std::vector<CellField> factorFields(const FormFactors& factors);

/// By band, W/m^2: radiosity B, irradiance H, and net_flux, the flux given off in excess of the
/// flux absorbed, q = B - H = E - (1 - rho) H: above 0 for a lamp, below 0 for an absorbing
/// surface. `photometric`: beside them illuminance, lx, and luminance, cd/m^2, of bands that have
/// them (light.h).
std::vector<CellField> lightFields(const Solution& solution, bool photometric = false);

/// temperature, K; radiosity J and irradiance H by band, net_flux and convection, W/m^2.
std::vector<CellField> heatFields(const HeatSolution& heat);

/// VTK's XML PolyData (.vtp): polygon k is patch k, backs too (the front's corners in reverse);
/// points in metres, 64 bits. Cell data: patch (its number, from 0), surface (its name), surface_id
/// (into the field data surface_names), side (0 front, 1 back), area (m^2), then `fields`,
/// each with its unit. Errors: InputError for a field of another size, without components, or with
/// a name that exists already; as CheckedFile.
void writeVtp(const std::string& path, const PatchMesh& mesh, std::span<const CellField> fields);

}  // namespace radiosity
