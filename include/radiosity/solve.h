// B = E + rho F B, every band in one pass over the matrix.
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

namespace [[gnu::visibility("default")]] radiosity {

enum class Solver {
  /// Direct for few unknowns, else cg if the matrix is symmetric, else gmres; under mpirun petsc.
  automatic,
  jacobi,        ///< B <- E + rho F B: a sweep adds a bounce
  gauss_seidel,  ///< the same row by row, with the new values of the rows before; on one thread
  cg,            ///< conjugate gradients; needs a matrix in the symmetric form
  gmres,         ///< for any matrix; keeps up to 30 vectors a band
  direct,        ///< Cholesky or LU; O(N^2) memory and O(N^3) time, N at most kMostDirectUnknowns
  petsc          ///< PETSc's KSP with options of its own, on the rows of several processes (mpirun)
};

/// Solver::automatic is direct up to this many unknowns: factoring then takes no longer than a
/// dozen products, and leaves only rounding.
inline constexpr std::size_t kFewUnknowns = 256;
/// Beyond this the direct solver refuses: a dense matrix of 128 MB a band, factored in seconds.
inline constexpr std::size_t kMostDirectUnknowns = 4000;

struct SolveOptions {
  Solver solver = Solver::automatic;
  /// Stop when max_i |r_i| <= tolerance * max_i |E_i| in every band, with r the true residual and E
  /// a patch's emission and reflected sky light. Between 0 and 1; below about 1e-14 rounding keeps
  /// it from being reached.
  double tolerance = 1e-6;
  int max_iterations = 10000;  ///< products or sweeps over the matrix; 1 or more
  void validate() const;

  /// A line an option (option_line.h).
  static void describe(auto& list, auto& o) {
    list({.name = "solver",
          .value = "NAME",
          .help = "auto (default): direct for up to {} unknowns, else cg, or gmres where form "
                  "factors are raw hemicube rows; cg: conjugate gradients; gmres: for any matrix; "
                  "petsc: PETSc's KSP, under mpirun; direct: factors it, up to {} unknowns; "
                  "gauss-seidel and jacobi: the classic sweeps, slow in bright rooms",
          .figures = {double(kFewUnknowns), double(kMostDirectUnknowns)}},
         o.solver);
    list({.name = "tolerance",
          .option = "solve-tolerance",
          .value = "RATIO",
          .help = "Stop when the largest residual is at most this times the largest emission"},
         o.tolerance, {.above = 0, .below = 1});
    list({.name = "max_iterations", .help = "Sweeps or products at most; then exit code 1"},
         o.max_iterations, {.from = 1});
  }
};

enum class SolveStatus {
  /// |r|_inf <= tolerance |E|_inf in every band, r = E + rho F B - B; usable. Solvers that are
  /// accurate in a norm alone (cg, gmres, direct, petsc) also hold
  /// |r_i| <= 100 tolerance (E_i + rho_i H_i) for every patch, unless some E or F is negative: so
  /// rooms that little light reaches are right, too.
  converged,
  no_convergence,  ///< the iteration limit came first; B is the last iterate, not usable as it is
  no_light,        ///< nothing emits, no sky shines in: B = 0; usable, but dark
  singular,        ///< rho = 1 everywhere in a closed, lit room: no solution; B is empty
  /// The system is solved, but more energy is missing, or there is more, than the errors of the
  /// form factors explain (mostImbalance()): rows are wrong; not usable.
  unbalanced,
};

/// The account of the light, W, one value a band.
/// emitted + from_sky = absorbed + to_sky + on_backs + imbalance; imbalance comes from missing
/// reciprocity of F and from the residual and is 0 for an exact F and B.
struct EnergyAccount {
  std::vector<double> emitted;
  std::vector<double> from_sky;  ///< falls on the patches from the sky and other lights
  std::vector<double> absorbed;
  std::vector<double> to_sky;
  std::vector<double> on_backs;
  std::vector<double> imbalance;

  static void describe(auto& list, auto& e) {
    list({"emitted", "", "W"}, e.emitted);
    list({"from_sky", "", "W"}, e.from_sky);
    list({"absorbed", "", "W"}, e.absorbed);
    list({"to_sky", "", "W"}, e.to_sky);
    list({"on_backs", "", "W"}, e.on_backs);
    list({"imbalance", "", "W"}, e.imbalance);
  }
};

/// Work skipped because the scene did not need it.
struct SolveSkips {
  std::size_t black_patches = 0;  ///< reflectance 0 in every band solved: B = E without their rows
  int dark_bands = 0;             ///< no patch emits: B = 0, not solved
  int equal_bands = 0;            ///< same reflectance and emission as an earlier band: copied

