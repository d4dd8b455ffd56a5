// The linear system between rows and bands that every step of Newton's method solves.
#pragma once

#include <cstddef>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/exchange_operator.h"

namespace radiosity {

/// J = source + reflected H + emits sum(absorbs H), H = F J + falling. The sum is over all rows and
/// bands of a row's node: a node emits the heat that it absorbs. N rows of `bands` values,
/// row-major.
struct HeatSystem {
  int bands = 1;
  std::vector<double> source;     ///< W/m^2
  std::vector<double> reflected;  ///< 1 - emissivity; 0 where no light comes
  std::vector<double> emits;      ///< 1/m^2: exitance of each row and band per heat of its node
  std::vector<double> absorbs;    ///< m^2: area times emissivity
  std::vector<double> falling;    ///< W/m^2, from outside
  std::vector<Index> node;        ///< N; kNone: none, `emits` is 0
  std::size_t nodes = 0;

  /// J for a given H.
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

/// Systems of up to this many unknowns, N * bands, are solved directly: about a second of one core.
inline constexpr std::size_t kMostDirect = 1500;

/// Solves directly by LU with partial pivoting, or by restarted GMRES from H = `start` (empty: 0)
/// until the largest entry of the residual is below `tolerance` times the largest H. A closed room
/// whose rows reflect or emit again all irradiance costs GMRES one step. The system must not be
/// singular. The bits do not depend on the number of threads. Throws Cancelled.
HeatFields solveHeatSystem(const ExchangeOperator& matrix, const HeatSystem& system,
                           const std::vector<double>& start, double tolerance, Progress& progress,
                           LinearMethod method = LinearMethod::automatic);

}  // namespace radiosity
