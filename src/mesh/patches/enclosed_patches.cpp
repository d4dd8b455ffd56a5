// Finds the patches that look into bounded spaces.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/geometry/box_tree.h"
#include "base/geometry/segment.h"
#include "base/parallel.h"
#include "base/union_find.h"
#include "mesh/edge_key.h"
#include "mesh/patches/edge_users.h"
#include "mesh/patches/enclosures.h"
#include "mesh/patches/polygon_contacts.h"
#include "scene/checks/winding_tree.h"

namespace radiosity {
namespace {

/// Polygons at an edge whose directions differ by less, radians, lie back to back.
constexpr double kSameDirection = 1e-7;
/// The winding number of an enclosed point is -1 or less, but for the tree's error and for polygons
/// that are not quite planar.
constexpr double kEnclosed = -0.5;
/// On an outline the number is half way between two others.
constexpr double kUncertain = 0.25;
/// The most points of a sheet that are tried.
constexpr int kMostEyes = 8;
/// Patches and polygons that a thread looks at at a time.
constexpr std::size_t kPatchesAtOnce = 64;

/// The sides of polygon p: 2 p in front and 2 p + 1 behind.
Index sideOf(Index polygon, bool back) { return 2 * polygon + (back ? 1 : 0); }

/// A polygon at an edge: its direction as an angle about the edge, and the sides that look to
/// larger and smaller angles.
struct PolygonAtEdge {
  double angle;
  Index up;
  Index down;
  bool backIsUp() const { return up % 2 != 0; }
};

/// The front patches of a mesh as polygons. Polygons that others stand on or pass through are not
/// always cut there; patches are.
struct FrontPatches {
  explicit FrontPatches(const PatchMesh& mesh) : at(mesh.size(), kNone) {
    as_polygons.loop_offset = as_polygons.corner_offset = {0};
    for (Index i = 0; i < mesh.size(); ++i) {
      if (mesh.polygon[i] == kNone || mesh.side[i] != 0) continue;
      at[i] = Index(patch.size());
      patch.push_back(i);
      const std::span<const Index> outline = mesh.outline(i);
      as_polygons.corners.insert(as_polygons.corners.end(), outline.begin(), outline.end());
      as_polygons.corner_offset.push_back(as_polygons.corners.size());
      as_polygons.loop_offset.push_back(patch.size());
      as_polygons.normal.push_back(mesh.normal[i]);
      as_polygons.origin.push_back(mesh.centroid[i]);
    }
  }

  PlanarPolygons as_polygons;
  std::vector<Index> patch;  ///< of each polygon
  std::vector<Index> at;     ///< N, the polygon of each patch; kNone: a back, or without an area
};

/// Sides that look into one space are joined around the edges that their polygons share. Joined
/// sides are a closed surface, a *shell*: the outline of a bounded space if it has a volume that it
/// faces, else the outside of something in a space. All shells of the first kind together are a
/// cycle: no way leads from a point with a winding number other than 0 to infinity without passing
/// through one of their polygons. That is the proof; it needs no polygon to be convex, closed with
/// its neighbours or apart from others.
class SpaceSearch {
 public:
  SpaceSearch(const PatchMesh& mesh, std::span<const Index> first, double coincidence,
              Progress& progress)
      : mesh_(mesh),
        fronts_(mesh),
        all_(fronts_.as_polygons),
        first_(first),
        same_(firstOnSameCorners(all_, first)),
        coincidence_(coincidence),
        progress_(progress),
        contacts_(mesh.vertices, all_, first, coincidence),
        shells_(2 * all_.size()),
        shell_(2 * all_.size()),
        sheets_(2 * all_.size()),
        enclosed_(2 * all_.size(), 0) {}

