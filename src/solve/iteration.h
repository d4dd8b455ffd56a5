// Parts shared by the solvers: the system, the residual, and when to stop.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/exchange_operator.h"

namespace radiosity {

/// B = E + rho F B for some bands at once. Every band carries light: max |E| > 0 in each. E may be
/// negative: rays may correct the irradiance of a cluster downwards.
struct System {
  System(const ExchangeOperator& f, int count, std::vector<double> rho, std::vector<double> e);

  const ExchangeOperator& matrix;
  int bands = 0;
  std::vector<double> reflectance;  ///< N * bands, row-major, 0 to 1
  std::vector<double> emission;     ///< N * bands, W/m^2
  bool nonnegative = true;          ///< no E or F is below 0: then neither is any B - E
  /// N flags: patches that reflect in some band. The others are black, B = E: their rows of the
  /// matrix are not needed to find B. Empty where every patch reflects.
  std::vector<std::uint8_t> reflecting;
  std::size_t black = 0;  ///< the number of patches that reflect in no band
};

using BandArray = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// N * bands values seen as an array, a column a band.
inline Eigen::Map<BandArray> asArray(std::vector<double>& values, int bands) {
  return {values.data(), Eigen::Index(values.size()) / bands, bands};
}
inline Eigen::Map<const BandArray> asArray(const std::vector<double>& values, int bands) {
  return {values.data(), Eigen::Index(values.size()) / bands, bands};
}

/// max_i |E_i| of each band.
Eigen::ArrayXd largestEmission(const System& system);

/// max_i |E + rho H - B|_i / max_i |E_i| in the worst band. It is the true residual of B if
/// H = F B.
double relativeResidual(const System& system, const std::vector<double>& radiosity,
                        const std::vector<double>& irradiance);

/// The largest residual of a patch over its own radiosity, in tolerances. It applies to solvers
/// that are accurate in a norm alone.
inline constexpr double kOwnShare = 100;

/// The residual that rounding leaves at a patch that hardly any light reaches, such as a body a
/// kilometre from the lamp, over the largest |E|: solvers that minimise a norm hold the light of
/// all patches in one vector.
inline constexpr double kOwnRounding = 1e-16;

/// Whether |r_i| <= kOwnShare tolerance (E_i + rho_i H_i), or rounding, for every patch and band.
/// Jacobi's and Gauss-Seidel's residuals are small where little light comes; those of solvers that
/// minimise a norm are spread evenly, and leave a room behind a pinhole wrong. True where some E is
/// negative: E and rho H may cancel then, and there is no such scale.
bool smallEverywhere(const System& system, const std::vector<double>& radiosity,
                     const std::vector<double>& irradiance, double tolerance);

/// Why an iteration ends before it converged or reached its limit.
enum class GaveUp {
  no,
  grows,    ///< the spectral radius of rho F is 1 or above
  rounding  ///< the tolerance is below what rounding lets anyone reach
};

/// Counts sweeps, says when to stop and reports progress. A step of `progress` is a hundredth of
/// the way from a residual of 1 to the tolerance on a logarithmic scale (convergence is linear
/// there).
class Convergence {
 public:
  Convergence(double tolerance, int max_sweeps, const std::string& stage, Progress& progress);
  ~Convergence();
  Convergence(const Convergence&) = delete;
  Convergence& operator=(const Convergence&) = delete;

  /// Records the relative residual after a sweep. `everywhere`: the result of smallEverywhere(),
  /// for solvers that need it. Throws Cancelled.
  void record(double residual, bool everywhere = true);
  void giveUp(GaveUp why) { gave_up_ = why; }
  void check() const { progress_.check(); }

  double tolerance() const { return tolerance_; }
  bool converged() const {
    return !history_.empty() && history_.back() <= tolerance_ && everywhere_;
  }
  /// Whether patches that little light reaches are not settled yet (smallEverywhere() was false).
  bool darkLeft() const { return !everywhere_; }
  GaveUp gaveUp() const;
  static bool outOfBounds(double residual);
  bool lastSweep() const { return sweeps() + 1 >= max_sweeps_; }
  bool finished() const { return converged() || gaveUp() != GaveUp::no || sweeps() >= max_sweeps_; }
  int sweeps() const { return int(history_.size()); }
  int sweepsLeft() const { return max_sweeps_ - sweeps(); }
  /// Rows of the matrix that were multiplied in a sweep.
  void countRows(std::size_t rows) { rows_ += rows; }
  std::size_t rows() const { return rows_; }
  const std::vector<double>& history() const { return history_; }

 private:
  double tolerance_;
  int max_sweeps_;
  Progress& progress_;
  std::size_t reported_ = 0;
  std::size_t rows_ = 0;
  bool everywhere_ = true;
  GaveUp gave_up_ = GaveUp::no;
  std::vector<double> history_;
};

/// B and the irradiance H = F B of each patch; both N * bands, row-major. The solvers leave H of
/// black patches as it is: B does not depend on it, see blackIrradiance().
struct Fields {
  std::vector<double> radiosity;
  std::vector<double> irradiance;
};

/// H <- F B of the fields, on the rows of patches that reflect. Counts these rows.
void multiply(const System& system, Fields& fields, Convergence& convergence);

/// H <- F B of the fields; records the residual of B, with smallEverywhere(), and returns it.
double measure(const System& system, Fields& fields, Convergence& convergence);

/// Decides when to end for solvers that correct B step by step: each correction solves a system of
/// its own to a tolerance in a norm.
class Corrections {
 public:
  Corrections(const System& system, Convergence& convergence)
      : system_(system), convergence_(convergence) {}
  /// Measures the residual of the fields and says whether to end. `indefinite`: the solver has
  /// found its system indefinite.
  bool end(Fields& fields, bool indefinite);
  double residual() const { return residual_; }  ///< as measured last

 private:
  const System& system_;
  Convergence& convergence_;
  double residual_ = HUGE_VAL;
  int stalls_ = 0;
};

/// D sqrt(A) and D A^-1/2, D = sqrt(rho), N * bands: with `up` F `down` the system of a
/// symmetric matrix is symmetric. 0 for patches without area.
void symmetricScales(const System& system, std::span<double> up, std::span<double> down);

// Each solver runs until `convergence` is finished. Its last residual is the true residual of the
// fields returned.
Fields jacobi(const System& system, Convergence& convergence);
Fields gaussSeidel(const System& system, Convergence& convergence);
/// The matrix must be symmetric.
Fields conjugateGradients(const System& system, Convergence& convergence);
Fields gmres(const System& system, Convergence& convergence);
/// O(N^2) memory, O(N^3) time a band.
Fields direct(const System& system, Convergence& convergence);
/// The matrix must be SharedRows.
Fields petscSolve(const System& system, Convergence& convergence);

/// conjugateGradients() where the matrix is symmetric, else gmres().
Fields krylovSolve(const System& system, Convergence& convergence);

/// Fills in H of the black patches, whose rows the solvers leave out.
void blackIrradiance(const System& system, Fields& fields);

}  // namespace radiosity
