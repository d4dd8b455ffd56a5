#include "mesh/bodies/components.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/geometry/plane_frame.h"

namespace radiosity {

namespace {

/// Disjoint sets whose members carry a sign relative to the representative.
class SignedUnionFind {
 public:
  explicit SignedUnionFind(std::size_t count) : parent_(count), sign_(count, 1) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = Index(i);
  }
  struct Root {
    Index root;
    int sign;
  };
  Root find(Index x) const {
    int sign = 1;
    while (parent_[x] != x) {
      sign *= sign_[x];
      x = parent_[x];
    }
    return {x, sign};
  }
  /// Joins a and b so that their signs multiply to `relative`; false if they already disagree.
  bool unite(Index a, Index b, int relative) {
    Root ra = find(a);
    Root rb = find(b);
    if (ra.root == rb.root) return ra.sign * rb.sign == relative;
    if (size(ra.root) < size(rb.root)) std::swap(ra, rb);
    parent_[rb.root] = ra.root;
    sign_[rb.root] = ra.sign * rb.sign * relative;
    sizes_[ra.root] += size(rb.root);
    return true;
  }

 private:
  std::size_t& size(Index root) {
    if (sizes_.empty()) sizes_.assign(parent_.size(), 1);
    return sizes_[root];
  }
  std::vector<Index> parent_;
  std::vector<int> sign_;
  std::vector<std::size_t> sizes_;
};

/// One layer of a sheet at an edge, as a half-plane that ends there.
struct HalfPlane {
  Index sheet;
  bool forward;  ///< the sheet's border runs along the edge from a to b
  double angle;  ///< about the edge, from an arbitrary start
  Index plane;
  int side;  ///< with `plane`: equal for half-planes that coincide
};

class Joiner {
 public:
  Joiner(const InputFaces& input, const std::vector<Plane>& planes,
         const std::vector<Sheet>& sheets, const Scene& scene)
      : input_(input),
        planes_(planes),
        sheets_(sheets),
        scene_(scene),
        sets_(sheets.size()),
        open_(sheets.size(), false) {}

  void join(const Edge& edge);
  Components collect();

 private:
  bool isTwoSided(Index sheet) const {
    return scene_.materials[scene_.surfaces[sheets_[sheet].surface].material].two_sided;
  }
  std::vector<HalfPlane> around(const Edge& edge) const;
  void match(const std::vector<HalfPlane>& ring);
  int likeness(Index a, Index b) const;
  void matchCoincident(const std::vector<HalfPlane>& ring, std::vector<std::size_t> closing,
                       std::vector<std::size_t>& opened, std::vector<bool>& matched);
  void addTriangles(Index sheet, Component& component, int sign) const;
  void close(Component& component, Components& all) const;

