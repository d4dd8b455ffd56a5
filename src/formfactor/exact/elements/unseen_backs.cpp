#include "formfactor/exact/elements/unseen_backs.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "base/geometry/box_tree.h"
#include "base/geometry/point_tree.h"
#include "formfactor/hidden_backs.h"

namespace radiosity {
namespace {

/// Winding numbers of one scene may take this many solid angles of triangles, a few hundredths of
/// a second; a surface that needs more is not proved.
constexpr std::size_t kMostSolidAngles = 1000000;

class UnseenBacks {
 public:
  explicit UnseenBacks(const PatchMesh& mesh)
      : mesh_(mesh),
        scene_(mesh, false),
        backs_(scene_),
        vertices_(scene_.vertices),
        patches_of_(mesh.polygons.size()),
        own_vertex_(scene_.vertices.size(), 0),
        own_polygon_(scene_.polygons.size(), 0) {
    std::vector<Box3> boxes(scene_.polygons.size());
    for (Index p = 0; p < boxes.size(); ++p) {
      forCorners(scene_.polygons[p], [&](std::uint32_t v) { boxes[p].add(scene_.vertices[v]); });
    }
    places_ = BoxTree(std::move(boxes));
    for (Index i = 0; i < mesh.size(); ++i) {
      if (mesh.polygon[i] != kNone && mesh.area[i] > 0) patches_of_[mesh.polygon[i]].push_back(i);
    }
  }

  std::vector<std::uint8_t> find() {
    std::vector<std::uint8_t> unseen = backs_.covered();
    for (const ClosedSurface& surface : backs_.closedSurfaces()) {
      const bool proved = allOnFrontSide(surface);
      for (const Index p : surface.polygons) unseen[p] |= std::uint8_t(proved);
    }
    std::vector<std::uint8_t> of_mesh(mesh_.polygons.size(), 0);
    for (Index p = 0; p < scene_.polygons.size(); ++p) {
      const ViewPolygon& polygon = scene_.polygons[p];
      const bool bare = polygon.side[1].grid == kNone && polygon.side[1].item >= scene_.patches;
      of_mesh[polygon.source] = bare && (unseen[p] || allInFront(polygon));
    }
    return of_mesh;
  }

 private:
  bool allInFront(const ViewPolygon& polygon) const {
    const double offset = glm::dot(polygon.normal, polygon.origin);
    return !vertices_.anyAbove(-polygon.normal, scene_.coincidence - offset);
  }

  template <class Visit>
  void forCorners(const ViewPolygon& polygon, Visit&& visit) const {
    const std::uint32_t begin = scene_.loop_offset[polygon.loop_begin];
    const std::uint32_t end = scene_.loop_offset[polygon.loop_end];
    for (std::uint32_t k = begin; k < end; ++k) visit(scene_.corners[k]);
  }

  /// Whether every patch that is not the surface's own lies on the side its fronts face: its
  /// middle, and its polygon's corners unless they are corners of the surface too.
  bool allOnFrontSide(const ClosedSurface& surface) {
    ++stamp_;
    for (const Index p : surface.polygons) {
      own_polygon_[p] = stamp_;
      forCorners(scene_.polygons[p], [&](std::uint32_t v) { own_vertex_[v] = stamp_; });
    }
    bool proved = true;
    const auto look = [&](Index p) {
      proved = own_polygon_[p] == stamp_ || isOnFrontSide(surface, scene_.polygons[p]);
      return proved;
    };
    if (surface.outward) {  // all that is out of its box is on its front side
      places_.query({surface.lower, surface.upper}, look);
    } else {
      for (Index p = 0; p < scene_.polygons.size() && look(p); ++p) {
      }
    }
    return proved;
  }

  bool isOnFrontSide(const ClosedSurface& surface, const ViewPolygon& polygon) {
    bool proved = true;
    forCorners(polygon, [&](std::uint32_t v) {
      proved = proved && (own_vertex_[v] == stamp_ || onFrontSide(surface, scene_.vertices[v]));
    });
    const std::vector<Index>& patches = patches_of_[polygon.source];
    return proved && std::all_of(patches.begin(), patches.end(), [&](Index i) {
             return onFrontSide(surface, mesh_.centroid[i] * scene_.scale);
           });
  }

  bool onFrontSide(const ClosedSurface& surface, const Vec3& point) {
    const bool in_box = glm::all(glm::greaterThanEqual(point, surface.lower)) &&
                        glm::all(glm::lessThanEqual(point, surface.upper));
    if (in_box) {
      for (const Index p : surface.polygons) {
        forCorners(scene_.polygons[p], [&](std::uint32_t) { ++solid_angles_; });
      }
    }
    return solid_angles_ <= kMostSolidAngles && backs_.onFrontSide(surface, point);
  }

  const PatchMesh& mesh_;
  const ViewScene scene_;
  const HiddenBacks backs_;
  const PointTree vertices_;
  BoxTree places_;                              // boxes of polygons
  std::vector<std::vector<Index>> patches_of_;  // of the mesh's polygons
  std::vector<std::uint32_t> own_vertex_;       // stamps: of the surface in question
  std::vector<std::uint32_t> own_polygon_;
  std::uint32_t stamp_ = 0;
  std::size_t solid_angles_ = 0;
};

}  // namespace

std::vector<std::uint8_t> unseenBacks(const PatchMesh& mesh) { return UnseenBacks(mesh).find(); }

}  // namespace radiosity
