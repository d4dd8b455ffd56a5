// Radiative heat exchange on the same matrix: temperatures and net fluxes of grey or banded diffuse
// surfaces whose temperature, net flux or convection is given.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// 2 pi^5 k^4 / (15 h^3 c^2), W/m^2/K^4, from the exact constants of the SI (CODATA 2018).
inline constexpr double kStefanBoltzmann = 5.67037441918443e-8;

/// The share of a blackbody's exitance at `temperature` K that has wavelengths below `wavelength`
/// micrometres; 0 for a product of 0 (Chang & Rhee, Int. Comm. Heat Mass Transfer 11, 1984).
double blackbodyFraction(double wavelength, double temperature);

/// Hemispherical emissivity, 0 to 1: constant, or a table against temperature, linear in between.
struct Emissivity {
  std::vector<double> temperatures;  ///< K, increasing; empty: constant
  std::vector<double> values;        ///< one a temperature; one where constant
  /// Beyond the table: its end.
  double at(double temperature) const;
};

/// What is known of a surface, or of several that are heated together. One of temperature, flux and
/// power at most; with none of them the net flux is 0, which is adiabatic where nothing convects.
struct HeatCondition {
  std::string name;                    ///< for messages
  std::vector<Emissivity> emissivity;  ///< one a band, or one for all
  std::optional<double> temperature;   ///< K, >= 0
  /// W/m^2: the heat supplied to the surface, which it gives off by radiation and convection; below
  /// 0 where it is cooled. Both sides of a two-sided surface count.
  std::optional<double> flux;
  std::optional<double> power;  ///< W of all patches with this condition, spread by area
  double convection = 0;        ///< W/m^2/K, >= 0: to air of the temperature `ambient`
  double ambient = 0;           ///< K, >= 0
  bool isothermal = false;      ///< flux and power: one temperature for all of its patches
};

/// Bands of wavelengths, which emit by themselves and together: 1 unless one of the two is given.
struct HeatBands {
  /// Micrometres, increasing: band 0 is below the first, the last one above the last.
  std::vector<double> edges;
  /// The share of sigma T^4 in each band at any temperature, >= 0; they sum to 1.
  std::vector<double> fractions;

  int count() const;
  void validate() const;  ///< Throws InputError.
};

struct HeatOptions {
  HeatBands bands;
  double sky_temperature = 0;  ///< K, black, wherever a row leaves the scene
  /// Stop when no radiosity and no heat balance is off by more than this times the largest
  /// radiosity. Between 0 and 1.
  double tolerance = 1e-9;
  int max_iterations = 100;         ///< of Newton's method, 1 or more
  double sigma = kStefanBoltzmann;  ///< W/m^2/K^4, for comparison with others' figures
  void validate() const;            ///< Throws InputError naming the option and its range.
};

enum class HeatStatus {
  converged,      ///< both residuals are within the tolerance; usable
  no_convergence  ///< the iteration limit came first; not usable as it is
};

/// Where the heat goes, W. radiated = to_sky + on_backs + imbalance.
struct HeatBalance {
  double radiated = 0;    ///< sum of A (J - H) over all patches
  double to_sky = 0;      ///< net, less what the sky sends
  double on_backs = 0;    ///< falls on backs that carry no patches: black, at 0 K
  double imbalance = 0;   ///< of rows that do not sum to 1, missing reciprocity and the residual
  double convected = 0;   ///< sum of A h (T - ambient)
  double throughput = 0;  ///< sum of the net powers above 0
};

struct HeatSummary {
  HeatStatus status = HeatStatus::no_convergence;
  int iterations = 0;            ///< of Newton's method; 1 where the problem is linear in T^4
  std::size_t linear_steps = 0;  ///< products with the matrix in them; 0: solved directly
  /// max |eps E(T) + (1 - eps) H - J| over max J, true: H = F J + sky was multiplied anew.
  double residual = 0;
  double balance_residual = 0;  ///< max |heat supplied - given off| per area, over max J
  /// Patches without a temperature: emissivity 0 and no convection, so any would do.
  std::size_t undetermined = 0;
  HeatBalance balance;
  double seconds = 0;
  std::string message;  ///< plain words, with numbers; says whether the result is usable
  bool usable() const { return status == HeatStatus::converged; }
};

/// Conditions as a person wrote them.
struct ConditionText {
  std::string origin;                 ///< the file that the table is from, for messages
  std::string table;                  ///< comma-separated, as src/heat/README.md says; empty: none
  std::vector<std::string> settings;  ///< "NAME.PROPERTY=VALUE", which replace cells of the table
  bool empty() const { return table.empty() && settings.empty(); }
};