  const InputFaces& input_;
  const std::vector<Plane>& planes_;
  const std::vector<Sheet>& sheets_;
  const Scene& scene_;
  SignedUnionFind sets_;
  std::vector<bool> open_;  ///< by sheet
};

/// All half-planes at an edge in the order of their angles about it (a to b, right-handed). Of
/// coincident ones, those with the space behind them at smaller angles come first, so that there is
/// no body of thickness zero between them.
std::vector<HalfPlane> Joiner::around(const Edge& edge) const {
  const Vec3 axis = glm::normalize(input_.points[edge.b] - input_.points[edge.a]);
  const PlaneFrame across = makeFrame(Vec3(0.0), axis, axisAcross(axis));
  const Vec3& u = across.u;
  const Vec3& v = across.v;
  std::vector<HalfPlane> ring;
  for (const EdgeUse& use : edge.uses) {
    const Sheet& sheet = sheets_[use.sheet];
    const bool forward = use.count > 0;
    const Vec3 front = planes_[sheet.plane].normal * double(sheet.facing);
    const Vec3 inward = glm::cross(front, axis) * (forward ? 1.0 : -1.0);
    HalfPlane half{use.sheet, forward, std::atan2(glm::dot(inward, v), glm::dot(inward, u)),
                   sheet.plane, sheet.facing * (forward ? 1 : -1)};
    // Coincident half-planes get one angle, to the bit.
    for (const HalfPlane& other : ring) {
      if (other.plane == half.plane && other.side == half.side) half.angle = other.angle;
    }
    for (int layer = 0; layer < std::abs(use.count); ++layer) ring.push_back(half);
  }
  // A sheet that runs from a to b has its front at larger angles and its back at smaller ones.
  std::stable_sort(ring.begin(), ring.end(), [](const HalfPlane& x, const HalfPlane& y) {
    return x.angle != y.angle ? x.angle < y.angle : x.forward && !y.forward;
  });
  return ring;
}

/// How likely two sheets belong to one body, where geometry does not tell: 0 to 3.
int Joiner::likeness(Index a, Index b) const {
  if (sheets_[a].surface == sheets_[b].surface) return 3;
  const auto objectOf = [&](Index s) { return scene_.surfaces[sheets_[s].surface].object; };
  if (objectOf(a) == objectOf(b)) return 2;
  return isTwoSided(a) == isTwoSided(b) ? 1 : 0;
}

/// Matches coincident half-planes with the last ones that opened a space; `opened` loses these. If
/// the last ones coincide with others, geometry leaves the choice: a cupboard in the corner of a
/// room has its own edges on those of the room.
void Joiner::matchCoincident(const std::vector<HalfPlane>& ring, std::vector<std::size_t> closing,
                             std::vector<std::size_t>& opened, std::vector<bool>& matched) {
  std::size_t first = opened.size() - std::min(opened.size(), closing.size());
  while (first > 0 && first < opened.size() &&
         ring[opened[first - 1]].angle == ring[opened[first]].angle) {
    --first;
  }
  for (int wanted = 3; wanted >= 0; --wanted) {
    for (std::size_t& at : closing) {
      for (std::size_t k = opened.size(); at != ring.size() && k-- > first;) {
        const std::size_t partner = opened[k];
        if (likeness(ring[at].sheet, ring[partner].sheet) < wanted) continue;
        matched[at] = matched[partner] = true;
        if (!sets_.unite(ring[at].sheet, ring[partner].sheet, 1)) open_[ring[at].sheet] = true;
        opened.erase(opened.begin() + std::ptrdiff_t(k));
        at = ring.size();
      }
    }
  }
}

/// Matches half-planes like brackets around a circle: a sheet that runs back opens the space behind
/// it, one that runs forward closes it. Unmatched ones are open borders.
void Joiner::match(const std::vector<HalfPlane>& ring) {
  std::vector<bool> matched(ring.size(), false);
  std::vector<std::size_t> opened;
  for (std::size_t k = 0; k < 2 * ring.size(); ++k) {
    const std::size_t at = k % ring.size();
    if (matched[at]) continue;
    if (!ring[at].forward) {
      if (k < ring.size()) opened.push_back(at);
      continue;
    }
    std::vector<std::size_t> closing;
    for (std::size_t next = at; next < ring.size() && ring[next].angle == ring[at].angle; ++next) {
      if (ring[next].forward && !matched[next]) closing.push_back(next);
    }
    matchCoincident(ring, std::move(closing), opened, matched);
  }
  for (std::size_t k = 0; k < ring.size(); ++k) {
    if (!matched[k]) open_[ring[k].sheet] = true;
  }
}

void Joiner::join(const Edge& edge) {
  if (edge.uses.empty()) return;
  const bool simple = edge.uses.size() == 2 && std::abs(edge.uses[0].count) == 1 &&
                      std::abs(edge.uses[1].count) == 1;
  if (!simple) return match(around(edge));
  const EdgeUse& x = edge.uses[0];
  const EdgeUse& y = edge.uses[1];
  const bool agree = x.count != y.count;
  if (!agree && !(isTwoSided(x.sheet) && isTwoSided(y.sheet))) {
    open_[x.sheet] = open_[y.sheet] = true;
    return;
  }
  if (!sets_.unite(x.sheet, y.sheet, agree ? 1 : -1)) open_[x.sheet] = true;
}

void Joiner::addTriangles(Index sheet, Component& component, int sign) const {
  for (const Index f : sheets_[sheet].faces) {
    const auto& loop = input_.faces[f].loop;
    // A fan is enough, even for a concave polygon: its triangles are only summed with signs.
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      std::array<Vec3, 3> t{input_.points[loop[0]], input_.points[loop[k]],
                            input_.points[loop[k + 1]]};
      if (sign < 0) std::swap(t[1], t[2]);
      component.triangles.push_back(t);
      component.triangle_plane.push_back(sheets_[sheet].plane);
    }
  }
}

/// Decides which way is out, and whether there is a volume inside.
void Joiner::close(Component& component, Components& all) const {
  const Vec3 centre = 0.5 * (component.box.low + component.box.high);
  double volume = 0;
  double area = 0;
  for (const auto& t : component.triangles) {
    volume += glm::dot(t[0] - centre, glm::cross(t[1] - centre, t[2] - centre)) / 6.0;
    area += 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
  }
  component.closed = std::abs(volume) > 0.5 * area * component.coincidence;
  component.inward = component.closed && volume < 0;
  if (!component.inward) return;
  for (auto& t : component.triangles) std::swap(t[1], t[2]);
  for (const Index s : component.sheets) all.outward[s] = -all.outward[s];
}

Components Joiner::collect() {
  std::vector<bool> open(sheets_.size(), false);
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    if (open_[s]) open[sets_.find(Index(s)).root] = true;
  }
  Components out;
  out.of_sheet.resize(sheets_.size());
  out.outward.assign(sheets_.size(), 1);
  std::vector<Index> number(sheets_.size(), kNone);
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const auto [root, sign] = sets_.find(Index(s));
    if (number[root] == kNone) {
      number[root] = Index(out.list.size());
      out.list.emplace_back();
      out.list.back().two_sided = true;
    }
    Component& component = out.list[number[root]];
    out.of_sheet[s] = number[root];
    out.outward[s] = sign;
    component.sheets.push_back(Index(s));
    component.two_sided = component.two_sided && isTwoSided(Index(s));
    component.box.add(sheets_[s].box.low);
    component.box.add(sheets_[s].box.high);
    component.coincidence = std::min(component.coincidence, sheets_[s].coincidence);
    addTriangles(Index(s), component, sign);
  }
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    if (sets_.find(Index(s)).root == s && !open[s]) close(out.list[number[s]], out);
  }
  return out;
}

}  // namespace

Components findComponents(const InputFaces& input, const std::vector<Plane>& planes,
                          const std::vector<Sheet>& sheets, const EdgeTable& edges,
                          const Scene& scene) {
  Joiner joiner(input, planes, sheets, scene);
  for (std::size_t e = 0; e < edges.size(); ++e) joiner.join(edges[Index(e)]);
  return joiner.collect();
}

}  // namespace radiosity
