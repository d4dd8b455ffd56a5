#include "mesh/polygons/complex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "mesh/arrangement/arrangement.h"
#include "mesh/arrangement/contacts.h"
#include "mesh/arrangement/cut_planes.h"
#include "mesh/arrangement/split_edges.h"
#include "mesh/bodies/classify.h"
#include "mesh/bodies/components.h"
#include "mesh/faces/input_faces.h"
#include "mesh/faces/plane_groups.h"
#include "mesh/faces/sheets.h"
#include "mesh/polygons/merge_cells.h"
#include "mesh/polygons/uncut_faces.h"
#include "scene/checks/checks.h"
#include "scene/checks/close_faces.h"
#include "scene/checks/far_apart.h"

namespace radiosity {

namespace {

// After kAttemptsAlone attempts, faces that cannot be cut are taken as they are at once. After
// kAttempts, which no known scene needs, all faces are.
constexpr int kAttemptsAlone = 3;
constexpr int kAttempts = 8;

/// The number of edges of the scene that were split at vertices on them. `before`: the number of
/// edges before.
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

/// The area of each sheet within its welded and split border.
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

/// Adds the area that welding and splitting moved to each surface's report. A polygon that crosses
/// itself has a part turned over; its area is the sum over all parts.
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
  std::map<Index, std::size_t> crossed;
  for (const Index s : inverted) ++crossed[sheets[s].surface];
  for (const auto& [surface, count] : crossed) {
    report.notes.push_back(
        {Severity::warning,
         fmt::format("{}: {}; the part that is turned over faces the same way as the rest",
                     report.surfaces[surface].name,
                     count == 1 ? "a polygon crosses itself"
                                : fmt::format("{} polygons cross themselves", count))});
  }
  for (std::size_t s = 0; s < moved.size(); ++s) addMovedArea(report.surfaces[s], moved[s]);
}

/// Notes surfaces that were dropped altogether, loudly: a room modelled inside out is a solid and
/// buries its furniture.
void noteBuriedSurfaces(const CoarseComplex& complex, const Scene& scene, double weld,
                        MeshReport& report) {
  std::vector<bool> seen(report.surfaces.size(), false);
  for (const CoarsePolygon& p : complex.polygons) seen[p.surface] = true;
  std::vector<Index> buried;
  for (std::size_t s = 0; s < seen.size(); ++s) {
    const SurfaceAreas& areas = report.surfaces[s];
    if (!seen[s] && areas.buried > 0.5 * areas.given) buried.push_back(Index(s));
  }
  if (buried.empty()) return;
  for (std::string& reason : whyDropped(scene, weld, buried)) {
    report.notes.push_back({Severity::loud, std::move(reason)});
  }
}

/// One attempt at the complex of a scene.
class Attempt {
 public:
  Attempt(const Scene& scene, const MeshOptions& options, const std::vector<Handling>& handling,
          MeshReport report, Progress& progress)
      : scene_(scene),
        weld_(options.weld),
        report_(std::move(report)),
        progress_(progress),
        input_(cleanFaces(scene, options, handling, report_)) {}

  /// Fills `complex` and returns true. If planes cannot be cut or polygons come out broken, it
  /// returns false and gives their faces the next handling: alone if they were merged with others
  /// and `some_alone` is set, else as they are.
  bool run(CoarseComplex& complex, bool some_alone, std::vector<Handling>& handling);
  const MeshReport& report() const { return report_; }

 private:
  std::vector<Index> cut();
  std::vector<Index> merge(CoarseComplex& complex);

  const Scene& scene_;
  double weld_;
  MeshReport report_;
  Progress& progress_;
  InputFaces input_;
  std::vector<Plane> planes_;
  std::vector<Sheet> sheets_;
  EdgeTable edges_;
  Arrangement arrangement_;
};

/// Returns the planes that cannot be cut.
std::vector<Index> Attempt::cut() {
  progress_.check();
  planes_ = groupByPlane(input_);
  sheets_ = findSheets(input_, planes_);
  std::size_t sides = 0;
  for (const Sheet& sheet : sheets_) sides += sheet.edges.size();
  edges_.reserve(sides / 2 + sides / 8);  // most have two sides; a few are open or will be cut
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    for (const auto& [from, to] : sheets_[s].edges) edges_.addUse(from, to, Index(s), 1);
  }
  const std::size_t file_edges = edges_.size();
  std::vector<bool> from_file(file_edges);
  for (std::size_t e = 0; e < file_edges; ++e) from_file[e] = edges_[Index(e)].alive();
  addContacts(input_, planes_, sheets_, edges_, progress_);
  auto stuck = cutPlanes(input_, planes_, sheets_, edges_, arrangement_, progress_);
  report_.split_edges = countSplits(edges_, file_edges, from_file);
  return stuck;
}

/// Returns the planes with polygons that came out broken.
std::vector<Index> Attempt::merge(CoarseComplex& complex) {
  report_.nonmanifold_edges = countNonManifold(edges_);
  accountForWelding(input_, planes_, sheets_, edges_, arrangement_, report_);
  const Components components = findComponents(input_, planes_, sheets_, edges_, scene_);
  const auto visible = classify(scene_, input_, planes_, edges_, arrangement_, sheets_, components,
                                report_, progress_);
  std::vector<Index> broken;
  complex =
      mergeCells(scene_, input_, planes_, sheets_, edges_, arrangement_, visible, report_, broken);
  addUncut(scene_, input_, complex, report_);
  noteHandling(input_, report_);
  noteBuriedSurfaces(complex, scene_, weld_, report_);
  return broken;
}

bool Attempt::run(CoarseComplex& complex, bool some_alone, std::vector<Handling>& handling) {
  std::vector<Index> stuck = cut();
  if (stuck.empty()) stuck = merge(complex);
  for (const Index p : stuck) {
    const bool alone = some_alone && planes_[p].faces.size() > 1;
    for (const Index f : planes_[p].faces) {
      handling[input_.faces[f].source] = alone ? Handling::alone : Handling::as_it_is;
    }
  }
  return stuck.empty();
}

/// Polygons back to back whose faces faced each other across a gap: welding has closed it.
void noteLostGaps(const Scene& scene, const CoarseComplex& complex, MeshReport& report) {
  LostGaps lost;
  for (std::size_t p = 0; p < complex.polygons.size(); ++p) {
    const CoarsePolygon& polygon = complex.polygons[p];
    if (polygon.opposite == kNone || polygon.opposite < p) continue;
    for (const Index f : polygon.faces) {
      for (const Index g : complex.polygons[polygon.opposite].faces) {
        const double gap = gapBetween(scene, f, g);
        if (gap > 0) lost.add(scene, f, g, gap);
      }
    }
  }
  const std::vector<Note> notes = lost.notes(scene, complex.coincidence);
  report.notes.insert(report.notes.end(), notes.begin(), notes.end());
}

}  // namespace

CoarseComplex buildComplex(const Scene& scene, const MeshOptions& options, MeshReport& report,
                           Progress& progress) {
  std::vector<Handling> handling(scene.faceCount(), Handling::merged);
  for (int attempts = 1;; ++attempts) {
    Attempt attempt(scene, options, handling, report, progress);
    CoarseComplex complex;
    if (attempt.run(complex, attempts < kAttemptsAlone, handling)) {
      report = attempt.report();
      noteLostGaps(scene, complex, report);
      if (const auto note = noteFarApart(scene, options.weld)) report.notes.push_back(*note);
      return complex;
    }
    if (attempts == kAttempts) handling.assign(handling.size(), Handling::as_it_is);
  }
}

}  // namespace radiosity
