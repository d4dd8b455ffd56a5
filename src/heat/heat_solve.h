// Newton's method for temperatures, around the linear system.
#pragma once

#include <string>
#include <vector>

#include "heat/blackbody.h"
#include "heat/linear_system.h"
#include "heat/nodes.h"
#include "radiosity/heat.h"

namespace radiosity {

/// The balance of a node in x = sigma T^4, and J of its rows:
///
///   supplied + h A (T_inf - T) = sum over rows i and bands k of A_i eps_ik (E_k(T) - H_ik)
///   J_ik = eps_ik E_k(T) + (1 - eps_ik) H_ik
///
/// Around a temperature, E_k(T) = E_k + E_k' y, eps(T) = eps + eps' y and T = T + T' y for a step y
/// in x, so that with s_ik = eps_ik E_k' + eps_ik' (E_k - H_ik), H in eps' from the step before,
///
///   y = [supplied + h A (T_inf - T) - sum A eps (E_k - H_ik)] / [sum A s_ik + h A T'].
///
/// Inserted into J this gives a linear system in H, which couples the rows and bands of a node.
/// Without convection, edges of bands and tables of emissivity one step from any start is exact.
/// Steps of a node that turn back are halved: at the corners of a table Newton's method would go
/// round in circles.
class HeatSolve {
 public:
  /// Keeps all by reference. Errors: as solveHeat().
  HeatSolve(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
            Progress& progress);
  HeatSolution run();

 private:
  struct Residuals {
    double radiosity = 0;
    double balance = 0;
    double worst() const { return radiosity > balance ? radiosity : balance; }
  };

  void requireEmitters() const;
  void requireTables() const;
  void findDark();
  bool markNode(const HeatNode& node, std::vector<double>& marks) const;
  [[noreturn]] void refuseClosed(const std::vector<double>& lost, double supplied) const;
  [[noreturn]] void refuseCold(std::size_t n) const;
  void start();
  void placeAt(double temperature, std::size_t row);
  void place();
  double heatWithoutLight(std::size_t n) const;
  /// `irradiance`: of the step before; empty before the first.
  HeatSystem system(const std::vector<double>& irradiance);
  void linearize(std::size_t n, const std::vector<double>& irradiance, HeatSystem& s);
  std::vector<double> emissionSlopes(std::size_t n, const std::vector<double>& irradiance) const;
  void step(const HeatSystem& s, HeatFields& fields);
  double limited(std::size_t n, double step);
  Residuals residuals(HeatFields& fields) const;
  HeatSolution solutionOf(HeatFields fields) const;
  HeatBalance balanceOf(const HeatSolution& solution) const;
  /// Makes a converged solution `unbalanced`, with a message, if more heat is missing than the form
  /// factors' errors explain.
  void judgeBalance(HeatSolution& solution) const;
  bool isLinear() const;
  const HeatCondition& conditionOf(std::size_t row) const {
    return rows_.conditions[rows_.of_row[row]];
  }
  std::string namesOf(const std::vector<double>& marks) const;

  const FormFactors& factors_;
  const HeatRows& rows_;
  const HeatOptions& options_;
  Progress& progress_;
  BlackBands black_;
  std::size_t n_;
  std::size_t width_;  ///< bands
  std::span<const double> area_;
  HeatNodes nodes_;
  std::vector<double> x_;             ///< of each node
  std::vector<double> last_step_;     ///< of each node, in x; 0: none yet
  std::vector<double> longest_step_;  ///< of each node that has a table of emissivity
  bool cold_ = false;                 ///< no heat comes from anywhere: all is at 0 K
  std::vector<double> temperature_;   ///< of each row
  std::vector<double> emissivity_;    ///< N * bands, at that temperature
  std::vector<double> emitted_;       ///< N * bands: eps E(T)
  std::vector<double> falling_;       ///< N * bands, from the sky
  std::vector<std::uint8_t> dark_;    ///< N * bands: no light reaches it
  // The denominator of y in the current step, by node, and the numerator without H.
  std::vector<double> gain_;
  std::vector<double> lack_;
};

}  // namespace radiosity
