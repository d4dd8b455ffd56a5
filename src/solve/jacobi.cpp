// Jacobi's iteration: B <- E + rho F B with all of F B made from the last B. In light: each sweep
// adds one bounce everywhere (Goral, Torrance, Greenberg & Battaile 1984 set up the system; Cohen &
// Wallace, "Radiosity and Realistic Image Synthesis", 1993, section 5.3).
#include "solve/iteration.h"

namespace radiosity {

// E + rho F B is the next B, and E + rho F B - B is the residual of this one: the true residual
// costs nothing. The last residual recorded is that of the B returned.
Fields jacobi(const System& system, Convergence& convergence) {
  Fields fields{system.emission, std::vector<double>(system.emission.size())};
  auto radiosity = asArray(fields.radiosity, system.bands);
  const auto irradiance = asArray(fields.irradiance, system.bands);
  const auto emission = asArray(system.emission, system.bands);
  const auto reflectance = asArray(system.reflectance, system.bands);
  for (;;) {
    multiply(system, fields, convergence);
    convergence.record(relativeResidual(system, fields.radiosity, fields.irradiance));
    if (convergence.finished()) return fields;
    radiosity = emission + reflectance * irradiance;
  }
}

}  // namespace radiosity
