// The emissive power of black surfaces in each band.
#pragma once

#include "radiosity/heat.h"

namespace radiosity {

/// Emissive power of black surfaces. Heat balances are solved for `x` = sigma T^4: without bands of
/// wavelengths they are linear in it.
class BlackBands {
 public:
  /// Keeps `options` by reference.
  explicit BlackBands(const HeatOptions& options) : options_(options) {}

  int count() const { return options_.bands.count(); }
  double total(double temperature) const;
  double temperatureOf(double total) const;
  /// The share of `total(temperature)` in a band.
  double fraction(int band, double temperature) const;
  /// d E_band / d x at that temperature, which must be above 0 if bands have edges.
  double slope(int band, double temperature) const;
  bool linear() const { return options_.bands.edges.empty(); }

 private:
  const HeatOptions& options_;
};

}  // namespace radiosity
