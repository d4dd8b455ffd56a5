#include "mesh/bodies/hollows.h"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "base/union_find.h"
#include "mesh/box_pairs.h"

namespace radiosity {

namespace {

/// Half-planes at an edge whose angles differ by less (radians) may be in either order.
constexpr double kSameAngle = 1e-5;
constexpr std::size_t kRingsAtATime = 16384;  // made on all threads

/// A cell at an edge: its angle about the edge, from an arbitrary start, and its sides towards
/// larger and smaller angles.
struct RingCell {
  double angle;
  Index after;
  Index before;
};

using Ring = boost::container::small_vector<RingCell, 4>;

/// The cells at an edge in the order of their angles about it (a to b, right-handed).
Ring ringOf(const InputFaces& input, const std::vector<Plane>& planes, const Edge& edge,
            std::span<const EdgeSides> at_edge) {
  const Vec3 axis = glm::normalize(input.points[edge.b] - input.points[edge.a]);
  const PlaneFrame across = makeFrame(Vec3(0.0), axis, axisAcross(axis));
  const auto angleOf = [&](const Vec3& inward) {
    return std::atan2(glm::dot(inward, across.v), glm::dot(inward, across.u));
  };
  Ring ring;
  for (const EdgeSides& s : at_edge) {
    const Vec3 left = glm::cross(planes[s.plane].normal, axis);
    if (s.left != kNone) ring.push_back({angleOf(left), 2 * s.left + kAbove, 2 * s.left + kBelow});
    if (s.right != kNone) {
      ring.push_back({angleOf(-left), 2 * s.right + kBelow, 2 * s.right + kAbove});
    }
  }
  std::sort(ring.begin(), ring.end(),
            [](const RingCell& x, const RingCell& y) { return x.angle < y.angle; });
  return ring;
}

/// Joins the sides that face each other across the gaps between the cells at an edge. If the order
/// of two cells is uncertain, both of their gaps may be the same one.
void joinAround(const Ring& ring, UnionFind& spaces) {
  constexpr double kTurn = 2 * std::numbers::pi;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const RingCell& here = ring[k];
    const RingCell& next = ring[(k + 1) % ring.size()];
    spaces.unite(here.after, next.before);
    const double gap = next.angle - here.angle + (k + 1 == ring.size() ? kTurn : 0);
    if (gap < kSameAngle) {
      spaces.unite(here.after, here.before);
      spaces.unite(next.after, next.before);
    }
  }
}

/// The properties of a space, from its sides.
struct Space {
  Box3 box;
  double volume = 0;  ///< three times that enclosed; below 0: the space is around its sides
  double seen = 0;    ///< m^2 of sides with patches
  double backs = 0;   ///< m^2 of sides without
  bool emits = false;
  double coincidence = std::numeric_limits<double>::infinity();  ///< the least of its sides', m
};

class SpaceSearch {
 public:
  SpaceSearch(const Scene& scene, const InputFaces& input, const std::vector<Plane>& planes,
              const EdgeTable& edges, const Arrangement& arrangement,
              const std::vector<Sheet>& sheets)
      : scene_(scene),
        input_(input),
        planes_(planes),
        edges_(edges),
        arrangement_(arrangement),
        sheets_(sheets),
        sets_(2 * arrangement.cells.size()),
        spaces_(2 * arrangement.cells.size()) {}

  std::vector<std::uint8_t> dark() {
    joinAroundEdges();
    addCells();
    addBoxes();
    const std::vector<std::uint8_t> hollow = hollows();
    std::vector<std::uint8_t> out(spaces_.size(), 0);
    for (Index k = 0; k < spaces_.size(); ++k) out[k] = hollow[sets_.find(k)];
    return out;
  }

 private:
  void joinAroundEdges() {
    const std::size_t edges = arrangement_.sides.size();
    std::vector<Ring> rings(std::min(edges, kRingsAtATime));
    for (std::size_t first = 0; first < edges; first += kRingsAtATime) {
      const std::size_t count = std::min(edges - first, kRingsAtATime);
      parallelFor(count, 256, [&](std::size_t k) {
        const auto& sides = arrangement_.sides[first + k];
        rings[k].clear();
        if (sides.empty()) return;
        rings[k] = ringOf(input_, planes_, edges_[Index(first + k)], {sides.data(), sides.size()});
      });
      for (std::size_t k = 0; k < count; ++k) joinAround(rings[k], sets_);
    }
  }

  const Material& materialOf(Index sheet) const {
    return scene_.materials[scene_.surfaces[sheets_[sheet].surface].material];
  }

