// Light of emitters at points, with what hides them clipped off exactly.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "elements/emitters.h"
#include "radiosity/patch_mesh.h"
#include "visibility/sensor_view.h"

namespace radiosity {

class ClippedLight {
 public:
  /// Keeps `materials` by reference. Of more emitters than kMostClippedEmitters it is empty. Throws
  /// Cancelled.
  ClippedLight(const PatchMesh& mesh, const PatchMaterials& materials, Progress& progress);

  bool empty() const { return emitters_.empty(); }
  /// Adds the irradiance of a small surface, W/m^2 a band; false, with nothing added, if more than
  /// `most` occluders may be in between it and one of the emitters.
  bool add(const Vec3& at, const Vec3& normal, std::size_t most, std::span<double> sum) const;

 private:
  const PatchMaterials& materials_;
  std::unique_ptr<SensorView> view_;  ///< null if it is empty
  std::vector<Emitter> emitters_;
};

}  // namespace radiosity
