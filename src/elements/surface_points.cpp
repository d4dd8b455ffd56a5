#include "elements/surface_points.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <tuple>

#include "base/geometry/box.h"
#include "elements/element_roots.h"

namespace radiosity {
namespace {

/// The largest inset on curved surfaces, as a share of the diagonal.
constexpr double kLeast = 1e-5;
/// Of two roots in one plane, one is a sliver if its inset is less than this share of the other's.
constexpr double kSliver = 0.2;
/// The least cosine between the way inwards and a smooth edge that leads there.
constexpr double kInwards = 0.5;

/// Whether a point in the plane of a convex root lies on it.
bool isOn(const PatchMesh& mesh, const ElementRoots& roots, std::size_t root, const Vec3& p) {
  const Vec3& normal = mesh.normal[roots.patch[root]];
  const std::size_t n = roots.cornerCount(root);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 a = mesh.vertices[roots.corner[root][k]];
    const Vec3 b = mesh.vertices[roots.corner[root][(k + 1) % n]];
    if (glm::dot(glm::cross(normal, b - a), p - a) < 0) return false;
  }
  return true;
}

/// The vector in the plane of two that has each as its part in the direction of that; 0 if they are
/// parallel.
Vec3 meetingOf(const Vec3& a, const Vec3& b) {
  const double aa = glm::dot(a, a);
  const double bb = glm::dot(b, b);
  const double ab = glm::dot(a, b);
  const double both = aa * bb - ab * ab;
  constexpr double kParallel = 1e-6;
  if (!(both > kParallel * aa * bb)) return Vec3(0.0);
  return (a * (bb * (aa - ab)) + b * (aa * (bb - ab))) / both;
}

}  // namespace

/// A root's edge between two vertices of the mesh; sorting brings equal edges together.
struct ElementSurface::RootEdge {
  Index low, high;
  Index root;
  Index number;
  bool forward;  ///< from low to high
};

ElementSurface::ElementSurface(const PatchMesh& mesh, double crease, const Inset& inset,
                               const std::optional<Inset>& inner)
    : diagonal(boxOf(mesh.vertices).diagonal()),
      roots(elementRoots(mesh)),
      insets_(findInsets(mesh, inset)),
      inner_insets_(inner ? findInsets(mesh, *inner) : insets_) {
  for (Index p = 0; p < mesh.polygons.size(); ++p) owners.push_back({p});
  nobody = Index(owners.size());
  owners.emplace_back();
  addVertices(mesh, cornerGroups(mesh, crease));
  addEdges(mesh, crease, inset, inner.value_or(inset));
  insetCorners(mesh, inset, insets_, &SurfaceEdge::inset, &SurfacePoint::position);
  for (SurfacePoint& point : points) point.inner = point.position;
  if (inner) {
    insetCorners(mesh, *inner, inner_insets_, &SurfaceEdge::inner, &SurfacePoint::inner);
  }
}

Index ElementSurface::ownersOf(std::vector<Index> polygons) {
  std::sort(polygons.begin(), polygons.end());
  polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
  if (polygons.size() == 1) return polygons[0];
  owners.push_back(std::move(polygons));
  return Index(owners.size() - 1);
}

/// Adds one vertex for each corner group, then the vertices inside patches.
void ElementSurface::addVertices(const PatchMesh& mesh, const CornerGroups& groups) {
  for (std::size_t g = 0; g < groups.size(); ++g) {
    SurfacePoint point;
    point.place = mesh.vertices[mesh.corners[groups.cornersOf(g)[0]]];
    std::vector<Index> polygons;
    Vec3 normal(0.0);
    for (const Index i : groups.patchesOf(g)) {
      normal += mesh.area[i] * mesh.normal[i];
      if (mesh.polygon[i] != kNone) polygons.push_back(mesh.polygon[i]);
    }
    if (!polygons.empty()) point.owners = ownersOf(std::move(polygons));
    const Index first = groups.patchesOf(g)[0];
    const bool planar = point.owners < mesh.polygons.size();
    const double length = glm::length(normal);
    point.normal = planar || !(length > 0) ? mesh.normal[first] : normal / length;
    points.push_back(point);
  }
  vertex.resize(roots.size());
  curved.assign(roots.size(), 0);
  for (std::size_t r = 0; r < roots.size(); ++r) {
    const Index patch = roots.patch[r];
    const auto outline = mesh.outline(patch);
    for (std::size_t k = 0; k < roots.cornerCount(r); ++k) {
      const Index v = roots.corner[r][k];
      const auto at = std::find(outline.begin(), outline.end(), v);
      if (at != outline.end()) {
        const std::size_t corner = mesh.corner_offset[patch] + std::size_t(at - outline.begin());
        vertex[r][k] = groups.of_corner[corner];
        if (points[vertex[r][k]].owners >= mesh.polygons.size()) curved[r] = 1;
        continue;
      }
      // A vertex inside the patch: the roots of one patch are consecutive.
      vertex[r][k] = kNone;
      for (std::size_t other = roots.of_patch[patch]; other < r; ++other) {
        for (std::size_t j = 0; j < 3; ++j) {
          if (roots.corner[other][j] == v) vertex[r][k] = vertex[other][j];
        }
      }
      if (vertex[r][k] != kNone) continue;
      vertex[r][k] = Index(points.size());
      const Vec3& place = mesh.vertices[v];
      points.push_back({place, place, place, mesh.normal[patch], mesh.polygon[patch]});
    }
    if (roots.cornerCount(r) == 3) vertex[r][3] = kNone;
  }
}

