#include "mesh/cells/region/refine_region.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>

#include "mesh/cells/region/region_angles.h"

namespace radiosity {

namespace {

const AngleLimit kAcceptedAngle(18.0);         // a new point must reach this around itself
const double kWorthwhile = glm::radians(2.0);  // and gain this much

}  // namespace

void RegionRefiner::refine() {
  RegionTriangulation& cdt = region_.cdt();
  std::vector<std::array<RegionVertex, 3>> worst;
  const auto note = [&](RegionFace f) {
    if (f->info() && (isTurnedOver(f) || kWantedAngle.isAbove(smallestFreeAngle(f)))) {
      worst.push_back({f->vertex(0), f->vertex(1), f->vertex(2)});
    }
  };
  for (RegionFace f : cdt.finite_face_handles()) note(f);
  std::vector<RegionFace> changed;
  for (std::size_t k = 0; k < worst.size() && inserted_ < budget_; ++k) {
    RegionFace f;
    if (!cdt.is_face(worst[k][0], worst[k][1], worst[k][2], f) || !f->info()) continue;
    changed.clear();
    if (improve(f, changed)) {
      for (RegionFace g : changed) note(g);
    }
  }
}

/// Judges a point at p, which would remove `bad`, by the triangles that it would make. They are
/// known beforehand: p joined to the boundary of its conflict zone (Bowyer-Watson).
RegionRefiner::Trial RegionRefiner::tryPoint(const RegionTriangulation::Point& p, RegionFace bad) {
  Trial trial;
  RegionTriangulation& cdt = region_.cdt();
  RegionFace& where = trial.where;
  RegionTriangulation::Locate_type type;
  int i = 0;
  where = cdt.locate(p, type, i, bad);
  if (type == RegionTriangulation::VERTEX || cdt.is_infinite(where) || !where->info()) return trial;
  if (type == RegionTriangulation::EDGE && where->is_constrained(i)) return trial;
  std::vector<RegionFace> zone;
  std::vector<RegionTriangulation::Edge> rim;
  cdt.get_conflicts_and_boundary(p, std::back_inserter(zone), std::back_inserter(rim), where);
  if (std::find(zone.begin(), zone.end(), bad) == zone.end()) return trial;
  Angle after;
  trial.clear = true;
  for (const auto& [f, side] : rim) {
    const Vec2 a = positionOf(f->vertex(RegionTriangulation::ccw(side)));
    const Vec2 b = positionOf(f->vertex(RegionTriangulation::cw(side)));
    const Vec2 q(p.x(), p.y());
    lower(after, smallestOf(q, a, b));
    if (!f->is_constrained(side)) continue;
    if (glm::dot(a - q, b - q) < 0) trial.clear = false;
    if (heightOver(q, a, b) <= region_.region().clearance) return {};
  }
  if (kAcceptedAngle.isAbove(after)) return trial;
  WorstAngle before;
  for (RegionFace f : zone) before.add(f);
  if (after.radians() >= before.radians() + kWorthwhile) trial.gain = after.radians();
  return trial;
}

bool RegionRefiner::improve(RegionFace bad, std::vector<RegionFace>& changed) {
  const Vec2 p[3] = {positionOf(bad->vertex(0)), positionOf(bad->vertex(1)),
                     positionOf(bad->vertex(2))};
  Trial best;
  RegionTriangulation::Point best_point;
  bool first = true;
  for (const Vec2& candidate : candidatesFor(p)) {
    const RegionTriangulation::Point q = pointOf(candidate);
    if (!std::isfinite(q.x()) || !std::isfinite(q.y())) continue;
    const Trial trial = tryPoint(q, bad);
    // The first candidate is the circumcentre. If it is clear of the boundary, we insert it even
    // without a gain: no new edge is shorter than the triangle's radius, so that points spread out
    // from small features, farther and farther apart (Ruppert 1995).
    const bool spread = first && trial.clear;
    first = false;
    if (!spread && trial.gain <= best.gain) continue;
    best = trial;
    best_point = q;
    if (spread) break;
  }
  if (best.where == RegionFace()) return false;
  const RegionVertex v = region_.insert(best_point, best.where);
  ++inserted_;
  RegionTriangulation::Face_circulator f = region_.cdt().incident_faces(v);
  const RegionTriangulation::Face_circulator end = f;
  do {
    changed.push_back(f);
  } while (++f != end);
  return true;
}

}  // namespace radiosity
