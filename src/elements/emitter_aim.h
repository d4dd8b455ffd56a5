// Aims rays from a point at places on an emitter, more where more of its light comes from.
#pragma once

#include <array>

#include "elements/emitters.h"

namespace radiosity {

/// A place on an emitter that a ray is aimed at.
struct AimedPlace {
  Vec3 at{0.0};  ///< in ElementSet's coordinates
  /// The place's form factor per area over the density of rays: their mean is the form factor from
  /// the point to the emitter.
  double factor = 0;
};

/// Maps the unit square to an emitter as one point sees it, keeping strata together: rows, then
/// columns, of a grid of cells take rays in proportion to their light (as Pharr, Jakob & Humphreys
/// do with images, "Physically Based Rendering", 2016, section 13.6.7).
class EmitterAim {
 public:
  /// `even`: all cells take the same number of rays, which is right from afar.
  EmitterAim(const Emitter& emitter, const Vec3& eye, const Vec3& normal, bool even);

  /// `u`, `v`: in [0, 1).
  AimedPlace at(double u, double v) const;

 private:
  static constexpr std::size_t kSide = 8;
  double factorAt(const Vec3& at) const;
  Vec3 placeAt(double u, double v) const;
  double stretchAt(double u, double v) const;
  void weighCells();

  const Emitter& emitter_;
  Vec3 eye_;
  Vec3 normal_;
  bool even_;
  std::array<double, kSide> row_end_{};                        ///< running sums, 1 at the end
  std::array<std::array<double, kSide>, kSide> column_end_{};  ///< of each row
};

}  // namespace radiosity
