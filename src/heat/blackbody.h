// What black surfaces give off in each band.
#pragma once

#include "radiosity/heat.h"

namespace radiosity {

/// Emissive power of black surfaces. `x` = sigma T^4 is what heat balances are solved for: without
/// bands of wavelengths they are linear in it.
class BlackBands {
 public:
  /// Kept by reference.
  explicit BlackBands(const HeatOptions& options) : options_(options) {}

  int count() const { return options_.bands.count(); }
  double total(double temperature) const;
  double temperatureOf(double total) const;
  /// The share of `total(temperature)` in a band.
  double fraction(int band, double temperature) const;
  /// d E_band / d x at that temperature, which is above 0 where bands have edges.
  double slope(int band, double temperature) const;
  bool linear() const { return options_.bands.edges.empty(); }

 private:
  const HeatOptions& options_;
};

}  // namespace radiosity
