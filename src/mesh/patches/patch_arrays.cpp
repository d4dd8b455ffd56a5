#include "mesh/patches/patch_arrays.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "mesh/patches/enclosures.h"
#include "mesh/patches/face_locator.h"

namespace radiosity {

namespace {

// The least height of a triangle over a side, as a share of the largest coordinate and of the side.
// Below, the triangle lies on the side but for rounding: its area and centroid are arbitrary, and
// once its corners are moved it may be turned over.
constexpr double kNoArea = 0x1p-44;

/// Numbers the points of the cut complex that are in use: vertices of the complex first, then edge
/// points, then points inside polygons.
class VertexNumbers {
 public:
  VertexNumbers(const CoarseComplex& complex, const EdgeCuts& cuts,
                std::span<const PolygonCells> cells)
      : number_(cuts.pointCount(), kNone) {
    for (const PolygonCells& polygon : cells) {
      for (const Index id : polygon.boundary) number_[id] = 0;
    }
    for (const CoarsePolygon& polygon : complex.polygons) {
      for (const auto& loop : polygon.loops) {
        for (const Index id : loop) number_[id] = 0;
      }
    }
    for (Index id = 0; id < number_.size(); ++id) {
      if (number_[id] == kNone) continue;
      number_[id] = Index(points_.size());
      points_.push_back(cuts.point(id));
    }
    for (const PolygonCells& polygon : cells) {
      first_interior_.push_back(Index(points_.size()));
      points_.insert(points_.end(), polygon.interior.begin(), polygon.interior.end());
    }
  }

  Index ofPoint(Index id) const { return number_[id]; }
  Index ofCorner(const PolygonCells& polygon, std::size_t p, Index corner) const {
    const Index around = Index(polygon.boundary.size());
    return corner < around ? number_[polygon.boundary[corner]]
                           : first_interior_[p] + (corner - around);
  }
  std::vector<Vec3>& points() { return points_; }

 private:
  std::vector<Index> number_;
  std::vector<Index> first_interior_;
  std::vector<Vec3> points_;
};

void appendPolygon(PlanarPolygons& polygons, const CoarsePolygon& coarse,
                   const CoarseComplex& complex, const VertexNumbers& numbers) {
  for (const auto& loop : coarse.loops) {
    for (const Index id : loop) polygons.corners.push_back(numbers.ofPoint(id));
    polygons.corner_offset.push_back(polygons.corners.size());
  }
  polygons.loop_offset.push_back(polygons.corner_offset.size() - 1);
  polygons.normal.push_back(coarse.normal);
  polygons.origin.push_back(complex.vertices[coarse.loops[0][0]] + complex.origin);
  polygons.surface.push_back(coarse.surface);
  polygons.back_is_patch.push_back(coarse.back ? 1 : 0);
}

std::span<const Index> cornersOf(const Cell& cell) {
  return {cell.data(), cell[3] == kNone ? std::size_t(3) : std::size_t(4)};
}

/// Divides convex cells into fans of triangles.
struct CellTriangles {
  std::vector<std::array<Index, 3>> triangles;
  double area = 0;
  Vec3 base{0.0};    ///< a corner
  Vec3 moment{0.0};  ///< area times (centroid - base)

  Vec3 centroid() const { return base + moment / area; }
  /// `corner`: 3 or 4, counter-clockwise about `normal`; positions are `points`. False, and nothing
  /// is added, if rounding leaves the cell no area; `thinnest`: a height that rounding may change
  /// by as much.
  bool add(std::span<const Index> corner, const Vec3& normal, std::span<const Vec3> points,
           double thinnest) {
    double total = 0;
    Vec3 about(0.0);
    const Vec3 first = points[corner[0]];
    for (std::size_t k = 2; k < corner.size(); ++k) {
      const Vec3 a = points[corner[k - 1]] - first;
      const Vec3 b = points[corner[k]] - first;
      const double part = 0.5 * glm::dot(glm::cross(a, b), normal);
      const double height = std::max(thinnest, kNoArea * std::min(glm::length(a), glm::length(b)));
      if (!(part > height * std::max(glm::length(a), glm::length(b)))) return false;
      total += part;
      about += part * (a + b) / 3.0;
    }
    for (std::size_t k = 2; k < corner.size(); ++k) {
      triangles.push_back({corner[0], corner[k - 1], corner[k]});
    }
    if (area == 0) base = first;
    area += total;
    moment += total * (first - base) + about;
    return true;
  }
};

/// Of points that are to be moved by `origin`.
double largestCoordinate(std::span<const Vec3> points, const Vec3& origin) {
  double largest = 0;
  for (const Vec3& p : points) {
    const Vec3 place = glm::max(glm::abs(p), glm::abs(p + origin));
    largest = std::max({largest, place.x, place.y, place.z});
  }
  return largest;
}

/// The corners of a cell by the numbers of the mesh.
class CellCorners {
 public:
  CellCorners(const VertexNumbers& numbers, const PolygonCells& polygon, std::size_t source,
              bool flip)
      : numbers_(numbers), polygon_(polygon), source_(source), flip_(flip) {}

