// Radiative heat exchange on the same matrix: temperatures and net fluxes of grey or banded diffuse
// surfaces whose temperature, net flux or convection is given.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/form_factors.h"
#include "radiosity/option_line.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/report_line.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// 2 pi^5 k^4 / (15 h^3 c^2), W/m^2/K^4, from the exact constants of the SI (CODATA 2018).
inline constexpr double kStefanBoltzmann = 5.67037441918443e-8;

/// The highest temperature that is accepted, K: far above that of solid surfaces, and sigma T^4
/// keeps all its digits.
inline constexpr double kHottest = 1e8;

/// The share of a blackbody's exitance at `temperature` K at wavelengths below `wavelength`
/// micrometres; 0 if their product is 0 (Chang & Rhee, Int. Comm. Heat Mass Transfer 11, 1984).
double blackbodyFraction(double wavelength, double temperature);

/// Hemispherical emissivity, 0 to 1: constant, or a table against temperature, linear in between.
struct Emissivity {
  std::vector<double> temperatures;  ///< K, increasing; empty: constant
  std::vector<double> values;        ///< one per temperature; a single one if constant
  /// Beyond the table it keeps the value at the end.
  double at(double temperature) const;
};

/// The condition of a surface, or of several that are heated together. At most one of temperature,
/// flux and power is given. Without them the net flux is 0, which is adiabatic if nothing convects.
struct HeatCondition {
  std::string name;                    ///< for messages
  std::vector<Emissivity> emissivity;  ///< one a band, or one for all
  std::optional<double> temperature;   ///< K, >= 0
  /// W/m^2: the heat supplied to the surface, which it gives off by radiation and convection; below
  /// 0 if it is cooled. Both sides of a two-sided surface count.
  std::optional<double> flux;
  std::optional<double> power;  ///< W of all patches with this condition, spread by area
  double convection = 0;        ///< W/m^2/K, >= 0: to air of the temperature `ambient`
  double ambient = 0;           ///< K, >= 0
  bool isothermal = false;      ///< flux and power: one temperature for all of its patches
};

/// Bands of wavelengths, each with a part of the emission; one band unless one of the two is given.
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
  double sky_temperature = 0;  ///< K, black; for the part of a row that leaves the scene
  /// Stop when no radiosity and no heat balance is off by more than this times the largest
  /// radiosity. Between 0 and 1.
  double tolerance = 1e-9;
  int max_iterations = 100;         ///< of Newton's method, 1 or more
  double sigma = kStefanBoltzmann;  ///< W/m^2/K^4, for comparison with others' figures
  void validate() const;            ///< Throws InputError naming the option and its range.

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "sky_temperature",
          .value = "K",
          .unit = "K",
          .help = "Temperature of the black sky wherever rays leave the scene"},
         o.sky_temperature, {.from = 0, .to = kHottest});
    list({.name = "band_edges",
          .value = "UM,UM,...",
          .unit = "um",
          .help = "Cut the spectrum into bands at these wavelengths, micrometres (default: one "
                  "grey band)",
          .unset = "none"},
         o.bands.edges);
    list(
        {.name = "band_fractions",
         .value = "F,F,...",
         .help = "Bands with these shares of sigma T^4 at any temperature; they sum to 1 (default: "
                 "one grey band)",
         .unset = "none"},
        o.bands.fractions);
    list({.name = "tolerance",
          .option = "heat-tolerance",
          .value = "RATIO",
          .help = "Stop when no radiosity and no heat balance is off by more than this times the "
                  "largest radiosity"},
         o.tolerance, {.above = 0, .below = 1});
    list({.name = "max_iterations",
          .option = "heat-iterations",
          .help = "Steps of Newton's method at most; then exit code 1"},
         o.max_iterations, {.from = 1});
    list({.name = "sigma", .in_key = InKey::if_changed}, o.sigma, {.above = 0});
  }
};

enum class HeatStatus {
  converged,       ///< both residuals are within the tolerance; usable
  no_convergence,  ///< the iteration limit came first; not usable as it is
  /// Converged, but more heat is missing, or there is more, than the errors of the form factors
  /// explain (mostImbalance()); not usable.
  unbalanced
};