  static void describe(auto& list, auto& s) {
    list({"black_patches", "skipped: rows of black patches", "", "skipped_black_patches"},
         s.black_patches);
    list({"dark_bands", "skipped: bands without light", "", "skipped_dark_bands"}, s.dark_bands);
    list({"equal_bands", "skipped: bands equal to another", "", "skipped_equal_bands"},
         s.equal_bands);
  }
};

struct SolveSummary {
  SolveStatus status = SolveStatus::no_convergence;
  Solver solver = Solver::automatic;  ///< the one that ran; automatic: there was nothing to solve
  /// Sweeps of Gauss-Seidel, products with the matrix of the other solvers, checks included.
  int iterations = 0;
  std::size_t rows = 0;  ///< rows of the matrix multiplied in them, each for all bands solved
  SolveSkips skipped;
  double residual = 0;  ///< max |E + rho F B - B| / max |E|, true, worst band
  /// An upper bound of |B - B*|_inf, W/m^2, worst band, B* being this matrix's exact solution:
  /// w_i max_k |r_k| / ((I - rho F) w)_k for a vector w > 0 with (I - rho F) w > 0. Empty: no such
  /// vector was found, "no certificate".
  std::optional<double> error_bound;
  /// About the relative error (L2, by area) of the irradiance in this light, by the errors that the
  /// form factors state: at most this where rows state theirs (exact: some 4 to 14 times what it
  /// is). Empty: they state none, or nothing is lit.
  std::optional<double> irradiance_error;
  EnergyAccount energy;
  double seconds = 0;
  /// Relative, one an iteration; the last entry is always the true residual. Before that, Jacobi
  /// and direct: the true residual. Gauss-Seidel: the largest change of the sweep, or the true
  /// residual if the change is within tolerance. cg, gmres, petsc: the residual of their
  /// recurrence, or the true one at a restart.
  std::vector<double> residual_history;
  std::string message;  ///< plain words, with numbers; says if B is usable
  bool usable() const {
    return status == SolveStatus::converged || status == SolveStatus::no_light;
  }

  static void describe(auto& list, auto& s) {
    list({"status", "status"}, s.status);
    list({"solver"}, s.solver);
    list({"iterations", "iterations"}, s.iterations);
    list({"rows", "rows multiplied"}, s.rows);
    list.part("skipped", s.skipped);
    list({"residual", "residual (relative)"}, s.residual);
    list({"error_bound"}, s.error_bound);
    list({"irradiance_error", "irradiance off by about"}, s.irradiance_error);
    list({"residual_history"}, s.residual_history);
    list({"seconds", "time", "s"}, s.seconds);
    list.part("energy", s.energy);
    list({"message", "in words"}, s.message);
  }
};

struct Solution {
  int bands = 3;
  std::vector<double> radiosity;   ///< N * bands, row-major, W/m^2
  std::vector<double> irradiance;  ///< N * bands: H = F B + the light of the sky
  SolveSummary summary;
};

/// A solution in photometric units, a value a row.
struct PhotometricRows {
  std::vector<double> illuminance;  ///< lx, of H
  std::vector<double> luminance;    ///< cd/m^2, of B / pi
};
/// Errors: as photometricOf().
PhotometricRows photometricRows(const Solution& solution);

/// The largest share of the power coming in by which an account may be off that is made with these
/// form factors: what they state as their error, and 1% at least; 10% for hemicubes, which state
/// none. No limit for matrices from elsewhere: areas may be missing, and notes say what is odd.
double mostImbalance(const FormFactors& factors);
/// What a user can do about more than that, by the options of the program.
std::string imbalanceCure(FormFactorMethod method);

/// `reflectance`, `emission`: N * bands, row-major; 0 <= rho <= 1, E >= 0, finite, else InputError
/// naming the patch. Needs a matrix of N rows and accounts of N values. Work that the scene does
/// not need is skipped, see SolveSkips, and B and H have the same bits as with it. Not converging
/// is data, not an exception. `group_names[group[i]]` names patch i's surface in messages; both may
/// be empty. `sky`: radiance of the sky, W/m^2/sr, a band each, finite and >= 0; empty: dark. It
/// falls on patch i as pi sky F_i,sky (Lambert's law over a uniform part of the hemisphere):
/// B = E + rho (F B + pi sky F_sky).
Solution solve(const FormFactors& factors, std::span<const double> reflectance,
               std::span<const double> emission, int bands, const SolveOptions& options,
               Progress& progress, std::span<const Index> group = {},
               std::span<const std::string> group_names = {}, std::span<const double> sky = {});

/// The same with the materials, of any number of bands, and the surfaces of the mesh to which the
/// factors belong. Errors also as PatchMaterials::requireSizes().
Solution solve(const FormFactors& factors, const PatchMaterials& materials, const PatchMesh& mesh,
               const SolveOptions& options, Progress& progress);

}  // namespace radiosity