  std::vector<std::uint8_t> run() {
    std::vector<std::uint8_t> patches(mesh_.size(), 0);
    joinShells();
    progress_.check();
    if (!findOutlines()) return patches;
    joinSheets();
    progress_.check();
    lookFromSheets();
    progress_.check();
    findWalls();
    dropPassing();
    progress_.check();
    parallelFor(mesh_.size(), kPatchesAtOnce, [&](std::size_t i) {
      if (!progress_.cancelled()) patches[i] = isEnclosed(i) ? 1 : 0;
    });
    progress_.check();
    return patches;
  }

 private:
  const Vec3& at(Index vertex) const { return mesh_.vertices[vertex]; }

  /// Cuts edges of one polygon at the ends of others on them: faces as patches may have
  /// T-junctions.
  std::vector<EdgeUser> withoutTJunctions(std::vector<EdgeUser> users) const {
    std::vector<std::uint8_t> alone(users.size(), 0);
    std::vector<Index> ends;
    forEdges(users, [&](std::span<const EdgeUser> of_edge) {
      if (of_edge.size() > 1) return;
      alone[std::size_t(&of_edge[0] - users.data())] = 1;
      ends.push_back(of_edge[0].low());
      ends.push_back(of_edge[0].high());
    });
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<Box3> places;
    places.reserve(ends.size());
    for (const Index v : ends) places.push_back({at(v), at(v)});
    const BoxTree tree(places);
    std::vector<EdgeUser> cut;
    cut.reserve(users.size());
    std::vector<std::pair<double, Index>> on;  // squared distance from the low end, vertex
    for (std::size_t k = 0; k < users.size(); ++k) {
      const Index low = users[k].low();
      const Index high = users[k].high();
      on.clear();
      if (alone[k] != 0) {
        const auto near = [&](const Box3& box) {
          return distanceToSegment(box.centre(), at(low), at(high)) <=
                 0.5 * box.diagonal() + coincidence_;
        };
        tree.search(near, [&](Index e) {
          const Vec3 away = at(ends[e]) - at(low);
          if (ends[e] != low && ends[e] != high) on.emplace_back(glm::dot(away, away), ends[e]);
          return true;
        });
        std::sort(on.begin(), on.end());
      }
      Index from = low;
      for (const auto& [distance, vertex] : on) {
        cut.push_back(part(users[k], from, vertex));
        from = vertex;
      }
      cut.push_back(part(users[k], from, high));
    }
    parallelSort(cut);
    return cut;
  }

  static EdgeUser part(const EdgeUser& user, Index from, Index to) {
    return {edgeKey(from, to), user.reversed != (from > to), user.polygon};
  }

  void joinShells() {
    std::vector<PolygonAtEdge> around;
    users_ = withoutTJunctions(edgeUsers(all_, first_));
    forEdges(users_, [&](std::span<const EdgeUser> users) { joinAt(users, shells_, around); });
    for (Index side = 0; side < shell_.size(); ++side) shell_[side] = shells_.find(side);
  }

  void joinAt(std::span<const EdgeUser> users, UnionFind& sets,
              std::vector<PolygonAtEdge>& around) const {
    polygonsAt(users, around);
    for (std::size_t k = 0; k < around.size(); ++k) {
      sets.unite(around[k].up, around[(k + 1) % around.size()].down);
    }
  }

  using Edge = std::span<const EdgeUser>;

  /// Joins sides around edges of no more than two polygons: nothing depends on angles there. If
  /// such an edge lies in an outline, what meets at it may go on from one side to the other.
  void joinSheets() {
    std::vector<Edge> edges;
    forEdges(users_, [&](Edge users) {
      if (users.size() <= 2) edges.push_back(users);
    });
    const std::vector<std::uint8_t> in_outline = edgesInOutlines(edges);
    progress_.check();
    std::vector<PolygonAtEdge> around;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (in_outline[k] == 0) joinAt(edges[k], sheets_, around);
    }
  }

