#include "heat/blackbody.h"

#include <array>
#include <cmath>
#include <numbers>

namespace radiosity {

namespace {

/// h c / k in micrometres times kelvin, exact in the SI.
constexpr double kSecondRadiation = 14387.768775039338;

constexpr double kSeriesFactor =
    15 / (std::numbers::pi * std::numbers::pi * std::numbers::pi * std::numbers::pi);

/// The z that separates the two series: there both give 16 digits with few terms.
constexpr double kShort = 1;

/// B_2m of the expansion z / (e^z - 1) = sum B_n z^n / n!.
constexpr std::array kBernoulli = {1.0 / 6,       -1.0 / 30,      1.0 / 42, -1.0 / 30,
                                   5.0 / 66,      -691.0 / 2730,  7.0 / 6,  -3617.0 / 510,
                                   43867.0 / 798, -174611.0 / 330};

/// The share of wavelengths shorter than that of z = h c / (k wavelength T), for large z. We
/// integrate z^3 / (e^z - 1) = sum_n z^3 e^(-n z) term by term from z on (Chang & Rhee 1984).
double ofShortWaves(double z) {
  double sum = 0;
  for (int n = 1; n <= 40; ++n) {
    const double term =
        std::exp(-n * z) / n *
        (z * z * z + 3 * z * z / n + 6 * z / (double(n) * n) + 6 / (double(n) * n * n));
    sum += term;
    if (term <= 1e-17 * sum) break;
  }
  return kSeriesFactor * sum;
}

/// The share of longer wavelengths, for small z: z^2 sum B_n z^n / n! integrated from 0 to z.
double ofLongWaves(double z) {
  double sum = 1.0 / 3 - z / 8;
  double power = 1;  // z^n / n!
  for (std::size_t m = 0; m < kBernoulli.size(); ++m) {
    const double n = 2 * double(m) + 2;
    power *= z * z / (n * (n - 1));
    sum += kBernoulli[m] * power / (n + 3);
  }
  return kSeriesFactor * z * z * z * sum;
}

/// d fraction / d T times T / 4: the slope of a band's emissive power in addition to its share.
double shift(double wavelength, double temperature) {
  const double z = kSecondRadiation / (wavelength * temperature);
  if (!(z < 700)) return 0;
  return kSeriesFactor * z * z * z * z / std::expm1(z) / 4;
}

}  // namespace

double blackbodyFraction(double wavelength, double temperature) {
  if (!(wavelength * temperature > 0)) return 0;
  const double z = kSecondRadiation / (wavelength * temperature);
  return z < kShort ? 1 - ofLongWaves(z) : ofShortWaves(z);
}

double BlackBands::total(double temperature) const {
  return options_.sigma * temperature * temperature * temperature * temperature;
}

double BlackBands::temperatureOf(double total) const {
  return std::sqrt(std::sqrt(total / options_.sigma));
}

double BlackBands::fraction(int band, double temperature) const {
  const HeatBands& bands = options_.bands;
  const auto k = std::size_t(band);
  if (!bands.fractions.empty()) return bands.fractions[k];
  const double below = k == 0 ? 0 : blackbodyFraction(bands.edges[k - 1], temperature);
  const double up_to = k == bands.edges.size() ? 1 : blackbodyFraction(bands.edges[k], temperature);
  return up_to - below;
}

// E_k = f_k(T) x, so dE_k/dx = f_k + f_k'(T) x dT/dx, and x dT/dx = T / 4.
double BlackBands::slope(int band, double temperature) const {
  const HeatBands& bands = options_.bands;
  const auto k = std::size_t(band);
  double slope = fraction(band, temperature);
  if (bands.edges.empty() || !(temperature > 0)) return slope;
  if (k < bands.edges.size()) slope += shift(bands.edges[k], temperature);
  if (k > 0) slope -= shift(bands.edges[k - 1], temperature);
  return slope;
}

}  // namespace radiosity
