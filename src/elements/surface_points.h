// The points at which light is evaluated: their places, their normals, and the elements that share
// them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The distance from borders, creases and contacts at which light is evaluated. On them, rounding
/// would decide what a point sees.
struct Inset {
  double of_diagonal;  ///< of the scene, ...
  double of_height;    ///< ... but at most of how far a root goes in from there
};

/// The inset for direct light, which changes in steps where bodies touch.
inline constexpr Inset kDirectInset{1e-5, 0.1};
/// The inset for indirect light, which falls steeply towards creases. With vertices on the creases,
/// linear interpolation would be too low there, and all over surfaces smaller than an element.
/// Vertices at the Gauss points of the outermost elements give the right means.
inline constexpr Inset kIndirectInset{0.0015, 0.21};

/// A vertex of elements.
struct SurfacePoint {
  Vec3 place{0.0};     ///< of the element's corner
  Vec3 position{0.0};  ///< where light is evaluated
  Vec3 inner{0.0};     ///< where rays to emitters start
  Vec3 normal{0.0};    ///< unit; where facets meet smoothly, the mean of theirs
  Index owners = 0;    ///< into ElementSurface::owners
};

/// An edge of elements, with or without a middle.
struct SurfaceEdge {
  Index middle = kNone;  ///< vertex
  Index owners = 0;
  Vec3 inset{0.0};  ///< of the middle's position
  Vec3 inner{0.0};  ///< likewise, of where rays to emitters start
};

/// The edges of one field's elements, by their ends. Roots on either side of a border or a crease
/// may share both ends but not the edge: such an edge has a tag of its own.
class EdgeMap {
 public:
  SurfaceEdge* find(Index a, Index b, Index tag = 0) {
    const auto at = edges_.find(key(a, b, tag));
    return at == edges_.end() ? nullptr : &at->second;
  }
  SurfaceEdge& edge(Index a, Index b, Index tag, const SurfaceEdge& fresh) {
    return edges_.try_emplace(key(a, b, tag), fresh).first->second;
  }

 private:
  struct Key {
    std::uint64_t ends;
    Index tag;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t x = (k.ends ^ (std::uint64_t(k.tag) << 17)) * 0x9e3779b97f4a7c15ull;
      return std::size_t(x ^ (x >> 32));
    }
  };
  static Key key(Index a, Index b, Index tag) {
    return {a < b ? std::uint64_t(a) << 32 | b : std::uint64_t(b) << 32 | a, tag};
  }
  std::unordered_map<Key, SurfaceEdge, KeyHash> edges_;
};

/// The roots of elements over a mesh, and the vertices at their corners. Neighbours share a vertex
/// if they are on one smooth side (cornerGroups()), and an edge if nothing else touches it.
struct ElementSurface {
  /// `inner`: the inset of SurfacePoint::inner, if it is another.
  ElementSurface(const PatchMesh& mesh, double crease, const Inset& inset,
                 const std::optional<Inset>& inner = {});

  double diagonal = 0;  ///< metres
  ElementRoots roots;
  std::vector<std::array<Index, 4>> vertex;  ///< R, of each root's corners, into points
  std::vector<std::array<Index, 4>> tag;     ///< R, of each root's edges
  std::vector<SurfacePoint> points;
  EdgeMap edges;                           ///< of the roots
  std::vector<std::vector<Index>> owners;  ///< polygons; set p < P is polygon p alone
  Index nobody = 0;                        ///< the empty set, of points off all surfaces
  std::vector<std::uint8_t> curved;        ///< R, 1: some corner's normal is not the root's own

 private:
  struct Corner;
  struct RootEdge;
  void addVertices(const PatchMesh& mesh, const CornerGroups& groups);
  void addEdges(const PatchMesh& mesh, double crease, const Inset& inset, const Inset& inner);
  double insetFrom(const PatchMesh& mesh, std::size_t root, const Vec3& border, const Vec3& inward,
                   const Inset& inset) const;
  std::vector<double> findInsets(const PatchMesh& mesh, const Inset& inset) const;
  bool besideSliver(const PatchMesh& mesh, std::size_t a, std::size_t b) const;
  void insetCorners(const PatchMesh& mesh, const Inset& inset, std::span<const double> insets,
                    Vec3 SurfaceEdge::*of_edge, Vec3 SurfacePoint::*position);
  void insetFromBorders(const PatchMesh& mesh, Vec3 SurfaceEdge::*of_edge,
                        Vec3 SurfacePoint::*position);
  void keepToCurves(const PatchMesh& mesh, const Inset& inset, std::span<Vec3> inward,
                    std::span<double> distance) const;
  void leaveSlivers(const PatchMesh& mesh, std::span<const double> insets,
                    std::span<const Vec3> inward, std::span<double> distance) const;
  const RootEdge* partner(const PatchMesh& mesh, std::span<const RootEdge> run, const RootEdge& of,
                          double cosine) const;
  // R, metres.
  std::vector<double> insets_;
  std::vector<double> inner_insets_;
  Index ownersOf(std::vector<Index> polygons);
};

}  // namespace radiosity
