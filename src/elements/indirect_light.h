// Light from surfaces and from where nothing stands at points, by rays.
#pragma once

#include <tbb/concurrent_unordered_map.h>

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "elements/field_builder.h"
#include "elements/source_map.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/elements.h"

namespace radiosity {

/// Where the rays of points end, kept for further passes over the same points and rays: 4 bytes a
/// ray, and some dozens a point.
class KeptEnds {
 public:
  /// A cell of the sources, or one of these.
  static constexpr std::uint32_t kSky = kNone - 1;
  static constexpr std::uint32_t kBlack = kNone - 2;  ///< a back without patches
  static constexpr std::uint32_t kOwn = kNone - 3;    ///< the surface that it left: no true hit
  static constexpr std::uint32_t kDark = kNone - 4;   ///< a patch without light

  /// Null if they are not kept. Thread-safe, as keep().
  const std::vector<std::uint32_t>* find(const SurfacePoint& point) const {
    const auto found = ends_.find(keyOf(point));
    return found == ends_.end() ? nullptr : &found->second;
  }
  void keep(const SurfacePoint& point, const std::vector<std::uint32_t>& ends) {
    ends_.emplace(keyOf(point), ends);
  }

 private:
  static std::uint64_t keyOf(const SurfacePoint& point);

  tbb::concurrent_unordered_map<std::uint64_t, std::vector<std::uint32_t>> ends_;
};

/// The mean, over cosine-distributed rays, of the radiosity of the surfaces where they end. Rays
/// that end on their own surface do not count, nor, where facets meet smoothly, those that end on
/// black backs. A point is behind a surface if more than half of its rays end there. If few rays
/// bring most of the light, as through a door, the mean is computed again with more rays.
class ReflectedLight : public FieldLight {
 public:
  /// Keeps all by reference.
  ReflectedLight(const ElementSurface& surface, const PointRays& rays, const HemisphereSet& set,
                 const SourceMap& sources, std::span<const Light> lights, std::uint64_t seed)
      : surface_(surface),
        rays_(rays),
        set_(set),
        sources_(sources),
        background_(background(lights, sources.bands())),
        seed_(seed) {}
  /// Takes the set `more`, kept by reference, if the standard error of as many random rays would be
  /// more than `uneven` of their mean, or if the means of two halves are off by more than `apart`.
  void repeat(const HemisphereSet& more, double uneven, double apart) {
    more_ = &more;
    uneven_ = uneven;
    apart_ = apart;
  }

  /// Takes ends from `kept`, kept by reference, and puts there those that it traces. All that use
  /// it have the same surface and the same set.
  void keepEnds(KeptEnds& kept) { kept_ = &kept; }

  std::shared_ptr<const ElementLights> lightsOf(const ElementShape& /*shape*/,
                                                const ElementLights* /*parent*/) const override {
    return nullptr;
  }
  double irradiance(const SurfacePoint& point, const ElementLights* lights,
                    std::span<double> out) const override;

  /// The number of points that took more rays.
  std::size_t repeated() const { return repeated_; }

 private:
  const std::vector<std::uint32_t>& endsOf(const SurfacePoint& point, const HemisphereSet& set,
                                           std::size_t number, double turn) const;
  std::uint32_t sourceAt(const RayEnd& end) const;
  void addSource(std::uint32_t source, std::span<double> sum) const;
  double look(const SurfacePoint& point, const HemisphereSet& set, std::span<double> out,
              double& spread) const;

  const ElementSurface& surface_;
  const PointRays& rays_;
  const HemisphereSet& set_;
  const HemisphereSet* more_ = nullptr;
  KeptEnds* kept_ = nullptr;
  double uneven_ = 0;
  double apart_ = 0;
  const SourceMap& sources_;
  std::vector<double> background_;  ///< radiance a band, or empty
  std::uint64_t seed_;
  mutable std::atomic<std::size_t> repeated_ = 0;
};

}  // namespace radiosity
