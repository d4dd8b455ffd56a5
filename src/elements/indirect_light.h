// Light from surfaces and from where nothing stands at points, by rays.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "elements/field_builder.h"
#include "elements/ray_light.h"
#include "elements/source_cells.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/elements.h"

namespace radiosity {

/// The mean, over cosine-distributed rays, of the radiosity of the surfaces where they end. Rays
/// that end on their own surface do not count, nor, where facets meet smoothly, those that end on
/// black backs. A point is behind a surface if more than half of its rays end there. If few rays
/// bring most of the light, as through a door, the mean is computed again with more rays.
class ReflectedLight : public FieldLight {
 public:
  /// Keeps all by reference.
  ReflectedLight(const ElementSurface& surface, const PointRays& rays, const HemisphereSet& set,
                 const SourceCells& sources, std::span<const Light> lights, std::uint64_t seed)
      : surface_(surface), rays_(rays), set_(set), light_(sources, lights), seed_(seed) {}
  /// Takes the set `more`, kept by reference, if the standard error of as many random rays would be
  /// more than `uneven` of their mean, or if the means of two halves are off by more than `apart`.
  void repeat(const HemisphereSet& more, double uneven, double apart) {
    more_ = &more;
    uneven_ = uneven;
    apart_ = apart;
  }

  std::shared_ptr<const ElementLights> lightsOf(const ElementShape& /*shape*/,
                                                const ElementLights* /*parent*/) const override {
    return nullptr;
  }
  double irradiance(const SurfacePoint& point, const ElementLights* lights,
                    std::span<double> out) const override;

  /// The number of points that took more rays.
  std::size_t repeated() const { return repeated_; }

 private:
  double look(const SurfacePoint& point, const HemisphereSet& set, std::span<double> out,
              double& spread) const;

  const ElementSurface& surface_;
  const PointRays& rays_;
  const HemisphereSet& set_;
  const HemisphereSet* more_ = nullptr;
  double uneven_ = 0;
  double apart_ = 0;
  RayLight light_;
  std::uint64_t seed_;
  mutable std::atomic<std::size_t> repeated_ = 0;
};

}  // namespace radiosity
