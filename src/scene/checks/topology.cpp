#include "scene/checks/topology.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>
#include <utility>

namespace radiosity {

namespace {

/// One edge of one face.
struct EdgeUse {
  Index low, high;  ///< its ends
  Index face;
  bool forward;  ///< from low to high
};

std::vector<EdgeUse> collectEdges(const WeldedFaces& faces, const std::vector<std::uint8_t>& skip) {
  std::vector<EdgeUse> uses;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = faces.face(f);
    if (face.size() < 3 || skip[f] != 0) continue;
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k];
      const Index b = face[(k + 1) % face.size()];
      uses.push_back({std::min(a, b), std::max(a, b), Index(f), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& x, const EdgeUse& y) {
    return std::tie(x.low, x.high, x.face) < std::tie(y.low, y.high, y.face);
  });
  return uses;
}

/// Calls visit(uses of one edge) for every edge.
template <class Visit>
void forEachEdge(std::span<const EdgeUse> uses, Visit&& visit) {
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin + 1;
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high) {
      ++end;
    }
    visit(uses.subspan(begin, end - begin));
    begin = end;
  }
}

/// The neighbour across an edge that two faces share; `against`: both run along it the same way.
struct Neighbour {
  Index face;
  bool against;
};

using Adjacency = std::vector<std::vector<Neighbour>>;

Adjacency joinFaces(std::span<const EdgeUse> uses, std::size_t faces) {
  Adjacency adjacency(faces);
  forEachEdge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2 || edge[0].face == edge[1].face) return;
    const bool against = edge[0].forward == edge[1].forward;
    adjacency[edge[0].face].push_back({edge[1].face, against});
    adjacency[edge[1].face].push_back({edge[0].face, against});
  });
  return adjacency;
}

/// Collects the part connected to `seed`; flipped[f] is relative to the seed.
ConnectedPart floodPart(Index seed, Index number, const Adjacency& adjacency, Topology& topology) {
  ConnectedPart part;
  std::vector<Index> waiting = {seed};
  topology.part_of[seed] = number;
  while (!waiting.empty()) {
    const Index f = waiting.back();
    waiting.pop_back();
    part.faces.push_back(f);
    for (const Neighbour& next : adjacency[f]) {
      const auto turned = std::uint8_t(topology.flipped[f] ^ (next.against ? 1 : 0));
      if (topology.part_of[next.face] == kNone) {
        topology.part_of[next.face] = number;
        topology.flipped[next.face] = turned;
        waiting.push_back(next.face);
      } else if (topology.flipped[next.face] != turned) {
        part.orientable = false;
      }
    }
  }
  return part;
}

/// Marks the minority, by area, as flipped.
void settleFlips(const WeldedFaces& faces, const ConnectedPart& part, Topology& topology) {
  double balance = 0;
  for (const Index f : part.faces) {
    const double area = glm::length(faces.area_vector[f]);
    balance += topology.flipped[f] != 0 ? area : -area;
  }
  for (const Index f : part.faces) {
    if (!part.orientable) topology.flipped[f] = 0;
    if (part.orientable && balance > 0) topology.flipped[f] ^= 1;
  }
}

void measure(const WeldedFaces& faces, const std::vector<std::uint8_t>& flipped,
             ConnectedPart& part) {
  part.lower = Vec3(std::numeric_limits<double>::infinity());
  part.upper = -part.lower;
  for (const Index f : part.faces) {
    for (const Index corner : faces.face(f)) {
      part.lower = glm::min(part.lower, faces.points[corner]);
      part.upper = glm::max(part.upper, faces.points[corner]);
    }
  }
  if (!part.closed) return;
  // By the divergence theorem, about a corner of the box, so that little cancels.
  for (const Index f : part.faces) {
    const Vec3 origin = faces.points[faces.face(f)[0]] - part.lower;
    const double sixth = glm::dot(origin, faces.area_vector[f]) / 3;
    part.volume += flipped[f] != 0 ? -sixth : sixth;
  }
}

/// The uses of one edge by the faces of one part.
struct Tally {
  int balance = 0;
  std::size_t count = 0;
  bool winding_matters = false;
  bool cancels() const { return winding_matters ? balance == 0 : count % 2 == 0; }
};

/// Marks parts that have an edge whose uses do not cancel, and counts edges.
void countEdges(std::span<const EdgeUse> uses, const std::vector<std::uint8_t>& two_sided,
                Topology& topology) {
  for (ConnectedPart& part : topology.parts) part.closed = true;
  std::vector<std::pair<Index, const EdgeUse*>> by_part;
  forEachEdge(uses, [&](std::span<const EdgeUse> edge) {
    topology.open_edges += edge.size() == 1 ? 1 : 0;
    topology.nonmanifold_edges += edge.size() > 2 ? 1 : 0;
    by_part.clear();
    for (const EdgeUse& use : edge) by_part.emplace_back(topology.part_of[use.face], &use);
    std::sort(by_part.begin(), by_part.end());
    for (std::size_t begin = 0; begin < by_part.size();) {
      const Index part = by_part[begin].first;
      Tally tally;
      for (; begin < by_part.size() && by_part[begin].first == part; ++begin) {
        const EdgeUse& use = *by_part[begin].second;
        tally.balance += use.forward ? 1 : -1;
        ++tally.count;
        tally.winding_matters |= two_sided[use.face] == 0;
      }
      if (!tally.cancels()) topology.parts[part].closed = false;
    }
  });
}

}  // namespace

Topology analyseTopology(const WeldedFaces& faces, const std::vector<std::uint8_t>& two_sided,
                         const std::vector<std::uint8_t>& skip) {
  Topology topology;
  topology.part_of.assign(faces.size(), kNone);
  topology.flipped.assign(faces.size(), 0);
  const std::vector<EdgeUse> uses = collectEdges(faces, skip);
  const Adjacency adjacency = joinFaces(uses, faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const bool takes_part = faces.face(f).size() >= 3 && skip[f] == 0;
    if (!takes_part || topology.part_of[f] != kNone) continue;
    const auto number = Index(topology.parts.size());
    topology.parts.push_back(floodPart(Index(f), number, adjacency, topology));
    settleFlips(faces, topology.parts.back(), topology);
  }
  countEdges(uses, two_sided, topology);
  topology.closed = !topology.parts.empty();
  for (ConnectedPart& part : topology.parts) {
    measure(faces, topology.flipped, part);
    // A sheet folded onto itself encloses nothing.
    const double thinnest = faces.tolerance * glm::distance(part.lower, part.upper);
    const bool encloses = std::abs(part.volume) > thinnest * faces.tolerance;
    topology.closed = topology.closed && part.closed && encloses;
  }
  return topology;
}

}  // namespace radiosity
