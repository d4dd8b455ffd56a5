// The sources of light for points of a solved scene: emitters, and the radiosity of all surfaces.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "elements/direct_light.h"
#include "elements/emitters.h"
#include "elements/field_builder.h"
#include "elements/indirect_light.h"
#include "elements/indirect_sources.h"
#include "elements/source_cells.h"
#include "elements/surface_points.h"
#include "formfactor/rays/point_rays.h"
#include "radiosity/elements.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

/// Errors: InputError if sizes do not fit, see computeElements().
void requireSizes(const PatchMesh& mesh, const PatchMaterials& materials,
                  std::span<const double> irradiance, std::span<const std::uint8_t> wanted);

/// Direct light on elements, and the sources of all other light. The sources are the patches, with
/// their direct light taken from the elements, and the rest from passes of rays (IndirectSources).
class LightSources {
 public:
  /// Arguments as in computeElements(); keeps them by reference. `keep_lights`: emitterLight() will
  /// be used at points. Fills the report but for the last pass. Throws Cancelled.
  LightSources(const PatchMesh& mesh, const PatchMaterials& materials,
               std::span<const double> irradiance, const ElementOptions& options,
               std::span<const std::uint8_t> wanted, bool keep_lights, Progress& progress);
  LightSources(const LightSources&) = delete;
  LightSources& operator=(const LightSources&) = delete;

  /// Indirect light on the elements that are wanted: the last pass.
  ElementField indirectField();

  const ElementSurface& surface() const { return surface_; }
  const ElementLookup& lookup() const { return lookup_; }
  const PointRays& rays() const { return rays_; }
  const SourceCells& sources() const { return *sources_; }
  const ElementField& direct() const { return direct_.field; }
  /// The lights of each leaf of direct(), with `keep_lights`.
  std::span<const std::shared_ptr<const ElementLights>> directLights() const {
    return direct_.lights;
  }
  /// Null if there is no direct light, or if it comes with the indirect light.
  const EmitterLight* emitterLight() const { return emitter_light_.get(); }
  /// N * bands: the light of patches without direct light.
  std::span<const double> indirectOfPatches() const { return indirect_; }
  const ElementReport& report() const { return report_; }

  /// After either of these no other function may be called.
  ElementField takeDirect() { return std::move(direct_.field); }
  ElementRoots takeRoots() { return std::move(surface_.roots); }

 private:
  RefinementRule rule(double tolerance, double smallest) const;
  void take(const FieldSummary& field);
  void findDirect(bool keep_lights);
  void findSources();
  int raysFor(double vertices, int wanted) const;
  void findUses(std::span<const std::uint8_t> wanted);
  double shownCorners() const;

  const PatchMesh& mesh_;
  const PatchMaterials& materials_;
  std::span<const double> irradiance_;
  const ElementOptions& options_;
  Progress& progress_;
  std::size_t bands_;
  ElementSurface surface_;
  ElementSurface indirect_surface_;  ///< the same roots
  ElementLookup lookup_;
  PointRays rays_;
  std::vector<RootUse> use_;  ///< R, or empty; the same for all roots of a patch
  std::vector<double> light_of_patch_;
  double mean_light_ = 0;
  ElementSet elements_;
  std::vector<Emitter> emitters_;
  std::unique_ptr<OccluderSet> occluders_;
  std::unique_ptr<EmitterLight> emitter_light_;
  FieldSummary direct_;
  std::vector<double> direct_of_patch_;  ///< N, over all bands
  std::vector<double> indirect_;
  std::unique_ptr<SourceCells> sources_;
  ElementReport report_;
};

}  // namespace radiosity
