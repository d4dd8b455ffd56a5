#include "solve/energy.h"

namespace radiosity {

// By reciprocity the light that goes to fronts is the light that falls on them from fronts: sum_i
// A_i fronts_i B_i = sum_j A_j (H_j - S_j); S is the irradiance from the sky. The accounts of a row
// sum to 1 and B = E + rho H, so summing A_i B_i both ways gives
//     sum A E + sum A S = sum A (1 - rho) H + sum A sky B + sum A backs B.
// The imbalance of this equation measures missing reciprocity and the residual.
EnergyAccount energyAccount(const FormFactors& factors, std::span<const double> reflectance,
                            const Incoming& incoming, std::span<const double> radiosity,
                            std::span<const double> irradiance, int bands) {
  const auto width = std::size_t(bands);
  const std::vector<double> zeros(width, 0.0);
  EnergyAccount account{zeros, zeros, zeros, zeros, zeros, zeros};
  const std::span<const double> area = factors.matrix.area();
  for (std::size_t i = 0; i < area.size(); ++i) {
    for (std::size_t b = 0; b < width; ++b) {
      const std::size_t k = i * width + b;
      account.emitted[b] += area[i] * incoming.emission[k];
      account.from_sky[b] += area[i] * incoming.sky[k];
      account.absorbed[b] += area[i] * (1 - reflectance[k]) * irradiance[k];
      account.to_sky[b] += area[i] * factors.sky[i] * radiosity[k];
      account.on_backs[b] += area[i] * factors.backs[i] * radiosity[k];
    }
  }
  for (std::size_t b = 0; b < width; ++b) {
    account.imbalance[b] = account.emitted[b] + account.from_sky[b] - account.absorbed[b] -
                           account.to_sky[b] - account.on_backs[b];
  }
  return account;
}

}  // namespace radiosity