  void addCells() {
    for (Index c = 0; c < arrangement_.cells.size(); ++c) {
      const PlaneCell& cell = arrangement_.cells[c];
      for (const Side side : {kAbove, kBelow}) {
        Space& space = spaces_[sets_.find(2 * c + Index(side))];
        const double out = side == kAbove ? 1 : -1;
        // Points are relative to the middle of the scene.
        space.volume -= out * glm::dot(cell.sample, planes_[cell.plane].normal) * cell.area;
        bool has_patch = false;
        for (const auto& [sheet, layers] : cell.cover) {
          const Material& material = materialOf(sheet);
          if (sheets_[sheet].facing * out < 0 && !material.two_sided) continue;
          has_patch = true;
          space.emits = space.emits || material.emission != Vec3(0.0);
        }
        (has_patch ? space.seen : space.backs) += cell.area;
      }
    }
  }

  void addBoxes() {
    for (std::size_t e = 0; e < arrangement_.sides.size(); ++e) {
      for (const EdgeSides& s : arrangement_.sides[e]) {
        for (const Index cell : {s.left, s.right}) {
          if (cell == kNone) continue;
          for (const Side side : {kAbove, kBelow}) {
            Space& space = spaces_[sets_.find(2 * cell + Index(side))];
            space.box.add(input_.points[edges_[Index(e)].a]);
            space.box.add(input_.points[edges_[Index(e)].b]);
            space.coincidence = std::min(space.coincidence, planes_[s.plane].coincidence);
          }
        }
      }
    }
  }

  bool couldBeHollow(Index root) {
    const Space& space = spaces_[root];
    const double area = space.seen + space.backs;
    return sets_.find(root) == root && space.seen > 0 && space.backs > space.seen && !space.emits &&
           space.volume > 1.5 * area * space.coincidence;
  }

  /// Boxes of the spaces that emit, and places of lamps.
  std::vector<Box3> lights() {
    std::vector<Box3> boxes;
    for (Index k = 0; k < spaces_.size(); ++k) {
      if (sets_.find(k) == k && spaces_[k].emits) boxes.push_back(spaces_[k].box);
    }
    for (const Light& light : scene_.lights) {
      const std::optional<Vec3> place = light.place();
      if (place && light.shines()) boxes.push_back({*place, *place});
    }
    return boxes;
  }

  /// Boxes of the faces that are not cut, and so may be on both sides of others, and emit.
  std::vector<Box3> uncutLights() const {
    std::vector<Box3> boxes;
    for (const InputFace& face : input_.uncut) {
      if (scene_.materials[scene_.surfaces[face.surface].material].emission == Vec3(0.0)) continue;
      Box3& box = boxes.emplace_back();
      for (const Index v : face.loop) box.add(input_.points[v]);
    }
    return boxes;
  }

  /// By root: the spaces that could be hollows, without those whose box contains that of a light or
  /// meets that of one that is not cut.
  std::vector<std::uint8_t> hollows() {
    std::vector<std::uint8_t> out(spaces_.size(), 0);
    std::vector<Box3> boxes = lights();
    const std::size_t cut = boxes.size();
    const std::vector<Box3> uncut = uncutLights();
    boxes.insert(boxes.end(), uncut.begin(), uncut.end());
    const std::size_t count = boxes.size();
    std::vector<Index> candidates;
    std::vector<Index> root_of;
    for (Index k = 0; k < spaces_.size(); ++k) {
      if (!couldBeHollow(k)) continue;
      out[k] = 1;
      candidates.push_back(Index(boxes.size()));
      root_of.push_back(k);
      boxes.push_back(spaces_[k].box.grown(spaces_[k].coincidence));
    }
    for (const auto& [light, box] : overlappingPairs(boxes, candidates)) {
      if (light >= count || box < count) continue;
      const bool lit = light >= cut || (boxes[box].contains(boxes[light].low) &&
                                        boxes[box].contains(boxes[light].high));
      if (lit) out[root_of[box - count]] = 0;
    }
    return out;
  }

  const Scene& scene_;
  const InputFaces& input_;
  const std::vector<Plane>& planes_;
  const EdgeTable& edges_;
  const Arrangement& arrangement_;
  const std::vector<Sheet>& sheets_;
  UnionFind sets_;
  std::vector<Space> spaces_;  ///< at the roots of sets_
};

}  // namespace

Hollows::Hollows(const Scene& scene, const InputFaces& input, const std::vector<Plane>& planes,
                 const EdgeTable& edges, const Arrangement& arrangement,
                 const std::vector<Sheet>& sheets)
    : dark_(SpaceSearch(scene, input, planes, edges, arrangement, sheets).dark()) {}

}  // namespace radiosity