/// The matching edge of the neighbour: the only other edge that runs in the opposite direction on
/// the same smooth side, if no other patch touches it.
const ElementSurface::RootEdge* ElementSurface::partner(const PatchMesh& mesh,
                                                        std::span<const RootEdge> run,
                                                        const RootEdge& of, double cosine) const {
  const Index a = roots.patch[of.root];
  const auto goesOn = [&](const RootEdge& edge) {
    const Index b = roots.patch[edge.root];
    if (edge.root == of.root || edge.forward == of.forward) return false;
    if (a == b) return true;
    if (mesh.surface[a] != mesh.surface[b] || mesh.twin[a] == b) return false;
    if (mesh.polygon[a] != mesh.polygon[b] && glm::dot(mesh.normal[a], mesh.normal[b]) < cosine) {
      return false;
    }
    const auto& mine = vertex[of.root];
    const auto& its = vertex[edge.root];
    const std::size_t n = roots.cornerCount(of.root);
    const std::size_t m = roots.cornerCount(edge.root);
    return mine[of.number] == its[(edge.number + 1) % m] &&
           mine[(of.number + 1) % n] == its[edge.number];
  };
  const RootEdge* found = nullptr;
  for (const RootEdge& edge : run) {
    if (!goesOn(edge)) continue;
    if (found != nullptr) return nullptr;
    found = &edge;
  }
  if (found == nullptr) return nullptr;
  const Index b = roots.patch[found->root];
  for (const RootEdge& edge : run) {
    const Index c = roots.patch[edge.root];
    if (c != a && c != b && mesh.twin[a] != c && mesh.twin[b] != c) return nullptr;
  }
  return found;
}

std::vector<double> ElementSurface::findInsets(const PatchMesh& mesh, const Inset& inset) const {
  std::vector<double> insets;
  for (std::size_t r = 0; r < roots.size(); ++r) {
    const std::size_t n = roots.cornerCount(r);
    double longest = 0;
    Vec3 twice(0.0);
    const Vec3 base = mesh.vertices[roots.corner[r][0]];
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 a = mesh.vertices[roots.corner[r][k]];
      const Vec3 b = mesh.vertices[roots.corner[r][(k + 1) % n]];
      longest = std::max(longest, glm::distance(a, b));
      twice += glm::cross(a - base, b - base);
    }
    const double height = longest > 0 ? glm::length(twice) / longest : 0;
    insets.push_back(std::min(inset.of_diagonal * diagonal, inset.of_height * height));
  }
  return insets;
}

/// Whether one of two roots of one polygon is a sliver. What almost touches has cut it off, as a
/// frame in front of a wall, so light at their common edge is not that of the larger root.
bool ElementSurface::besideSliver(const PatchMesh& mesh, std::size_t a, std::size_t b) const {
  const Index polygon = mesh.polygon[roots.patch[a]];
  if (polygon == kNone || polygon != mesh.polygon[roots.patch[b]]) return false;
  const double inset = insets_[a];
  const double other = insets_[b];
  return std::min(inset, other) < kSliver * std::max(inset, other);
}

/// Of points on a border, from it: by how far the root goes in from there.
double ElementSurface::insetFrom(const PatchMesh& mesh, std::size_t root, const Vec3& border,
                                 const Vec3& inward, const Inset& inset) const {
  double depth = 0;
  for (std::size_t k = 0; k < roots.cornerCount(root); ++k) {
    depth = std::max(depth, glm::dot(inward, mesh.vertices[roots.corner[root][k]] - border));
  }
  return std::min(inset.of_diagonal * diagonal, inset.of_height * depth);
}