  /// For each edge 1 if it lies in a polygon of an outline that is not one of its own.
  std::vector<std::uint8_t> edgesInOutlines(std::span<const Edge> edges) const {
    std::vector<Index> outlines;
    std::vector<Box3> boxes;
    for (Index p = 0; p < all_.size(); ++p) {
      if (weight(p) == 0) continue;
      outlines.push_back(p);
      boxes.push_back(contacts_.box(p));
    }
    const BoxTree tree(boxes);
    std::vector<std::uint8_t> found(edges.size(), 0);
    parallelFor(edges.size(), kPatchesAtOnce, [&](std::size_t k) {
      if (progress_.cancelled()) return;
      const Vec3& low = at(edges[k][0].low());
      const Vec3& high = at(edges[k][0].high());
      Box3 box;
      box.add(low);
      box.add(high);
      tree.query(box, [&](Index o) {
        const Index p = outlines[o];
        const bool own =
            std::ranges::any_of(edges[k], [&](auto& user) { return user.polygon == p; });
        if (!own && contacts_.holds(p, low, high)) found[k] = 1;
        return found[k] == 0;
      });
    });
    return found;
  }

  /// The polygons at an edge, by angle. If some lie back to back, their backs face each other.
  void polygonsAt(std::span<const EdgeUser> users, std::vector<PolygonAtEdge>& around) const {
    around.clear();
    const Vec3 along = glm::normalize(at(users[0].high()) - at(users[0].low()));
    Vec3 u(0.0);
    Vec3 v(0.0);
    for (const EdgeUser& user : users) {
      // To the left of an edge, seen from the front, is the polygon.
      const Vec3& normal = all_.normal[user.polygon];
      const Vec3 inward = glm::cross(normal, user.reversed ? -along : along);
      if (around.empty()) {
        u = inward;
        v = glm::cross(along, u);
      }
      double angle = std::atan2(glm::dot(inward, v), glm::dot(inward, u));
      if (angle < -kSameDirection) angle += 2 * std::numbers::pi;
      // About the edge, angles grow towards `along` x inward, which is the normal or its opposite.
      around.push_back(
          {angle, sideOf(user.polygon, user.reversed), sideOf(user.polygon, !user.reversed)});
    }
    std::sort(around.begin(), around.end(), [](const PolygonAtEdge& a, const PolygonAtEdge& b) {
      return std::tie(a.angle, a.up) < std::tie(b.angle, b.up);
    });
    for (std::size_t from = 0; from < around.size();) {
      std::size_t to = from + 1;
      while (to < around.size() && around[to].angle - around[to - 1].angle < kSameDirection) ++to;
      std::stable_sort(around.begin() + std::ptrdiff_t(from), around.begin() + std::ptrdiff_t(to),
                       [](const PolygonAtEdge& a, const PolygonAtEdge& b) {
                         return a.backIsUp() > b.backIsUp();
                       });
      from = to;
    }
  }

  /// Finds the shells that are outlines of bounded spaces. Returns whether there is one.
  bool findOutlines() {
    const std::size_t count = enclosed_.size();
    std::vector<double> volume(count, 0.0);
    std::vector<double> area(count, 0.0);
    const Vec3 base = mesh_.vertices.empty() ? Vec3(0.0) : mesh_.vertices[0];
    forTriangles([&](Index p, const Vec3& a, const Vec3& b, const Vec3& c) {
      const Vec3 normal = glm::cross(b - a, c - a) / 2.0;
      const double part = glm::dot(a - base, normal) / 3;
      for (const bool back : {false, true}) {
        const Index shell = shell_[sideOf(p, back)];
        volume[shell] += back ? -part : part;
        area[shell] += glm::length(normal);
      }
    });
    is_outline_.assign(count, 0);
    bool any = false;
    for (Index s = 0; s < count; ++s) {
      if (shell_[s] != s || !(volume[s] < -0.5 * area[s] * coincidence_)) continue;
      is_outline_[s] = 1;
      any = true;
    }
    return any;
  }

  template <class Visit>
  void forTriangles(const Visit& visit) const {
    for (Index p = 0; p < all_.size(); ++p) {
      for (std::size_t l = all_.loopBegin(p); l < all_.loopEnd(p); ++l) {
        const std::span<const Index> loop = all_.loop(l);
        for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
          visit(p, at(loop[0]), at(loop[k]), at(loop[k + 1]));
        }
      }
    }
  }

