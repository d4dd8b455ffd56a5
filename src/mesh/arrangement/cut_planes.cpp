#include "mesh/arrangement/cut_planes.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "base/parallel.h"

namespace radiosity {

namespace {

/// The rounds in which edges that cross only in the image of a plane are made to meet. Usually
/// there is one; more are rare. From round kRoundsOfSnapping on, a vertex through which an edge
/// should pass is merged with the edge's end if that is within a coincidence or two, so that the
/// number of vertices falls. Planes that still need repairs after kRoundsOfRepair are given up. So
/// are planes whose repairs grow in number: if many edges are about as long as the coincidence,
/// each edge that is made to meet another crosses two more.
constexpr int kRoundsOfSnapping = 4;
constexpr int kRoundsOfRepair = 40;
constexpr double kMostRepairGrowth = 2.0;

class PlaneCuts {
 public:
  PlaneCuts(InputFaces& input, const std::vector<Plane>& planes, const std::vector<Sheet>& sheets,
            EdgeTable& edges, Progress& progress)
      : input_(input),
        planes_(planes),
        sheets_(sheets),
        edges_(edges),
        progress_(progress),
        cuts_(planes.size()),
        stale_(planes.size(), true) {}

  std::vector<Index> run();
  Arrangement arrangement();

 private:
  void markStale();
  void cutStale();
  Repairs repairs();
  Repairs collapse(const Repairs& repairs) const;
  std::vector<std::vector<Index>> edgesByPlane() const;

  InputFaces& input_;
  const std::vector<Plane>& planes_;
  const std::vector<Sheet>& sheets_;
  EdgeTable& edges_;
  Progress& progress_;
  std::vector<PlaneCut> cuts_;
  std::vector<bool> stale_;
};

std::vector<Index> PlaneCuts::run() {
  Repairs wanted;
  std::size_t before = 0;
  for (int round = 0; round < kRoundsOfRepair; ++round) {
    splitEdges(input_.points, edges_, wanted, progress_);
    markStale();
    cutStale();
    wanted = repairs();
    if (round >= kRoundsOfSnapping) wanted = collapse(wanted);
    const std::size_t count = wanted.splits.size() + wanted.merges.size();
    if (count == 0 || (round > 0 && double(count) > kMostRepairGrowth * double(before))) break;
    before = count;
  }
  std::vector<Index> stuck;
  for (Index p = 0; p < cuts_.size(); ++p) {
    if (!cuts_[p].done) stuck.push_back(p);
  }
  return stuck;
}

/// Marks the planes with an edge that was replaced.
void PlaneCuts::markStale() {
  for (const Edge& edge : edges_.takeReplaced()) {
    for (const EdgeUse& use : edge.uses) stale_[sheets_[use.sheet].plane] = true;
    for (const Index plane : edge.contacts) stale_[plane] = true;
  }
}

/// The edges in each stale plane, ascending.
std::vector<std::vector<Index>> PlaneCuts::edgesByPlane() const {
  std::vector<std::vector<Index>> own(planes_.size());
  for (Index e = 0; e < edges_.size(); ++e) {
    const auto enter = [&](Index plane) {
      if (!stale_[plane] || (!own[plane].empty() && own[plane].back() == e)) return;
      own[plane].push_back(e);
    };
    for (const EdgeUse& use : edges_[e].uses) enter(sheets_[use.sheet].plane);
    for (const Index plane : edges_[e].contacts) enter(plane);
  }
  return own;
}

void PlaneCuts::cutStale() {
  const auto own = edgesByPlane();
  std::vector<Index> which;
  for (Index p = 0; p < planes_.size(); ++p) {
    if (stale_[p]) which.push_back(p);
  }
  progress_.begin("planes", which.size());
  parallelFor(which.size(), 16, [&](std::size_t k) {
    if (progress_.cancelled()) return;
    const Index p = which[k];
    cuts_[p] = cutPlane(input_.points, planes_, p, sheets_, edges_, own[p]);
    progress_.advance();
  });
  progress_.check();
  progress_.end();
  stale_.assign(planes_.size(), false);
}

/// The repairs that the planes ask for, in the planes' order.
Repairs PlaneCuts::repairs() {
  Repairs out;
  for (PlaneCut& cut : cuts_) {
    if (cut.done) continue;
    const auto& more = cut.unresolved;
    out.splits.insert(out.splits.end(), more.splits.begin(), more.splits.end());
    out.merges.insert(out.merges.end(), more.merges.begin(), more.merges.end());
    for (const ImageCrossing& crossing : cut.crossings) {
      const Edge& f = edges_[crossing.first];
      const Edge& g = edges_[crossing.second];
      const std::array<Index, 4> ends{f.a, f.b, g.a, g.b};
      const Index vertex = input_.points.insert(crossing.at, coincidenceOf(input_.points, ends));
      for (const Index e : {crossing.first, crossing.second}) {
        if (vertex != edges_[e].a && vertex != edges_[e].b) out.splits.push_back({e, vertex});
      }
    }
  }
  return out;
}

Repairs PlaneCuts::collapse(const Repairs& repairs) const {
  const WeldedPoints& points = input_.points;
  Repairs out;
  out.merges = repairs.merges;
  for (const ForcedSplit& s : repairs.splits) {
    const Edge& edge = edges_[s.edge];
    const double to_a = glm::distance(points[s.vertex], points[edge.a]);
    const double to_b = glm::distance(points[s.vertex], points[edge.b]);
    const std::array<Index, 3> all{s.vertex, edge.a, edge.b};
    if (std::min(to_a, to_b) < 2.0 * coincidenceOf(points, all)) {
      out.merges.push_back({s.vertex, to_a <= to_b ? edge.a : edge.b});
    } else {
      out.splits.push_back(s);
    }
  }
  return out;
}

Arrangement PlaneCuts::arrangement() {
  Arrangement out;
  out.sides.resize(edges_.size());
  for (PlaneCut& cut : cuts_) {
    const Index first = Index(out.cells.size());
    const auto shifted = [&](Index cell) { return cell == kNone ? kNone : first + cell; };
    for (PlaneCell& cell : cut.cells) out.cells.push_back(std::move(cell));
    for (const auto& [edge, sides] : cut.sides) {
      out.sides[edge].push_back({sides.plane, shifted(sides.left), shifted(sides.right)});
    }
    out.inverted.insert(out.inverted.end(), cut.inverted.begin(), cut.inverted.end());
  }
  return out;
}

}  // namespace

std::vector<Index> cutPlanes(InputFaces& input, const std::vector<Plane>& planes,
                             const std::vector<Sheet>& sheets, EdgeTable& edges, Arrangement& out,
                             Progress& progress) {
  PlaneCuts cuts(input, planes, sheets, edges, progress);
  std::vector<Index> stuck = cuts.run();
  if (stuck.empty()) out = cuts.arrangement();
  return stuck;
}

}  // namespace radiosity