  std::vector<Index> operator()(std::span<const Index> corners) const {
    std::vector<Index> out;
    out.reserve(corners.size());
    for (const Index c : corners) out.push_back(numbers_.ofCorner(polygon_, source_, c));
    if (flip_) std::reverse(out.begin(), out.end());
    return out;
  }

 private:
  const VertexNumbers& numbers_;
  const PolygonCells& polygon_;
  std::size_t source_;
  bool flip_;
};

/// A point that represents a patch: its centroid or, if that is outside, the middle of the nearest
/// triangle.
Vec3 middleOf(const CellTriangles& patch, const Vec3& normal, std::span<const Vec3> points) {
  const Vec3 centroid = patch.centroid();
  Vec3 nearest = centroid;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : patch.triangles) {
    const auto isLeft = [&](Index from, Index to) {
      return glm::dot(glm::cross(points[to] - points[from], centroid - points[from]), normal) >= 0;
    };
    if (isLeft(a, b) && isLeft(b, c) && isLeft(c, a)) return centroid;
    const Vec3 middle = (points[a] + points[b] + points[c]) / 3.0;
    if (glm::distance(middle, centroid) < least) {
      least = glm::distance(middle, centroid);
      nearest = middle;
    }
  }
  return nearest;
}

/// Appends a patch of one or several cells; positions are still near the origin. False, and nothing
/// is appended, if rounding leaves it no area.
bool appendPatch(PatchMesh& mesh, const PolygonCells& polygon, Index number,
                 const CellCorners& corners, std::span<const Vec3> points, double thinnest) {
  const Vec3 normal = mesh.polygons.normal.back();
  CellTriangles patch;
  std::vector<Index> around;
  if (polygon.groups.empty()) {
    around = corners(cornersOf(polygon.cells[number]));
    patch.add(around, normal, points, thinnest);
  } else {
    const CellGroup& group = polygon.groups[number];
    around = corners(group.outline);
    for (const auto& triangle : group.triangles) {
      patch.add(corners(triangle), normal, points, thinnest);
    }
    for (const Index c : group.cells) {
      if (!group.triangles.empty()) break;
      patch.add(corners(cornersOf(polygon.cells[c])), normal, points, thinnest);
    }
  }
  if (patch.triangles.empty()) return false;
  mesh.pieces.insert(mesh.pieces.end(), patch.triangles.begin(), patch.triangles.end());
  mesh.corners.insert(mesh.corners.end(), around.begin(), around.end());
  mesh.corner_offset.push_back(mesh.corners.size());
  mesh.piece_offset.push_back(mesh.pieces.size());
  mesh.area.push_back(patch.area);
  const bool alone = polygon.groups.empty() || polygon.groups[number].cells.size() == 1;
  mesh.centroid.push_back(alone ? patch.centroid() : middleOf(patch, normal, points));
  mesh.normal.push_back(normal);
  return true;
}

void locateSources(PatchMesh& mesh, const CoarseComplex& complex, const Scene& scene,
                   std::span<const std::size_t> first_patch) {
  mesh.source_face.resize(mesh.size());
  parallelFor(complex.polygons.size(), 16, [&](std::size_t p) {
    const CoarsePolygon& polygon = complex.polygons[p];
    const auto begin = mesh.source_face.begin() + std::ptrdiff_t(first_patch[p]);
    const auto end = mesh.source_face.begin() + std::ptrdiff_t(first_patch[p + 1]);
    if (polygon.faces.size() < 2) {
      std::fill(begin, end, polygon.faces.empty() ? kNone : polygon.faces[0]);
      return;
    }
    const PlaneFrame frame = makeFrame(complex.vertices[polygon.loops[0][0]], polygon.normal,
                                       axisAcross(polygon.normal));
    const FaceLocator locator(scene, polygon.faces, frame, complex.origin);
    for (std::size_t i = first_patch[p]; i < first_patch[p + 1]; ++i) {
      mesh.source_face[i] = locator.locate(mesh.centroid[i]).face;
    }
  });
}

}  // namespace