void ElementSurface::addEdges(const PatchMesh& mesh, double crease, const Inset& inset,
                              const Inset& inner) {
  std::vector<RootEdge> all;
  for (Index r = 0; r < roots.size(); ++r) {
    const auto n = Index(roots.cornerCount(r));
    for (Index k = 0; k < n; ++k) {
      const Index from = roots.corner[r][k];
      const Index to = roots.corner[r][(k + 1) % n];
      all.push_back({std::min(from, to), std::max(from, to), r, k, from < to});
    }
  }
  std::sort(all.begin(), all.end(), [](const RootEdge& a, const RootEdge& b) {
    return std::tie(a.low, a.high, a.root, a.number) < std::tie(b.low, b.high, b.root, b.number);
  });
  tag.resize(roots.size());
  const double cosine = std::cos(crease * std::numbers::pi / 180);
  for (std::size_t first = 0; first < all.size();) {
    std::size_t end = first + 1;
    while (end < all.size() && all[end].low == all[first].low && all[end].high == all[first].high) {
      ++end;
    }
    const auto run = std::span<const RootEdge>(all).subspan(first, end - first);
    for (const RootEdge& edge : run) {
      const auto n = Index(roots.cornerCount(edge.root));
      const Index a = vertex[edge.root][edge.number];
      const Index b = vertex[edge.root][(edge.number + 1) % n];
      const Index patch = roots.patch[edge.root];
      const RootEdge* across = partner(mesh, run, edge, cosine);
      if (across != nullptr && besideSliver(mesh, edge.root, across->root)) across = nullptr;
      SurfaceEdge fresh;
      if (across != nullptr) {
        tag[edge.root][edge.number] = 0;
        const Index other = mesh.polygon[roots.patch[across->root]];
        fresh.owners = edges.find(a, b) != nullptr ? edges.find(a, b)->owners
                                                   : ownersOf({mesh.polygon[patch], other});
      } else {
        tag[edge.root][edge.number] = edge.root + 1;
        fresh.owners = mesh.polygon[patch];
        const Vec3& border = points[a].place;
        const Vec3 along = points[b].place - border;
        const double length = glm::length(along);
        if (length > 0) {
          const Vec3 inward = glm::cross(mesh.normal[patch], along / length);
          fresh.inset = inward * insetFrom(mesh, edge.root, border, inward, inset);
          fresh.inner = inward * insetFrom(mesh, edge.root, border, inward, inner);
        }
      }
      edges.edge(a, b, tag[edge.root][edge.number], fresh);
    }
    first = end;
  }
}

/// Moves corners on borders to the inner side of all their borders.
void ElementSurface::insetCorners(const PatchMesh& mesh, const Inset& inset,
                                  std::span<const double> insets, Vec3 SurfaceEdge::*of_edge,
                                  Vec3 SurfacePoint::*position) {
  std::vector<Vec3> inward(points.size(), Vec3(0.0));
  std::vector<double> most(points.size(), inset.of_diagonal * diagonal);  // distance
  std::vector<std::uint8_t> border(points.size(), 0);
  for (Index r = 0; r < roots.size(); ++r) {
    const auto n = Index(roots.cornerCount(r));
    for (Index k = 0; k < n; ++k) {
      most[vertex[r][k]] = std::min(most[vertex[r][k]], insets[r]);
      if (tag[r][k] == 0) continue;
      for (const Index v : {vertex[r][k], vertex[r][(k + 1) % n]}) {
        inward[v] += edges.find(vertex[r][k], vertex[r][(k + 1) % n], tag[r][k])->*of_edge;
        border[v] = 1;
      }
    }
  }
  // If opposite borders cancel, as around the end of a wall, we move towards any root's middle.
  const double least = 1e-3 * inset.of_diagonal * diagonal;
  for (Index r = 0; r < roots.size(); ++r) {
    for (std::size_t k = 0; k < roots.cornerCount(r); ++k) {
      const Index v = vertex[r][k];
      if (border[v] != 0 && glm::length(inward[v]) < least) {
        inward[v] = mesh.centroid[roots.patch[r]] - points[v].place;
      }
    }
  }
  for (Vec3& along : inward) {
    const double length = glm::length(along);
    along = length > 0 ? along / length : Vec3(0.0);
  }
  keepToCurves(mesh, inset, inward, most);
  leaveSlivers(mesh, insets, inward, most);
  for (std::size_t v = 0; v < points.size(); ++v) {
    points[v].*position = points[v].place + inward[v] * most[v];
  }
  insetFromBorders(mesh, of_edge, position);
}

