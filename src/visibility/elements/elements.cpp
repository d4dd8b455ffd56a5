#include "visibility/elements/elements.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>
#include <tuple>

#include "base/geometry/box.h"
#include "mesh/patches/enclosures.h"
#include "visibility/elements/backs_hidden_from_all.h"
#include "visibility/elements/clusters.h"
#include "visibility/elements/convex_pieces.h"

namespace radiosity {
namespace {

/// An element before it has a place.
struct Piece {
  Index patch;
  std::array<Vec3, 4> corners;
  std::uint8_t count;
};

/// Corners this near to their neighbours' line, in a scene of size 1, are on it but for rounding.
constexpr double kOnLine = 0x1p-44;
/// The parts of a patch may have this share more or less area than the patch.
constexpr double kSameArea = 1e-10;

/// An outline without the corners that its neighbours' edges were cut at.
std::vector<Vec3> withoutLevelCorners(std::vector<Vec3> outline) {
  for (std::size_t k = 0; k < outline.size() && outline.size() > 3;) {
    const Vec3& before = outline[(k + outline.size() - 1) % outline.size()];
    const Vec3& after = outline[(k + 1) % outline.size()];
    const Vec3 across = glm::cross(after - before, outline[k] - before);
    const bool goes_on = glm::dot(outline[k] - before, after - outline[k]) > 0;
    if (goes_on && glm::length(across) <= kOnLine * glm::distance(after, before)) {
      outline.erase(outline.begin() + std::ptrdiff_t(k));
    } else {
      ++k;
    }
  }
  return outline;
}

/// A triangle or a quadrilateral; a triangle's fourth corner repeats its third.
Piece makePiece(Index patch, const std::vector<Vec3>& corners) {
  Piece piece{patch, {}, std::uint8_t(corners.size())};
  for (std::size_t k = 0; k < 4; ++k) piece.corners[k] = corners[std::min(k, corners.size() - 1)];
  return piece;
}

/// Vector area of triangles 012 and 023; the second is nothing in a triangle.
std::array<Vec3, 2> halves(const std::array<Vec3, 4>& c) {
  return {0.5 * glm::cross(c[1] - c[0], c[2] - c[0]), 0.5 * glm::cross(c[2] - c[0], c[3] - c[0])};
}

/// A corner that lies back from its neighbours' line by less than coincidence is level with it.
bool isConvex(const std::vector<Vec3>& outline, const Vec3& normal, double coincidence) {
  const std::size_t n = outline.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 in = outline[(k + 1) % n] - outline[k];
    const Vec3 out = outline[(k + 2) % n] - outline[(k + 1) % n];
    const double turn = glm::dot(glm::cross(in, out), normal);
    if (turn < -coincidence * glm::length(in + out)) return false;
  }
  return true;
}

}  // namespace

/// Fills an ElementSet facet by facet.
class ElementBuilder {
 public:
  ElementBuilder(const PatchMesh& mesh, ElementSet& set, const Progress& progress,
                 std::span<const std::uint8_t> leading)
      : mesh_(mesh), set_(set), progress_(progress), leads_(mesh.polygons.size(), 0) {
    for (std::size_t i = 0; i < leading.size(); ++i) {
      if (leading[i] != 0 && mesh.polygon[i] != kNone) leads_[mesh.polygon[i]] = 1;
    }
  }

  void build() {
    normalise();
    const std::vector<Index> order = polygonOrder();
    const std::vector<std::array<std::vector<Index>, 2>> patches = patchesOfSides();
    for (const Index p : order) {
      progress_.check();
      for (std::size_t side = 0; side < 2; ++side) addSide(p, side == 1, patches[p][side]);
      if (leads_[p] != 0) set_.leading_elements = set_.size();
    }
    set_.patch_elements = set_.size();
    const std::vector<std::uint8_t> hidden = backsHiddenFromAll(mesh_);
    for (const Index p : order) {
      progress_.check();
      for (std::size_t side = 0; side < 2; ++side) {
        if (patches[p][side].empty() && !(side == 1 && hidden[p])) addBlackSide(p, side == 1);
      }
    }
  }

