// Lux and candela of a solution.
#include <numbers>

#include "radiosity/light.h"
#include "radiosity/solve.h"

namespace radiosity {

PhotometricRows photometricRows(const Solution& solution) {
  PhotometricRows rows{photometricOfEach(solution.irradiance, solution.bands),
                       photometricOfEach(solution.radiosity, solution.bands)};
  for (double& value : rows.luminance) value *= std::numbers::inv_pi;
  return rows;
}

}  // namespace radiosity
