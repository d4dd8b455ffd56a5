#include "visibility/occluders/cover.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "base/geometry/plane_frame.h"

namespace radiosity {
namespace {

using CoverPiece = std::vector<Vec3>;

/// Parts of a convex piece below and above a plane; an empty one has no corners.
void split(const CoverPiece& piece, const Occluder::Plane& plane, CoverPiece& below,
           CoverPiece& above) {
  below.clear();
  above.clear();
  for (std::size_t k = 0; k < piece.size(); ++k) {
    const Vec3& a = piece[k];
    const Vec3& b = piece[(k + 1) % piece.size()];
    const double da = glm::dot(plane.normal, a) - plane.offset;
    const double db = glm::dot(plane.normal, b) - plane.offset;
    if (da <= 0) below.push_back(a);
    if (da >= 0) above.push_back(a);
    if (da * db < 0) {
      const Vec3 crossing = a + (b - a) * (da / (da - db));
      below.push_back(crossing);
      above.push_back(crossing);
    }
  }
}

/// True if a piece is too thin to block anything: between lines a coincidence apart.
bool isThin(const CoverPiece& piece, double coincidence) {
  if (piece.size() < 3) return true;
  double length = 0;
  for (const Vec3& p : piece) length = std::max(length, glm::distance(p, piece[0]));
  const Vec3 area = vectorArea(piece.size(), [&](std::size_t k) { return piece[k]; });
  return glm::length(area) <= coincidence * length;
}

/// A face that lies in the polygon's plane, or kNone.
Index coplanarFace(const OccluderPolygon& polygon, const std::vector<CoverPiece>& pieces,
                   const Occluder& solid, double coincidence) {
  for (Index k = 0; k < solid.planes.size(); ++k) {
    const Occluder::Plane& plane = solid.planes[k];
    // Only to save time: distances decide below.
    if (std::abs(glm::dot(plane.normal, polygon.normal)) < 0.5) continue;
    bool on = true;
    for (const CoverPiece& piece : pieces) {
      for (const Vec3& p : piece) {
        on = on && std::abs(glm::dot(plane.normal, p) - plane.offset) <= coincidence;
      }
    }
    if (on) return k;
  }
  return kNone;
}

}  // namespace

bool isCoveredBySolids(const OccluderPolygons& all, const OccluderPolygon& polygon,
                       std::span<const Occluder> solids, const BoxTree& places) {
  std::vector<Index> near;
  places.query(polygon.box, [&](Index s) {
    near.push_back(s);
    return true;
  });
  if (near.empty()) return false;
  std::sort(near.begin(), near.end());
  std::vector<CoverPiece> open;
  for (const auto& t : all.trianglesOf(polygon)) {
    open.push_back({all.vertices[t[0]], all.vertices[t[1]], all.vertices[t[2]]});
  }
  if (open.empty()) return false;
  const Vec3 middle = 0.5 * (polygon.box.low + polygon.box.high);
  const double radius = 0.5 * glm::distance(polygon.box.low, polygon.box.high);
  CoverPiece below;
  CoverPiece above;
  for (const Index s : near) {
    const Occluder& solid = solids[s];
    if (glm::distance(middle, solid.centre) > radius + solid.radius) continue;
    const Index face = coplanarFace(polygon, open, solid, all.coincidence);
    if (face == kNone) continue;
    std::vector<CoverPiece> left;
    for (CoverPiece& piece : open) {
      for (Index k = 0; k < solid.planes.size() && !piece.empty(); ++k) {
        if (k == face) continue;
        split(piece, solid.planes[k], below, above);
        if (!isThin(above, all.coincidence)) left.push_back(above);
        if (isThin(below, all.coincidence)) below.clear();
        piece = below;
      }
    }
    open = std::move(left);
    if (open.empty()) return true;
  }
  return open.empty();
}

}  // namespace radiosity