/// N patches, or rows of the matrix.
struct HeatSolution {
  int bands = 1;
  std::vector<double> radiosity;   ///< J, N * bands, row-major, W/m^2
  std::vector<double> irradiance;  ///< H, N * bands, W/m^2
  std::vector<double> net_flux;  ///< N, W/m^2: sum over bands of J - H; above 0: it gives off heat
  std::vector<double> convection;   ///< N, W/m^2: h (T - ambient), given off to the air
  std::vector<double> temperature;  ///< N, K; NaN where undetermined
  HeatSummary summary;
  ConditionText conditions{};  ///< what it was solved for, where that came as text
};

/// What is known of the rows of a matrix.
struct HeatRows {
  std::span<const HeatCondition> conditions;
  std::span<const Index> of_row;  ///< N, into conditions
  /// N, the row of the other side of the same sheet, or kNone; or empty. Both sides have one
  /// temperature where flux or power is given.
  std::span<const Index> twin;
};

/// Solves J = eps E(T) + (1 - eps) H, H = F J + F_sky E(T_sky) in every band, with T as given or
/// such that the heat supplied to each patch (to each sheet, each isothermal surface) is what it
/// radiates and convects. Equations and conventions: src/heat/README.md. Errors: InputError for
/// values out of range; for closed rooms in which nothing fixes the level of temperatures; where
/// more heat is taken out than there is; where a temperature leaves its table of emissivity; each
/// names the condition. Throws Cancelled. Not converging is data.
HeatSolution solveHeat(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
                       Progress& progress);

/// Conditions of a scene's surfaces, or of the rows of a matrix.
struct HeatConditions {
  std::vector<HeatCondition> conditions;
  std::vector<Index> of_surface;  ///< into conditions; S as PatchMesh::surface_names, or N rows
  ConditionText text{};           ///< what they were read from; or empty
};

/// The table at `csv_path` (empty: none) and the settings. Errors: as readWholeFile(), and
/// InputError where there is neither.
ConditionText readConditionText(const std::string& csv_path, std::span<const std::string> settings);

/// Conditions by name, as SceneOptions::set finds surfaces, or by a pattern of names: * any text,
/// ? a character, [abc] one of some. What is said by name goes before what a pattern says of the
/// same surface, settings go before the table, and the name * holds for whatever others leave out.
/// Errors: InputError, one line with file, line and cure; also for a surface without a condition.
HeatConditions readHeatConditions(const Scene& scene, const ConditionText& text);
HeatConditions readHeatConditions(const Scene& scene, const std::string& csv_path,
                                  std::span<const std::string> settings);

/// The same for rows of a matrix, by name (empty where a row has none) or number, from 1.
/// `emissivity`: N, where conditions give none; or empty.
HeatConditions readHeatConditions(std::span<const std::string> names,
                                  std::span<const double> emissivity, const ConditionText& text);

/// Errors: InputError naming the surface, for what solveHeat() would refuse before it begins:
/// values out of range, and emissivities that are neither one nor one a band.
void validate(const HeatConditions& conditions, const HeatOptions& options);

/// The same for the patches of a mesh that the factors are of. Where they share unknowns
/// (PatchMesh::clusters), a cluster has one temperature, and H is linear within it, as in solve().
HeatSolution solveHeat(const FormFactors& factors, const HeatConditions& conditions,
                       const PatchMesh& mesh, const HeatOptions& options, Progress& progress);

/// A surface's figures: sums over its patches, and means by area; of radiosity and irradiance sums
/// over bands.
struct SurfaceHeat {
  std::string name;
  double area = 0;         ///< m^2, both sides of a two-sided one
  double temperature = 0;  ///< K, mean; NaN where a patch has none
  double lowest = 0;       ///< K
  double highest = 0;      ///< K
  double radiosity = 0;    ///< W/m^2
  double irradiance = 0;   ///< W/m^2
  double net_flux = 0;     ///< W/m^2
  double radiated = 0;     ///< W, net
  double convected = 0;    ///< W
  /// About how far the form factors put the irradiance off, W/m^2: the rows' error figures times
  /// the root mean square of J, as if errors of entries were independent. Empty: unknown.
  std::optional<double> irradiance_error;
};
std::vector<SurfaceHeat> heatBySurface(const HeatSolution& solution, const PatchMesh& mesh,
                                       const FormFactors& factors);
/// The same of the rows of a matrix: those of one name together, each without a name by itself.
std::vector<SurfaceHeat> heatByName(const HeatSolution& solution,
                                    std::span<const std::string> names, const FormFactors& factors);

}  // namespace radiosity
