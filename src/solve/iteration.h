// Parts shared by the solvers: the system, the residual, and when to stop.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// B = E + rho F B for some bands at once. Only bands that carry light: max E > 0 in each.
struct System {
  System(const ExchangeMatrix& f, int count, std::vector<double> rho, std::vector<double> e);

  const ExchangeMatrix& matrix;
  int bands = 0;
  std::vector<double> reflectance;  ///< N * bands, row-major, 0 to 1
  std::vector<double> emission;     ///< N * bands, W/m^2
  /// N flags: patches that reflect in some band. The others are black, B = E: their rows of the
  /// matrix are not needed to find B. Empty where every patch reflects.
  std::vector<std::uint8_t> reflecting;
  std::size_t black = 0;  ///< how many do not
};

using BandArray = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// N * bands values seen as an array, a column a band.
inline Eigen::Map<BandArray> asArray(std::vector<double>& values, int bands) {
  return {values.data(), Eigen::Index(values.size()) / bands, bands};
}
inline Eigen::Map<const BandArray> asArray(const std::vector<double>& values, int bands) {
  return {values.data(), Eigen::Index(values.size()) / bands, bands};
}

/// max_i |E + rho H - B|_i / max_i E_i in the worst band. It is the true residual of B where H = F
/// B.
double relativeResidual(const System& system, const std::vector<double>& radiosity,
                        const std::vector<double>& irradiance);

/// Counts sweeps and says when to stop; tells `progress`, whose steps are hundredths of the way
/// from a residual of 1 to the tolerance on a logarithmic scale (convergence is linear there).
class Convergence {
 public:
  Convergence(double tolerance, int max_sweeps, const std::string& stage, Progress& progress);
  ~Convergence();
  Convergence(const Convergence&) = delete;
  Convergence& operator=(const Convergence&) = delete;

  /// A sweep ended with this relative residual. Throws Cancelled.
  void record(double residual);

  double tolerance() const { return tolerance_; }
  bool converged() const { return !history_.empty() && history_.back() <= tolerance_; }
  /// The residual left all bounds: the spectral radius of rho F is above 1.
  bool diverged() const { return !history_.empty() && outOfBounds(history_.back()); }
  static bool outOfBounds(double residual);
  bool lastSweep() const { return sweeps() + 1 >= max_sweeps_; }
  bool finished() const { return converged() || diverged() || sweeps() >= max_sweeps_; }
  int sweeps() const { return int(history_.size()); }
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
  std::vector<double> history_;
};

/// B and what falls on each patch, H = F B; both N * bands, row-major. The solvers leave H of black
/// patches as it is: B does not depend on it, see blackIrradiance().
struct Fields {
  std::vector<double> radiosity;
  std::vector<double> irradiance;
};

/// Runs until `convergence` is finished; its last residual is the true one of the fields returned.
Fields jacobi(const System& system, Convergence& convergence);
Fields gaussSeidel(const System& system, Convergence& convergence);

/// H of the patches whose rows the solvers passed over.
void blackIrradiance(const System& system, Fields& fields);

}  // namespace radiosity
