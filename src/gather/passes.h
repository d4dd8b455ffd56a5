// Gathering at one eye, and the fields that the passes work on.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "formfactor/hemicube/gpu_eye.h"
#include "formfactor/hemicube/row_builder.h"
#include "gather/eyes.h"
#include "gather/interpolated_view.h"
#include "gather/patch_basis.h"
#include "radiosity/gather.h"

namespace radiosity {

/// Emission and reflectance of each eye, L * bands: means over the patches for which it stands.
struct EyeMaterials {
  std::vector<float> emission;
  std::vector<float> reflectance;
};

/// The data of the scene that all passes need; made once.
class GatherScene {
 public:
  /// `mesh` is kept by reference.
  GatherScene(const PatchMesh& mesh, const PatchMaterials& materials, const GatherOptions& options,
              Progress& progress);
  GatherScene(const GatherScene&) = delete;
  GatherScene& operator=(const GatherScene&) = delete;

  std::size_t size() const { return eyes.size(); }
  std::size_t bytes() const;

  const PatchMesh& mesh;
  std::size_t bands;
  GatherAt at;
  int resolution;
  bool simd;
  RowBuilder rows;
  std::vector<Eye> eyes;
  std::vector<double> area;          ///< L
  std::vector<Index> eye_of_corner;  ///< at vertices
  std::optional<PatchBasis> basis;   ///< at vertices
  EyeMaterials materials;
  std::vector<Light> lights;  ///< without a surface
  std::vector<double> aimed;  ///< L * bands: irradiance by those that are aimed
  /// L * bands: emission, and what eyes reflect of aimed lights.
  std::vector<float> source;
  /// By band, the largest emission, or irradiance by lights under an open sky if that is more.
  /// Changes are relative to it.
  std::vector<double> largest_source;

  /// Irradiance of an eye by lights, W/m^2. `open`: the share of its view that meets nothing.
  double byLights(std::size_t eye, std::size_t band, double open) const;
  /// Whether a patch emits or a light shines in some band.
  bool isLit() const;

 private:
  void standAtPatches(const PatchMaterials& of_patches, const GatherOptions& options);
  void standAtVertices(const PatchMaterials& of_patches, const GatherOptions& options);
  void findSources(Progress& progress);
};

/// gather() in a scene with these options. `eye`: null for the CPU's.
Gathered gatherIn(const GatherScene& scene, std::unique_ptr<GpuEye> eye,
                  const GatherOptions& options, Progress& progress);

/// One thread's hemicube and sums.
class Gatherer {
 public:
  /// Both are kept by reference.
  Gatherer(const GatherScene& scene, const std::vector<float>& radiosity);

  struct Received {
    std::span<const double> irradiance;  ///< bands; until the next look
    double fronts = 0;
    double backs = 0;
    double sky = 0;
  };
  Received look(std::size_t eye);
  /// The share of the last view on each surface's back, by surface.
  std::span<const double> backsBySurface() const;
  const HemicubeReport& counts() const { return hemicube_.counts(); }
  std::size_t bytes() const { return hemicube_.bytes() + (view_ ? view_->bytes() : 0); }

 private:
  const GatherScene& scene_;
  const std::vector<float>& radiosity_;
  Hemicube hemicube_;
  const HemicubeView* seen_ = nullptr;  ///< the last look's
  std::vector<double> irradiance_;      ///< the last look's
  std::vector<std::uint8_t> hidden_;
  std::optional<InterpolatedView> view_;
};

}  // namespace radiosity
