// The view of single points: elements, past flat occluders. Solids, which the exact method puts in
// the place of closed bodies, and polygons that it leaves out since nothing is behind them, are
// proved for points of patches alone; here every polygon blocks by itself.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "visibility/elements/elements.h"
#include "visibility/shadows/tree.h"

namespace radiosity {

/// A point that looks, in ElementSet's coordinates.
struct Sensor {
  Vec3 eye{0.0};
  Vec3 normal{0.0};
  double horizon = 0;
  std::vector<Index> touched;  ///< occluders that it lies on, which are below its horizon; sorted
};

class SensorView {
 public:
  SensorView(const PatchMesh& mesh, Progress& progress);

  const ElementSet& elements() const { return elements_; }

  /// The sensor at a point, off the surfaces that it lies on. `normal`: unit.
  Sensor placed(const Vec3& eye, const Vec3& normal) const;

  /// Whether the sensor is in front of the facet, which is no black back.
  bool faces(const Sensor& sensor, const Facet& facet) const;

  /// The form factor from the sensor to element e of a facet that it faces.
  double visible(const Sensor& sensor, const Facet& facet, Index e) const;

  /// A triangle or convex quadrilateral in one plane, its front to the sensor.
  struct Target {
    std::span<const Vec3> outline;
    Vec3 normal{0.0};
    double offset = 0;  ///< of its plane
    Vec3 centre{0.0};
    double radius = 0;  ///< of a ball about the centre that holds it
  };
  /// The form factor to it; none if more than `most` occluders may be in between.
  std::optional<double> visible(const Sensor& sensor, const Target& target, std::size_t most) const;

 private:
  bool isOn(const Occluder& flat, const Vec3& at) const;

  ElementSet elements_;
  std::vector<Occluder> occluders_;
  OccluderTree tree_;
};

}  // namespace radiosity