  bool onOutline(Index side) const { return is_outline_[shell_[side]] != 0; }
  /// 1 if just the front of the polygon is on the cycle of outlines, -1 if just the back is.
  int weight(Index p) const {
    return int(onOutline(sideOf(p, false))) - int(onOutline(sideOf(p, true)));
  }

  /// A point of a sheet: the middle of a patch.
  struct Eye {
    Index patch = kNone;
    Index side = kNone;
    bool certain = false;  ///< it lies on no outline but its own
  };

  /// For each sheet the largest patch, or, if the last one was not certain, the next.
  void nextEyes(std::vector<Eye>& eyes) {
    const auto larger = [&](Index i, Index k) {
      return std::tie(mesh_.area[k], i) < std::tie(mesh_.area[i], k);
    };
    std::vector<Eye> next(eyes.size());
    for (Index p = 0; p < all_.size(); ++p) {
      const Index i = fronts_.patch[p];
      for (const bool back : {false, true}) {
        const Index side = sideOf(p, back);
        const Index sheet = sheets_.find(side);
        const Eye& last = eyes[sheet];
        if (last.certain || (last.patch != kNone && !larger(last.patch, i))) continue;
        if (next[sheet].patch == kNone || larger(i, next[sheet].patch)) next[sheet] = {i, side};
      }
    }
    for (std::size_t s = 0; s < eyes.size(); ++s) {
      if (!eyes[s].certain) eyes[s] = next[s];
    }
  }

  /// The sides of a sheet look into one space, and one point of it decides. A lamp on a ceiling has
  /// points on an outline alone: then one beside it does.
  void lookFromSheets() {
    std::vector<WindingTree::Triangle> cycle;
    std::vector<int> steps(all_.size(), 0);  // by polygon, of all polygons at the same place
    forTriangles([&](Index p, const Vec3& a, const Vec3& b, const Vec3& c) {
      if (weight(p) > 0) cycle.push_back({{a, b, c}, same_[p]});
      if (weight(p) < 0) cycle.push_back({{a, c, b}, same_[p]});
    });
    for (Index p = 0; p < all_.size(); ++p) {
      const bool turned = glm::dot(all_.normal[p], all_.normal[same_[p]]) < 0;
      steps[same_[p]] += turned ? -weight(p) : weight(p);
    }
    const WindingTree tree(std::move(cycle));
    std::vector<std::uint8_t> of_sheet(enclosed_.size(), 0);
    std::vector<Eye> eyes(enclosed_.size());
    for (int eye = 0; eye < kMostEyes; ++eye) {
      nextEyes(eyes);
      std::vector<Index> sheets;
      for (Index s = 0; s < eyes.size(); ++s) {
        if (eyes[s].patch != kNone && !eyes[s].certain) sheets.push_back(s);
      }
      if (sheets.empty()) break;
      parallelFor(sheets.size(), kPatchesAtOnce, [&](std::size_t k) {
        if (progress_.cancelled()) return;
        Eye& of = eyes[sheets[k]];
        const Vec3& middle = mesh_.centroid[of.patch];
        const Index plane = same_[of.side / 2];
        const bool turned = glm::dot(all_.normal[of.side / 2], all_.normal[plane]) < 0;
        const bool beyond = turned != (of.side % 2 != 0);  // behind the plane
        double number = tree.around(middle, plane) + 0.5 * (beyond ? steps[plane] : -steps[plane]);
        of.certain = std::abs(number - std::round(number)) < kUncertain;
        if (!of.certain) {
          const double away = (of.side % 2 != 0 ? -2 : 2) * coincidence_;
          number = tree.around(middle + away * all_.normal[of.side / 2]);
        }
        of_sheet[sheets[k]] = number < kEnclosed ? 1 : 0;
      });
    }
    for (Index side = 0; side < enclosed_.size(); ++side) {
      enclosed_[side] = of_sheet[sheets_.find(side)];
    }
  }

