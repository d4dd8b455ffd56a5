#include "mesh/complex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "mesh/arrangement.h"
#include "mesh/classify.h"
#include "mesh/components.h"
#include "mesh/contacts.h"
#include "mesh/input_faces.h"
#include "mesh/merge_cells.h"
#include "mesh/plane_groups.h"
#include "mesh/sheets.h"
#include "mesh/split_edges.h"

namespace radiosity {

namespace {

/// Rounds of making edges meet that cross only in the image of a plane: one is the rule, more are
/// rare. From kPatience on, a vertex that an edge is to be led through becomes one with the edge's
/// end if that is as near as a coincidence or two. There are ever fewer vertices then, so it ends;
/// kRounds only guards that.
constexpr int kPatience = 4;
constexpr int kRounds = 100;

Repairs collapse(const Repairs& repairs, const WeldedPoints& points, double coincidence,
                 const EdgeTable& edges) {
  Repairs out;
  out.merges = repairs.merges;
  for (const ForcedSplit& s : repairs.splits) {
    const Edge& edge = edges[s.edge];
    const double to_a = glm::distance(points[s.vertex], points[edge.a]);
    const double to_b = glm::distance(points[s.vertex], points[edge.b]);
    if (std::min(to_a, to_b) < 2.0 * coincidence) {
      out.merges.push_back({s.vertex, to_a <= to_b ? edge.a : edge.b});
    } else {
      out.splits.push_back(s);
    }
  }
  return out;
}

Arrangement cutPlanes(const Scene& scene, InputFaces& input, const std::vector<Plane>& planes,
                      const std::vector<Sheet>& sheets, EdgeTable& edges, Progress& progress) {
  Repairs repairs;
  for (int round = 0; round < kRounds; ++round) {
    splitEdges(input.points, input.coincidence, edges, repairs, progress);
    Arrangement arrangement = arrange(input.points, planes, sheets, edges, progress);
    if (arrangement.unresolved.empty()) return arrangement;
    repairs = round < kPatience
                  ? arrangement.unresolved
                  : collapse(arrangement.unresolved, input.points, input.coincidence, edges);
  }
  throw RunError(
      fmt::format("{}: details about as large as the coincidence of {:.3g} m do not "
                  "come apart; give a larger or a smaller --weld",
                  scene.file, input.coincidence));
}

/// Edges of the scene that were split at vertices on them; `before` are the ones there were.
std::size_t countSplits(const EdgeTable& edges, std::size_t before,
                        const std::vector<bool>& from_file) {
  std::size_t count = 0;
  for (std::size_t e = 0; e < before; ++e) {
    if (from_file[e] && !edges[Index(e)].alive()) ++count;
  }
  return count;
}

std::size_t countNonManifold(const EdgeTable& edges) {
  std::size_t count = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    std::size_t faces = 0;
    for (const EdgeUse& use : edges[Index(e)].uses) faces += std::size_t(std::abs(use.count));
    if (faces > 2) ++count;
  }
  return count;
}

/// Area of each sheet within its border as welded and split.
std::vector<double> sheetAreas(const InputFaces& input, const std::vector<Plane>& planes,
                               const std::vector<Sheet>& sheets, const EdgeTable& edges) {
  std::vector<Vec3> doubled(sheets.size(), Vec3(0.0));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Edge& edge = edges[Index(e)];
    for (const EdgeUse& use : edge.uses) {
      const Vec3 o = input.points[input.faces[sheets[use.sheet].faces[0]].loop[0]];
      doubled[use.sheet] +=
          double(use.count) * glm::cross(input.points[edge.a] - o, input.points[edge.b] - o);
    }
  }
  std::vector<double> out;
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    out.push_back(0.5 * std::abs(glm::dot(doubled[s], planes[sheets[s].plane].normal)));
  }
  return out;
}

/// What welding and splitting moved, by surface; and polygons that cross themselves, of which a
/// part is turned over: their area is that of all parts.
void accountForWelding(const InputFaces& input, const std::vector<Plane>& planes,
                       const std::vector<Sheet>& sheets, const EdgeTable& edges,
                       const Arrangement& arrangement, MeshReport& report) {
  const std::vector<double> area = sheetAreas(input, planes, sheets, edges);
  const std::set<Index> inverted(arrangement.inverted.begin(), arrangement.inverted.end());
  std::vector<double> moved(report.surfaces.size(), 0.0);
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    double given = 0;
    for (const Index f : sheets[s].faces) given += input.faces[f].area;
    if (inverted.count(Index(s)) == 0) {
      moved[sheets[s].surface] += given - area[s];
    } else {
      report.surfaces[sheets[s].surface].given -= given;
    }
  }
  for (const PlaneCell& cell : arrangement.cells) {
    for (const auto& [sheet, layers] : cell.cover) {
      if (inverted.count(sheet) == 0) continue;
      report.surfaces[sheets[sheet].surface].given += layers * cell.area;
    }
  }
  for (const Index s : inverted) {
    report.notes.push_back(
        {Severity::warning, fmt::format("{}: a polygon crosses itself; the part that is turned "
                                        "over faces the same way as the rest",
                                        report.surfaces[sheets[s].surface].name)});
  }
  for (std::size_t s = 0; s < moved.size(); ++s) addMovedArea(report.surfaces[s], moved[s]);
}

/// A surface that is gone altogether is worth a loud word: a room modelled inside out is a solid,
/// and swallows its furniture.
void noteBuriedSurfaces(const CoarseComplex& complex, MeshReport& report) {
  std::vector<bool> seen(report.surfaces.size(), false);
  for (const CoarsePolygon& p : complex.polygons) seen[p.surface] = true;
  for (std::size_t s = 0; s < seen.size(); ++s) {
    const SurfaceAreas& areas = report.surfaces[s];
    if (seen[s] || areas.buried <= 0.5 * areas.given) continue;
    report.notes.push_back(
        {Severity::loud, fmt::format("{}: lies wholly inside a closed solid and was dropped; if "
                                     "that is a room, its faces are turned outward",
                                     areas.name)});
  }
}

}  // namespace

CoarseComplex buildComplex(const Scene& scene, const MeshOptions& options, MeshReport& report,
                           Progress& progress) {
  InputFaces input = cleanFaces(scene, options, report);
  progress.check();
  const std::vector<Plane> planes = groupByPlane(input);
  const std::vector<Sheet> sheets = findSheets(input, planes);
  EdgeTable edges;
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    for (const auto& [from, to] : sheets[s].edges) edges.addUse(from, to, Index(s), 1);
  }
  const std::size_t file_edges = edges.size();
  std::vector<bool> from_file(file_edges);
  for (std::size_t e = 0; e < file_edges; ++e) from_file[e] = edges[Index(e)].alive();
  addContacts(input, planes, sheets, edges, progress);

  Arrangement arrangement = cutPlanes(scene, input, planes, sheets, edges, progress);
  report.split_edges = countSplits(edges, file_edges, from_file);
  report.nonmanifold_edges = countNonManifold(edges);
  accountForWelding(input, planes, sheets, edges, arrangement, report);

  const Components components = findComponents(input, planes, sheets, edges, scene);
  const auto visible = classify(scene, arrangement, sheets, components, input, report);
  CoarseComplex complex =
      mergeCells(scene, input, planes, sheets, edges, arrangement, visible, report);
  noteBuriedSurfaces(complex, report);
  return complex;
}

}  // namespace radiosity