/// The account of the heat, W. radiated = to_sky + on_backs + imbalance.
struct HeatBalance {
  double radiated = 0;    ///< sum of A (J - H) over all patches
  double to_sky = 0;      ///< net: less the heat that the sky sends
  double on_backs = 0;    ///< falls on backs that carry no patches: black, at 0 K
  double imbalance = 0;   ///< from rows that do not sum to 1, missing reciprocity and the residual
  double convected = 0;   ///< sum of A h (T - ambient)
  double throughput = 0;  ///< sum of the net powers above 0

  static void describe(auto& list, auto& b) {
    list({"radiated"}, b.radiated);
    list({"to_sky"}, b.to_sky);
    list({"on_backs"}, b.on_backs);
    list({"imbalance"}, b.imbalance);
    list({"convected"}, b.convected);
    list({"throughput"}, b.throughput);
  }
};

struct HeatSummary {
  HeatStatus status = HeatStatus::no_convergence;
  int iterations = 0;            ///< of Newton's method; 1 if the problem is linear in T^4
  std::size_t linear_steps = 0;  ///< products with the matrix in them; 0: solved directly
  /// max |eps E(T) + (1 - eps) H - J| over max J, with H = F J + sky computed anew.
  double residual = 0;
  double balance_residual = 0;  ///< max |heat supplied - given off| per area, over max J
  /// Patches without a temperature: with emissivity 0 and no convection any would do.
  std::size_t undetermined = 0;
  HeatBalance balance;
  double seconds = 0;
  std::string message;  ///< plain words, with numbers; says whether the result is usable
  bool usable() const { return status == HeatStatus::converged; }

  /// Without `balance`.
  static void describe(auto& list, auto& s) {
    list({"status", "status"}, s.status);
    list({"iterations", "steps of Newton's method"}, s.iterations);
    list({"linear_steps"}, s.linear_steps);
    list({"residual", "residual (relative)"}, s.residual);
    list({"balance_residual", "heat balance (relative)"}, s.balance_residual);
    list({"undetermined"}, s.undetermined);
    list({"seconds", "time", "s"}, s.seconds);
    list({"message", "in words"}, s.message);
  }
};

/// Conditions as a person wrote them.
struct ConditionText {
  std::string origin;                 ///< the file that the table is from, for messages
  std::string table;                  ///< comma-separated, as src/heat/README.md says; empty: none
  std::vector<std::string> settings;  ///< "NAME.PROPERTY=VALUE", which replace cells of the table
  std::vector<std::string> groups;    ///< "NAME=PATTERN", as groupSurfaces() takes them
  bool empty() const { return table.empty() && settings.empty(); }
};

/// The solution for N patches, or for N rows of a matrix.
struct HeatSolution {
  int bands = 1;
  std::vector<double> radiosity;   ///< J, N * bands, row-major, W/m^2
  std::vector<double> irradiance;  ///< H, N * bands, W/m^2
  std::vector<double> net_flux;  ///< N, W/m^2: sum over bands of J - H; above 0: it gives off heat
  std::vector<double> convection;   ///< N, W/m^2: h (T - ambient), given off to the air
  std::vector<double> temperature;  ///< N, K; NaN if undetermined
  HeatSummary summary;
  ConditionText conditions{};  ///< the conditions that it was solved for, if they came as text
};

/// The conditions of the rows of a matrix.
struct HeatRows {
  std::span<const HeatCondition> conditions;
  std::span<const Index> of_row;  ///< N, into conditions
  /// N, the row of the other side of the same sheet, or kNone; or empty. Both sides have one
  /// temperature if flux or power is given.
  std::span<const Index> twin;
};

/// Solves J = eps E(T) + (1 - eps) H, H = F J + F_sky E(T_sky) in every band. T is given, or such
/// that each patch (each sheet, each isothermal surface) radiates and convects the heat supplied to
/// it. Equations and conventions: src/heat/README.md. Errors: InputError, naming the condition, for
/// values out of range, if nothing fixes the level of temperatures in a closed room, if more heat
/// is taken out than there is, and if a temperature leaves its table of emissivity. Throws
/// Cancelled. Not converging is data, not an exception.
HeatSolution solveHeat(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
                       Progress& progress);