/// Where one or two borders meet at a corner in a plane, it is as far from each as the middles of
/// edges there: a long strip has different insets from its sides and from its ends.
void ElementSurface::insetFromBorders(const PatchMesh& mesh, Vec3 SurfaceEdge::*of_edge,
                                      Vec3 SurfacePoint::*position) {
  struct Borders {
    std::array<Vec3, 2> inset{};
    std::size_t count = 0;  // more than two: not to be solved for
  };
  std::vector<Borders> borders(points.size());
  const auto add = [](Borders& of, const Vec3& inset) {
    constexpr double kAlike = 1 - 1e-6;
    for (std::size_t k = 0; k < std::min<std::size_t>(of.count, 2); ++k) {
      const double most = glm::length(of.inset[k]);
      const double length = glm::length(inset);
      if (glm::dot(of.inset[k], inset) < kAlike * most * length) continue;
      if (length > most) of.inset[k] = inset;
      return;
    }
    if (of.count < 2) of.inset[of.count] = inset;
    ++of.count;
  };
  for (Index r = 0; r < roots.size(); ++r) {
    const auto n = Index(roots.cornerCount(r));
    for (Index k = 0; k < n; ++k) {
      if (tag[r][k] == 0) continue;
      const std::array<Index, 2> ends = {vertex[r][k], vertex[r][(k + 1) % n]};
      const Vec3& inset = edges.find(ends[0], ends[1], tag[r][k])->*of_edge;
      for (const Index v : ends) add(borders[v], inset);
    }
  }
  for (Index r = 0; r < roots.size(); ++r) {
    for (std::size_t k = 0; k < roots.cornerCount(r); ++k) {
      const Index v = vertex[r][k];
      const Borders& at = borders[v];
      if (points[v].owners >= mesh.polygons.size() || at.count == 0 || at.count > 2) continue;
      const Vec3 moved = at.count == 1 ? at.inset[0] : meetingOf(at.inset[0], at.inset[1]);
      if (moved != Vec3(0.0) && isOn(mesh, roots, r, points[v].place + moved)) {
        points[v].*position = points[v].place + moved;
      }
    }
  }
}

/// Corners between facets move along the smooth edge that leads farthest inwards: the plane of one
/// facet soon leaves the surface of the other. Without such an edge they stay close.
void ElementSurface::keepToCurves(const PatchMesh& mesh, const Inset& inset, std::span<Vec3> inward,
                                  std::span<double> distance) const {
  const double largest = inset.of_diagonal * diagonal;
  const double near = kLeast * diagonal;
  if (largest <= near) return;
  struct Way {
    Vec3 along{0.0};  // unit
    double distance = 0;
    double depth = 0;
  };
  std::vector<Way> ways(points.size());
  for (Index r = 0; r < roots.size(); ++r) {
    const auto n = Index(roots.cornerCount(r));
    for (Index k = 0; k < n; ++k) {
      if (tag[r][k] != 0) continue;
      const std::array<Index, 2> ends = {vertex[r][k], vertex[r][(k + 1) % n]};
      const double length = glm::distance(points[ends[0]].place, points[ends[1]].place);
      if (!(length > 0)) continue;
      const double most = std::min(largest, inset.of_height * length);
      for (const std::size_t end : {0, 1}) {
        const Index v = ends[end];
        const Vec3 along = (points[ends[1 - end]].place - points[v].place) / length;
        const double cosine = glm::dot(along, inward[v]);
        if (cosine > kInwards && cosine * most > ways[v].depth) {
          ways[v] = {along, most, cosine * most};
        }
      }
    }
  }
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (points[v].owners < mesh.polygons.size()) continue;
    distance[v] = ways[v].depth > 0 ? ways[v].distance : std::min(distance[v], near);
    if (ways[v].depth > 0) inward[v] = ways[v].along;
  }
}

/// A corner of a sliver and of larger roots goes into the larger ones, as far as these ask for.
/// What it sees through the gap that cut off the sliver is not the light of the larger root.
void ElementSurface::leaveSlivers(const PatchMesh& mesh, std::span<const double> insets,
                                  std::span<const Vec3> inward, std::span<double> distance) const {
  for (Index r = 0; r < roots.size(); ++r) {
    const double inset = insets[r];
    for (std::size_t k = 0; k < roots.cornerCount(r); ++k) {
      const Index v = vertex[r][k];
      if (points[v].owners >= mesh.polygons.size() || inset <= distance[v]) continue;
      if (isOn(mesh, roots, r, points[v].place + inward[v] * inset)) distance[v] = inset;
    }
  }
}

}  // namespace radiosity
