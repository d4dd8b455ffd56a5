// Light that surfaces reflect, and that of the sky, at points, by rays.
#pragma once

#include <span>
#include <vector>

#include "elements/field_builder.h"
#include "elements/source_map.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/elements.h"

namespace radiosity {

/// The mean over cosine-distributed rays of what leaves the surfaces where they end. Rays that end
/// on what they left do not count. A point more than half of whose rays end on black backs lies
/// behind something.
class ReflectedLight : public FieldLight {
 public:
  ReflectedLight(const ElementSurface& surface, const PointRays& rays, const HemisphereSet& set,
                 const SourceMap& sources, std::span<const double> sky, std::uint64_t seed)
      : surface_(surface), rays_(rays), set_(set), sources_(sources), sky_(sky), seed_(seed) {}

  std::shared_ptr<const ElementLights> lightsOf(const ElementShape& /*shape*/,
                                                const ElementLights* /*parent*/) const override {
    return nullptr;
  }
  double irradiance(const SurfacePoint& point, const ElementLights* lights,
                    std::span<double> out) const override;

 private:
  void addSource(const RayEnd& end, std::span<double> sum) const;

  const ElementSurface& surface_;
  const PointRays& rays_;
  const HemisphereSet& set_;
  const SourceMap& sources_;
  std::span<const double> sky_;  ///< radiance a band, or empty
  std::uint64_t seed_;
};

}  // namespace radiosity
