// The linear system between rows and bands that every step of Newton's method solves.
#pragma once

#include <cstddef>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// J = source + reflected H + emits sum(absorbs H), H = F J + falling, where the sum is over all
/// rows and bands of a row's node: what a node absorbs, it emits again. N rows of `bands` values,
/// row-major.
struct HeatSystem {
  int bands = 1;
  std::vector<double> source;     ///< W/m^2
  std::vector<double> reflected;  ///< 1 - emissivity; in what stays dark 0
  std::vector<double> emits;      ///< 1/m^2: what of a node's heat each row and band sends out
  std::vector<double> absorbs;    ///< m^2: area times emissivity
  std::vector<double> falling;    ///< W/m^2, from outside
  std::vector<Index> node;        ///< N; kNone: none, `emits` is 0
  std::size_t nodes = 0;

  /// J of H.
  std::vector<double> radiosityOf(const std::vector<double>& irradiance) const;
  /// The same without `source`: the linear part.
  std::vector<double> sentBack(const std::vector<double>& irradiance) const;
};

struct HeatFields {
  std::vector<double> radiosity;
  std::vector<double> irradiance;
  std::size_t products = 0;  ///< with the matrix; 0: solved directly
};

enum class LinearMethod { automatic, direct, iterative };

/// Systems of up to so many unknowns, N * bands, are solved directly: about a second of one core.
inline constexpr std::size_t kMostDirect = 1500;

/// Directly by LU with partial pivoting, or by restarted GMRES from H = `start` (empty: 0) until
/// the largest entry of the residual is below `tolerance` times the largest H. Rows that reflect or
/// emit again all that falls on them in closed rooms cost GMRES a step a room. The system must not
/// be singular. The same bits for any number of threads. Throws Cancelled.
HeatFields solveHeatSystem(const ExchangeMatrix& matrix, const HeatSystem& system,
                           const std::vector<double>& start, double tolerance, Progress& progress,
                           LinearMethod method = LinearMethod::automatic);

}  // namespace radiosity
