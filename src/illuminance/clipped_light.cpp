#include "illuminance/clipped_light.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>

#include "elements/direct_light.h"

namespace radiosity {

ClippedLight::ClippedLight(const PatchMesh& mesh, const PatchMaterials& materials,
                           Progress& progress)
    : materials_(materials), emitters_(findEmitters(mesh, ElementSet(mesh), materials)) {
  if (emitters_.size() > kMostClippedEmitters) emitters_.clear();
  if (!emitters_.empty()) view_ = std::make_unique<SensorView>(mesh, progress);
}

bool ClippedLight::add(const Vec3& at, const Vec3& normal, std::size_t most,
                       std::span<double> sum) const {
  thread_local std::vector<double> found;
  found.assign(sum.size(), 0.0);
  const ElementSet& elements = view_->elements();
  const Sensor sensor = view_->placed((at - elements.middle) * elements.scale, normal);
  for (const Emitter& emitter : emitters_) {
    if (!(glm::dot(emitter.normal, sensor.eye) > emitter.offset)) continue;
    const SensorView::Target target{emitter.outline, emitter.normal, emitter.offset, emitter.centre,
                                    emitter.radius};
    const std::optional<double> factor = view_->visible(sensor, target, most);
    if (!factor) return false;
    const double* exitance = materials_.emission.data() + emitter.patch * sum.size();
    for (std::size_t b = 0; b < sum.size(); ++b) found[b] += *factor * exitance[b];
  }
  std::ranges::transform(sum, found, sum.begin(), std::plus<>());
  return true;
}

}  // namespace radiosity