  /// Finds polygons that part a bounded space from the one outside.
  void findWalls() {
    std::vector<Box3> boxes;
    for (Index p = 0; p < all_.size(); ++p) {
      if (enclosed_[sideOf(p, false)] == enclosed_[sideOf(p, true)]) continue;
      walls_.push_back(p);
      boxes.push_back(contacts_.box(p));
    }
    tree_ = BoxTree(boxes);
  }

  Index enclosedSide(Index wall) const { return sideOf(wall, enclosed_[sideOf(wall, false)] == 0); }

  /// Faces as patches are not cut where they cross. So what passes through a wall has no proof: all
  /// of the sheet. Outlines are on one side of all walls but their own.
  void dropPassing() {
    std::vector<std::array<std::uint8_t, 2>> passes(all_.size(), {0, 0});
    parallelFor(all_.size(), kPatchesAtOnce, [&](std::size_t k) {
      if (progress_.cancelled()) return;
      const auto p = Index(k);
      for (const bool back : {false, true}) {
        const Index side = sideOf(p, back);
        if (enclosed_[side] == 0) continue;
        tree_.query(contacts_.box(p), [&](Index w) {
          const Index wall = walls_[w];
          const bool may =
              wall != p && (!onOutline(side) || shell_[enclosedSide(wall)] == shell_[side]);
          if (may && contacts_.passes(p, wall)) passes[k][back ? 1 : 0] = 1;
          return passes[k][back ? 1 : 0] == 0;
        });
      }
    });
    std::vector<std::uint8_t> dropped(enclosed_.size(), 0);  // by sheet
    for (Index side = 0; side < enclosed_.size(); ++side) {
      if (passes[side / 2][side % 2] != 0) dropped[sheets_.find(side)] = 1;
    }
    for (Index side = 0; side < enclosed_.size(); ++side) {
      if (dropped[sheets_.find(side)] != 0) enclosed_[side] = 0;
    }
  }

  /// A patch that lies on a wall, face to face, looks through it: no method sees what is no
  /// distance away. (Meshing by polygons drops such contacts.)
  bool isEnclosed(std::size_t i) const {
    if (mesh_.polygon[i] == kNone) return true;  // has no view
    const bool back = mesh_.side[i] != 0;
    const Index p = fronts_.at[back ? mesh_.twin[i] : i];
    const Index side = sideOf(p, back);
    if (enclosed_[side] == 0 || onOutline(side)) return enclosed_[side] != 0;
    const Vec3& centre = mesh_.centroid[i];
    bool covered = false;
    tree_.query(Box3{centre, centre}, [&](Index w) {
      const Index wall = walls_[w];
      const Vec3& normal = all_.normal[wall];
      const bool faces = (glm::dot(normal, mesh_.normal[i]) < 0) == (enclosedSide(wall) % 2 == 0);
      covered =
          wall != p && faces && contacts_.inPlane(p, wall) && contacts_.contains(wall, centre);
      return !covered;
    });
    return !covered;
  }

  const PatchMesh& mesh_;
  FrontPatches fronts_;
  const PlanarPolygons& all_;
  std::span<const Index> first_;
  std::vector<Index> same_;
  double coincidence_;
  Progress& progress_;
  PolygonContacts contacts_;
  std::vector<EdgeUser> users_;  ///< of all edges
  UnionFind shells_;
  std::vector<Index> shell_;              ///< by side
  UnionFind sheets_;                      ///< parts of shells; see joinSheets()
  std::vector<std::uint8_t> is_outline_;  ///< by shell, of a bounded space
  std::vector<std::uint8_t> enclosed_;    ///< by side
  std::vector<Index> walls_;
  BoxTree tree_;  ///< of walls
};

}  // namespace

std::vector<std::uint8_t> enclosedPatches(const PatchMesh& mesh, std::span<const Index> first,
                                          double coincidence, Progress& progress) {
  return SpaceSearch(mesh, first, coincidence, progress).run();
}

}  // namespace radiosity
