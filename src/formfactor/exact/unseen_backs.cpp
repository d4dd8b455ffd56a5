#include "formfactor/exact/unseen_backs.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "formfactor/hidden_backs.h"

namespace radiosity {
namespace {

/// Winding numbers of one scene may take this many solid angles of triangles, a few hundredths of
/// a second; a surface that needs more is not proved.
constexpr std::size_t kMostSolidAngles = 1000000;

class UnseenBacks {
 public:
  explicit UnseenBacks(const PatchMesh& mesh)
      : mesh_(mesh), scene_(mesh, false), backs_(scene_), patches_of_(mesh.polygons.size()) {
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
    return std::all_of(scene_.vertices.begin(), scene_.vertices.end(), [&](const Vec3& v) {
      return glm::dot(polygon.normal, v - polygon.origin) >= -scene_.coincidence;
    });
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
    std::vector<std::uint8_t> own_vertex(scene_.vertices.size(), 0);
    std::vector<std::uint8_t> own_polygon(scene_.polygons.size(), 0);
    for (const Index p : surface.polygons) {
      own_polygon[p] = 1;
      forCorners(scene_.polygons[p], [&](std::uint32_t v) { own_vertex[v] = 1; });
    }
    bool proved = true;
    for (Index p = 0; p < scene_.polygons.size() && proved; ++p) {
      if (own_polygon[p]) continue;
      const ViewPolygon& polygon = scene_.polygons[p];
      forCorners(polygon, [&](std::uint32_t v) {
        proved = proved && (own_vertex[v] || onFrontSide(surface, scene_.vertices[v]));
      });
      for (const Index i : patches_of_[polygon.source]) {
        proved = proved && onFrontSide(surface, mesh_.centroid[i] * scene_.scale);
      }
    }
    return proved;
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
  std::vector<std::vector<Index>> patches_of_;  // of the mesh's polygons
  std::size_t solid_angles_ = 0;
};

}  // namespace

std::vector<std::uint8_t> unseenBacks(const PatchMesh& mesh) { return UnseenBacks(mesh).find(); }

}  // namespace radiosity
