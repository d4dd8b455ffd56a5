#include "mesh/cells/region/smooth_region.h"

#include "mesh/cells/region/region_angles.h"

namespace radiosity {

namespace {

constexpr int kSmoothingSweeps = 4;

WorstAngle worstAround(RegionTriangulation& cdt, RegionVertex v) {
  WorstAngle out;
  RegionTriangulation::Face_circulator f = cdt.incident_faces(v);
  const RegionTriangulation::Face_circulator end = f;
  do {
    out.add(f);
  } while (++f != end);
  return out;
}

/// Moves a free vertex towards the mean of its neighbours as far as its smallest angle grows.
bool relax(RegionTriangulation& cdt, RegionVertex v) {
  const WorstAngle before = worstAround(cdt, v);
  if (!before.isBelow(kWantedAngle)) return false;
  Vec2 mean(0.0);
  double count = 0;
  RegionTriangulation::Vertex_circulator w = cdt.incident_vertices(v);
  const RegionTriangulation::Vertex_circulator end = w;
  do {
    mean += positionOf(w);
    count += 1;
  } while (++w != end);
  mean /= count;
  const RegionTriangulation::Point old = v->point();
  const Vec2 from = positionOf(v);
  for (const double step : {1.0, 0.5, 0.25, -0.25}) {
    v->set_point(pointOf(from + step * (mean - from)));
    if (before.isBelow(worstAround(cdt, v))) return true;
  }
  v->set_point(old);
  return false;
}

}  // namespace

void smoothInside(TriangulatedRegion& region) {
  for (int sweep = 0; sweep < kSmoothingSweeps; ++sweep) {
    bool moved = false;
    for (RegionVertex v : region.cdt().finite_vertex_handles()) {
      if (region.isFree(v)) moved = relax(region.cdt(), v) || moved;
    }
    if (!moved) return;
  }
}

}  // namespace radiosity