/// Conditions of a scene's surfaces, or of the rows of a matrix.
struct HeatConditions {
  std::vector<HeatCondition> conditions;
  std::vector<Index> of_surface;  ///< into conditions; S as PatchMesh::surface_names, or N rows
  ConditionText text{};           ///< the text that they were read from; or empty
  std::vector<Note> notes{};      ///< on its groups
  bool from_materials = false;    ///< an emissivity is 1 - reflectance of a material
};

/// Reads the table at `csv_path` (empty: none), the settings and groups. Errors: as
/// readWholeFile(), and InputError if there are neither a table nor settings, or if one cannot be
/// read as such.
ConditionText readConditionText(const std::string& csv_path, std::span<const std::string> settings,
                                std::span<const std::string> groups = {});

/// Finds conditions by name, as SceneOptions::set finds surfaces, or by a pattern of names: * any
/// text, ? a character, [abc] one of some. The name of a group stands for all in it. A name goes
/// before a pattern and a group, settings go before the
/// table, and the name * gives every surface what no other line does. Errors: InputError, one
/// line with file, line and cure; also for a surface without a condition.
HeatConditions readHeatConditions(const Scene& scene, const ConditionText& text);
HeatConditions readHeatConditions(const Scene& scene, const std::string& csv_path,
                                  std::span<const std::string> settings);

/// The same for rows of a matrix, by name (empty if a row has none) or number, from 1.
/// `emissivity`: N, for conditions that give none; or empty.
HeatConditions readHeatConditions(std::span<const std::string> names,
                                  std::span<const double> emissivity, const ConditionText& text);

/// Checks the conditions as solveHeat() does before it begins. Errors: InputError naming the
/// surface, for values out of range and for emissivities that are neither one nor one per band.
void validate(const HeatConditions& conditions, const HeatOptions& options);

/// The same for the patches of the mesh to which the factors belong.
HeatSolution solveHeat(const FormFactors& factors, const HeatConditions& conditions,
                       const PatchMesh& mesh, const HeatOptions& options, Progress& progress);

/// A surface's figures: sums over its patches and means by area. Radiosity and irradiance are
/// summed over bands.
struct SurfaceHeat {
  std::string name;
  double area = 0;         ///< m^2, both sides of a two-sided one
  double temperature = 0;  ///< K, mean; NaN if a patch has none
  double lowest = 0;       ///< K
  double highest = 0;      ///< K
  double radiosity = 0;    ///< W/m^2
  double irradiance = 0;   ///< W/m^2
  double net_flux = 0;     ///< W/m^2
  double radiated = 0;     ///< W, net
  double convected = 0;    ///< W
  /// The irradiance's error due to the form factors, about, W/m^2: the rows' error figures times
  /// the root mean square of J, as if errors of entries were independent. Empty: unknown.
  std::optional<double> irradiance_error;

  static void describe(auto& list, auto& s) {
    list({"name"}, s.name);
    list({"area"}, s.area);
    list({"temperature"}, s.temperature);
    list({"lowest"}, s.lowest);
    list({"highest"}, s.highest);
    list({"radiosity"}, s.radiosity);
    list({"irradiance"}, s.irradiance);
    list({"net_flux"}, s.net_flux);
    list({"radiated"}, s.radiated);
    list({"convected"}, s.convected);
    list({"irradiance_error"}, s.irradiance_error);
  }
};
/// Surfaces in one of solution.conditions.groups are one.
std::vector<SurfaceHeat> heatBySurface(const HeatSolution& solution, const PatchMesh& mesh,
                                       const FormFactors& factors);
/// The same for the rows of a matrix: rows of one name together, a row without a name by itself.
std::vector<SurfaceHeat> heatByName(const HeatSolution& solution,
                                    std::span<const std::string> names, const FormFactors& factors);

}  // namespace radiosity