PatchMesh assemblePatches(const CoarseComplex& complex, const Scene& scene, const EdgeCuts& cuts,
                          std::span<const PolygonCells> cells, Progress& progress) {
  progress.check();
  PatchMesh mesh;
  for (const Surface& surface : scene.surfaces) mesh.surface_names.push_back(surface.name);
  VertexNumbers numbers(complex, cuts, cells);
  mesh.corner_offset = mesh.piece_offset = {0};
  mesh.polygons.loop_offset = mesh.polygons.corner_offset = {0};
  std::vector<std::size_t> first_patch;
  std::vector<Index> two_sided;
  const double thinnest = kNoArea * largestCoordinate(numbers.points(), complex.origin);
  for (std::size_t p = 0; p < complex.polygons.size(); ++p) {
    const CoarsePolygon& coarse = complex.polygons[p];
    const std::size_t source = cellSource(complex, p);
    const bool flip = source != p;
    first_patch.push_back(mesh.size());
    appendPolygon(mesh.polygons, coarse, complex, numbers);
    const PolygonCells& polygon = cells[source];
    const CellCorners corners(numbers, polygon, source, flip);
    for (Index k = 0; k < polygon.patches(); ++k) {
      if (!appendPatch(mesh, polygon, k, corners, numbers.points(), thinnest)) continue;
      if (coarse.back) two_sided.push_back(Index(mesh.size() - 1));
      mesh.polygon.push_back(Index(p));
      mesh.surface.push_back(coarse.surface);
    }
  }
  first_patch.push_back(mesh.size());
  locateSources(mesh, complex, scene, first_patch);
  mesh.side.assign(mesh.size(), 0);
  mesh.twin.assign(mesh.size(), kNone);
  mesh.vertices = std::move(numbers.points());
  for (Vec3& vertex : mesh.vertices) vertex += complex.origin;
  for (Vec3& centroid : mesh.centroid) centroid += complex.origin;
  appendBacks(mesh, two_sided);
  numberWithinSurfaces(mesh);
  return mesh;
}

void keepCoincidence(PatchMesh& mesh, double least) {
  // The box of the mesh is the scene's, but for rounding and for what is buried.
  if (least < 0.5 * coincidenceOf(mesh)) mesh.coincidence = least;
}

void appendBacks(PatchMesh& mesh, std::span<const Index> fronts) {
  for (const Index front : fronts) {
    const Index back = Index(mesh.size());
    for (std::size_t k = mesh.corner_offset[front + 1]; k > mesh.corner_offset[front]; --k) {
      mesh.corners.push_back(mesh.corners[k - 1]);
    }
    for (std::size_t k = mesh.piece_offset[front]; k < mesh.piece_offset[front + 1]; ++k) {
      const std::array<Index, 3> piece = mesh.pieces[k];
      mesh.pieces.push_back({piece[0], piece[2], piece[1]});
    }
    mesh.corner_offset.push_back(mesh.corners.size());
    mesh.piece_offset.push_back(mesh.pieces.size());
    mesh.centroid.push_back(Vec3(mesh.centroid[front]));
    mesh.normal.push_back(-mesh.normal[front]);
    mesh.area.push_back(double(mesh.area[front]));
    mesh.polygon.push_back(Index(mesh.polygon[front]));
    mesh.surface.push_back(Index(mesh.surface[front]));
    mesh.source_face.push_back(Index(mesh.source_face[front]));
    mesh.side.push_back(1);
    mesh.twin.push_back(front);
    mesh.twin[front] = back;
  }
}

void numberWithinSurfaces(PatchMesh& mesh) {
  std::vector<Index> next(mesh.surface_names.size(), 0);
  mesh.index_in_surface.clear();
  for (const Index surface : mesh.surface) mesh.index_in_surface.push_back(next[surface]++);
  std::fill(next.begin(), next.end(), 0);
  mesh.polygons.index_in_surface.clear();
  for (const Index surface : mesh.polygons.surface) {
    mesh.polygons.index_in_surface.push_back(next[surface]++);
  }
}

}  // namespace radiosity