 private:
  void normalise() {
    if (mesh_.vertices.empty()) return;
    const Box3 box = boxOf(mesh_.vertices);
    set_.middle = box.centre();
    const double diagonal = box.diagonal();
    if (!(diagonal > 0)) return;
    int exponent = 0;
    std::frexp(diagonal, &exponent);
    set_.scale = std::ldexp(1.0, -exponent);
    set_.coincidence = coincidenceOf(mesh_) * set_.scale;
  }

  Vec3 place(Index vertex) const { return (mesh_.vertices[vertex] - set_.middle) * set_.scale; }

  std::vector<Index> polygonOrder() const {
    const PlanarPolygons& polygons = mesh_.polygons;
    std::vector<Index> order(polygons.size());
    std::iota(order.begin(), order.end(), Index(0));
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
      if (leads_[a] != leads_[b]) return leads_[a] > leads_[b];
      return std::tie(mesh_.surface_names[polygons.surface[a]], polygons.index_in_surface[a]) <
             std::tie(mesh_.surface_names[polygons.surface[b]], polygons.index_in_surface[b]);
    });
    return order;
  }

  /// The patches with area of every polygon's front and back, by index within the surface.
  std::vector<std::array<std::vector<Index>, 2>> patchesOfSides() const {
    std::vector<std::array<std::vector<Index>, 2>> patches(mesh_.polygons.size());
    for (Index i = 0; i < mesh_.size(); ++i) {
      if (mesh_.polygon[i] == kNone || !(mesh_.area[i] > 0)) continue;
      patches[mesh_.polygon[i]][mesh_.side[i] != 0].push_back(i);
    }
    for (auto& sides : patches) {
      for (auto& side : sides) {
        std::sort(side.begin(), side.end(), [&](Index a, Index b) {
          return mesh_.index_in_surface[a] < mesh_.index_in_surface[b];
        });
      }
    }
    return patches;
  }

  void appendPieces(Index patch, std::vector<Piece>& pieces) const {
    const Vec3& normal = mesh_.normal[patch];
    std::vector<Vec3> corners;
    for (const Index vertex : mesh_.outline(patch)) corners.push_back(place(vertex));
    if (corners.size() > 4) corners = withoutLevelCorners(corners);
    if (corners.size() <= 4 && isConvex(corners, normal, set_.coincidence)) {
      const Piece piece = makePiece(patch, corners);
      const auto [first, second] = halves(piece.corners);
      if (glm::dot(first + second, normal) > 0) pieces.push_back(piece);
      return;
    }
    const std::size_t triangles = mesh_.piece_offset[patch + 1] - mesh_.piece_offset[patch];
    const std::vector<Piece> trapezoids = trapezoidsOf(patch, corners);
    if (!trapezoids.empty() && trapezoids.size() < triangles) {
      pieces.insert(pieces.end(), trapezoids.begin(), trapezoids.end());
      return;
    }
    for (std::size_t t = mesh_.piece_offset[patch]; t < mesh_.piece_offset[patch + 1]; ++t) {
      corners.clear();
      for (const Index vertex : mesh_.pieces[t]) corners.push_back(place(vertex));
      const Piece piece = makePiece(patch, corners);
      if (glm::dot(halves(piece.corners)[0], normal) > 0) pieces.push_back(piece);
    }
  }

  /// A patch's trapezoids; none if their area is not the patch's but for rounding.
  std::vector<Piece> trapezoidsOf(Index patch, const std::vector<Vec3>& corners) const {
    const Vec3& normal = mesh_.normal[patch];
    const Vec3 middle = corners.front();
    std::vector<Vec3> loop;
    loop.reserve(corners.size());
    for (const Vec3& corner : corners) loop.push_back(corner - middle);
    std::vector<Piece> pieces;
    double area = 0;
    for (std::vector<Vec3>& part : convexPieces({loop}, normal, 0)) {
      for (Vec3& corner : part) corner += middle;
      const Piece piece = makePiece(patch, part);
      const auto [first, second] = halves(piece.corners);
      const double found = glm::dot(first + second, normal);
      if (!(found > 0)) continue;
      area += found;
      pieces.push_back(piece);
    }
    const double wanted = mesh_.area[patch] * set_.scale * set_.scale;
    if (std::abs(area - wanted) > kSameArea * wanted) return {};
    return pieces;
  }

  void addSide(Index polygon, bool back, const std::vector<Index>& patches) {
    std::vector<Piece> pieces;
    for (const Index patch : patches) appendPieces(patch, pieces);
    addFacet(polygon, back, false, pieces);
  }

  void addBlackSide(Index polygon, bool back) {
    const double sign = back ? -1 : 1;
    const auto loops = polygonLoops(mesh_, polygon, set_.middle, set_.scale);
    const Vec3& normal = mesh_.polygons.normal[polygon];
    const Index item = Index(mesh_.size()) + mesh_.polygons.surface[polygon];
    std::vector<Piece> pieces;
    for (auto& corners : convexPieces(loops, normal, set_.coincidence)) {
      if (back) std::reverse(corners.begin(), corners.end());
      const Piece piece = makePiece(item, corners);
      const auto [first, second] = halves(piece.corners);
      if (sign * glm::dot(first + second, normal) > 0) pieces.push_back(piece);
    }
    addFacet(polygon, back, true, pieces);
  }

  void addFacet(Index polygon, bool back, bool black, const std::vector<Piece>& pieces) {
    if (pieces.empty()) return;
    const auto loops = polygonLoops(mesh_, polygon, set_.middle, set_.scale);
    Facet facet;
    facet.polygon = polygon;
    facet.back = back;
    facet.black = black;
    facet.normal = mesh_.polygons.normal[polygon] * (back ? -1.0 : 1.0);
    const Vec3 origin = (mesh_.polygons.origin[polygon] - set_.middle) * set_.scale;
    facet.offset = glm::dot(facet.normal, origin);
    facet.elements = {Index(set_.size()), Index(set_.size() + pieces.size())};

    const PlaneFrame frame = polygonFrame(loops, facet.normal);
    std::vector<FlatElement> flat;
    for (const Piece& piece : pieces) {
      FlatElement& element = flat.emplace_back();
      element.item = Index(flat.size() - 1);
      element.lower = element.upper = frame.flat(piece.corners[0]);
      for (const Vec3& corner : piece.corners) {
        element.lower = glm::min(element.lower, frame.flat(corner));
        element.upper = glm::max(element.upper, frame.flat(corner));
      }
    }
    // Pieces of one patch share a middle, so that they stay next to each other.
    for (std::size_t first = 0; first < pieces.size();) {
      Vec2 lower = flat[first].lower;
      Vec2 upper = flat[first].upper;
      std::size_t end = first + 1;
      for (; !black && end < pieces.size() && pieces[end].patch == pieces[first].patch; ++end) {
        lower = glm::min(lower, flat[end].lower);
        upper = glm::max(upper, flat[end].upper);
      }
      for (; first < end; ++first) flat[first].middle = 0.5 * (lower + upper);
    }
    facet.root = appendClusters(flat, frame, facet.elements.first, set_.clusters);
    for (const FlatElement& element : flat) append(pieces[element.item]);
    set_.facets.push_back(facet);
  }

  void append(const Piece& piece) {
    const auto [first, second] = halves(piece.corners);
    const double a = glm::length(first);
    const double b = glm::length(second);
    // About the first corner, so that nothing cancels.
    const auto& c = piece.corners;
    const Vec3 moment = (c[1] - c[0] + (c[2] - c[0])) * a + (c[2] - c[0] + (c[3] - c[0])) * b;
    const Vec3 centroid = c[0] + (a + b > 0 ? moment / (3 * (a + b)) : Vec3(0.0));
    double radius = 0;
    for (const Vec3& corner : c) radius = std::max(radius, glm::distance(corner, centroid));
    set_.patch.push_back(piece.patch);
    set_.facet.push_back(Index(set_.facets.size()));
    set_.corners.push_back(c);
    set_.corner_count.push_back(piece.count);
    set_.centroid.push_back(centroid);
    set_.area.push_back(a + b);
    set_.radius.push_back(radius);
  }

  const PatchMesh& mesh_;
  ElementSet& set_;
  const Progress& progress_;
  std::vector<std::uint8_t> leads_;  ///< of polygons
};

ElementSet::ElementSet(const PatchMesh& mesh) : ElementSet(mesh, Progress()) {}

ElementSet::ElementSet(const PatchMesh& mesh, const Progress& progress,
                       std::span<const std::uint8_t> leading) {
  ElementBuilder(mesh, *this, progress, leading).build();
}

}  // namespace radiosity
