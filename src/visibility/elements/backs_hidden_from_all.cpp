#include "visibility/elements/backs_hidden_from_all.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "base/geometry/box_tree.h"
#include "base/geometry/point_tree.h"
#include "mesh/patches/enclosures.h"

namespace radiosity {
namespace {

/// Winding numbers of one scene may take this many solid angles of triangles, a few hundredths of
/// a second; a surface that needs more is not proved.
constexpr std::size_t kMostSolidAngles = 1000000;

class BacksHiddenFromAll {
 public:
  explicit BacksHiddenFromAll(const PatchMesh& mesh)
      : mesh_(mesh),
        enclosures_(enclosuresOf(mesh, found_)),
        coincidence_(coincidenceOf(mesh)),
        first_(firstAtSamePoint(mesh)),
        vertices_(usedVertices()),
        patches_of_(mesh.polygons.size()),
        has_back_(mesh.polygons.size(), 0),
        own_vertex_(mesh.vertices.size(), 0),
        own_polygon_(mesh.polygons.size(), 0) {
    std::vector<Box3> boxes(mesh.polygons.size());
    for (Index p = 0; p < boxes.size(); ++p) {
      for (const Index v : cornersOf(p)) boxes[p].add(mesh.vertices[v]);
    }
    places_ = BoxTree(boxes);
    for (Index i = 0; i < mesh.size(); ++i) {
      if (mesh.polygon[i] == kNone || !(mesh.area[i] > 0)) continue;
      patches_of_[mesh.polygon[i]].push_back(i);
      if (mesh.side[i] != 0) has_back_[mesh.polygon[i]] = 1;
    }
  }

  std::vector<std::uint8_t> find() {
    std::vector<std::uint8_t> hidden = enclosures_.covered;
    for (const ClosedSurface& surface : enclosures_.surfaces) {
      const bool proved = allOnFrontSide(surface);
      for (const Index p : surface.polygons) hidden[p] |= std::uint8_t(proved);
    }
    for (Index p = 0; p < hidden.size(); ++p) {
      hidden[p] = has_back_[p] == 0 && (hidden[p] != 0 || allInFront(p));
    }
    return hidden;
  }

 private:
  std::span<const Index> cornersOf(Index p) const {
    const PlanarPolygons& all = mesh_.polygons;
    const std::size_t begin = all.corner_offset[all.loopBegin(p)];
    return {all.corners.data() + begin, all.corner_offset[all.loopEnd(p)] - begin};
  }

  /// Points at which polygons have corners.
  std::vector<Vec3> usedVertices() const {
    std::vector<Index> used;
    used.reserve(mesh_.polygons.corners.size());
    for (const Index v : mesh_.polygons.corners) used.push_back(first_[v]);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<Vec3> points;
    points.reserve(used.size());
    for (const Index v : used) points.push_back(mesh_.vertices[v]);
    return points;
  }

  bool allInFront(Index p) const {
    const Vec3& normal = mesh_.polygons.normal[p];
    const double offset = glm::dot(normal, mesh_.polygons.origin[p]);
    return !vertices_.anyAbove(-normal, coincidence_ - offset);
  }

  /// Whether every patch that is not the surface's own lies on the side its fronts face: its
  /// middle, and its polygon's corners unless they are corners of the surface too.
  bool allOnFrontSide(const ClosedSurface& surface) {
    ++stamp_;
    for (const Index p : surface.polygons) {
      own_polygon_[p] = stamp_;
      for (const Index v : cornersOf(p)) own_vertex_[first_[v]] = stamp_;
    }
    bool proved = true;
    const auto look = [&](Index p) {
      proved = own_polygon_[p] == stamp_ || isOnFrontSide(surface, p);
      return proved;
    };
    if (surface.is_solid) {  // all outside of its box is on its front side
      places_.query({surface.lower, surface.upper}, look);
    } else {
      for (Index p = 0; p < mesh_.polygons.size() && look(p); ++p) {
      }
    }
    return proved;
  }

  bool isOnFrontSide(const ClosedSurface& surface, Index p) {
    for (const Index v : cornersOf(p)) {
      if (own_vertex_[first_[v]] == stamp_) continue;
      if (!isPointOnFrontSide(surface, mesh_.vertices[v])) return false;
    }
    const std::vector<Index>& patches = patches_of_[p];
    return std::all_of(patches.begin(), patches.end(),
                       [&](Index i) { return isPointOnFrontSide(surface, mesh_.centroid[i]); });
  }

  bool isPointOnFrontSide(const ClosedSurface& surface, const Vec3& point) {
    if (Box3{surface.lower, surface.upper}.contains(point)) {
      for (const Index p : surface.polygons) solid_angles_ += cornersOf(p).size();
    }
    return solid_angles_ <= kMostSolidAngles && radiosity::isOnFrontSide(mesh_, surface, point);
  }

  const PatchMesh& mesh_;
  std::optional<Enclosures> found_;  // if the mesh does not have them
  const Enclosures& enclosures_;
  const double coincidence_;
  const std::vector<Index> first_;
  const PointTree vertices_;
  BoxTree places_;                              // boxes of polygons
  std::vector<std::vector<Index>> patches_of_;  // of the mesh's polygons
  std::vector<std::uint8_t> has_back_;          // 1: the back has patches
  std::vector<std::uint32_t> own_vertex_;       // stamps: of the surface in question
  std::vector<std::uint32_t> own_polygon_;
  std::uint32_t stamp_ = 0;
  std::size_t solid_angles_ = 0;
};

}  // namespace

std::vector<std::uint8_t> backsHiddenFromAll(const PatchMesh& mesh) {
  return BacksHiddenFromAll(mesh).find();
}

}  // namespace radiosity
