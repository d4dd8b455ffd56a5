// Light of the emitters at points, by exact clipping or by rays to points on the emitters, and of
// lights without a surface that rays do not find.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "elements/emitters.h"
#include "elements/field_builder.h"
#include "formfactor/rays/aimed_light.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/elements.h"
#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/visible_part.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"
#include "visibility/shadows/kernels.h"
#include "visibility/shadows/tree.h"

namespace radiosity {

/// The most emitters that are clipped; rays are aimed at more than these, ...
inline constexpr std::size_t kMostClippedEmitters = 128;
/// ... up to this number. If there are more, rays over the whole hemisphere bring their light: they
/// take less time than a look at each emitter.
inline constexpr std::size_t kMostAimedEmitters = 8192;

/// A point sees each emitter whole, or past a list of occluders. The list is found for the root and
/// thinned out for the elements below it, with the proofs that Visibility uses. Emitters proved
/// hidden are not tested again. If there are too many occluders for clipping, kLooks rays go to
/// points on the emitters, and more if only some arrive. They are spread in proportion to the
/// unoccluded light (EmitterAim), so that only visibility is sampled. All vertices aim at the same
/// points, so that their errors vary as smoothly as light does.
class EmitterLight : public FieldLight {
 public:
  /// Refers to all arguments, which must outlive it. `occluders`: null: rays alone, for many
  /// emitters.
  EmitterLight(const PatchMesh& mesh, const PatchMaterials& materials,
               const ElementSurface& surface, const ElementSet& elements,
               const OccluderSet* occluders, const std::vector<Emitter>& emitters,
               const PointRays& rays);

  std::shared_ptr<const ElementLights> lightsOf(const ElementShape& shape,
                                                const ElementLights* parent) const override;
  double irradiance(const SurfacePoint& point, const ElementLights* lights,
                    std::span<double> out) const override;

  /// The two parts of it at a point by itself, whatever element it is on. Of lights without a
  /// surface:
  double aimedAt(const SurfacePoint& point, std::span<double> out) const;
  /// Of emitters, by rays: where only some arrive, it takes more sets of them, each spread by
  /// itself, until the standard error of their mean is `tolerance` of it, or all kFineSets.
  double emittedWithin(const SurfacePoint& point, double tolerance, std::span<double> out) const;
  static constexpr std::size_t kFineSets = 128;

  /// The number of points from which rays were cast.
  std::size_t byRays() const { return by_rays_; }

 private:
  struct Lights;
  struct Unblocked;
  struct Looks;
  struct Candidate {
    Index occluder;
    bool cuts_emitter;  ///< reaches behind the emitter's plane
  };

  Vec3 scaled(const Vec3& at) const { return (at - elements_.middle) * elements_.scale; }
  bool findAll(const ElementShape& shape, Lights& lights) const;
  void thinOut(const ElementShape& shape, const Lights& from, Lights& lights) const;
  bool ownsOccluder(Index owners, Index occluder) const;
  double clipped(const SurfacePoint& point, const Lights& lights, std::span<double> out) const;
  void sumUnblocked(const SurfacePoint& point, const Lights* lights, Unblocked& light) const;
  using Aims = std::vector<std::array<float, 3>>;  ///< of rays, in [0, 1)
  bool lookFirst(const SurfacePoint& point, const Lights* lights, std::size_t bands,
                 Unblocked& light, Looks& looks) const;
  void look(const SurfacePoint& point, const Unblocked& light, const Aims& aims, std::size_t count,
            Looks& looks) const;
  double finely(const SurfacePoint& point, const Unblocked& light, double tolerance,
                std::span<double> out) const;
  static bool onlySomeArrive(const Looks& looks);
  double addSeen(const Unblocked& light, const Looks& looks, std::span<double> out) const;
  double byRays(const SurfacePoint& point, const Lights* lights, std::span<double> out) const;

  const PatchMaterials& materials_;
  const ElementSurface& surface_;
  const ElementSet& elements_;
  const OccluderSet* occluders_;
  const std::vector<Emitter>& emitters_;
  AimedLight aimed_;
  const PointRays& rays_;
  OccluderTree tree_;
  VisibilityKernels kernels_;
  std::vector<Index> facet_of_patch_;    ///< N; kNone
  std::vector<std::vector<Index>> own_;  ///< by facet: the occluders of which it is a part
  Aims aims_;
  std::array<Aims, kFineSets> fine_aims_;
  mutable std::atomic<std::size_t> by_rays_ = 0;
};

}  // namespace radiosity
