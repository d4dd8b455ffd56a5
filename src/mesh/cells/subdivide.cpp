#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <set>

#include "base/geometry/box.h"
#include "base/geometry/plane_frame.h"
#include "base/parallel.h"
#include "mesh/cells/join_cells.h"
#include "mesh/cells/polygon_cells.h"
#include "mesh/cells/size_search.h"
#include "mesh/patches/mesh_figures.h"
#include "mesh/patches/patch_arrays.h"
#include "mesh/polygons/complex.h"
#include "mesh/polygons/merge_cells.h"

namespace radiosity {

namespace {

// The largest cells, relative to an even division of all area. So walls are still cut if thousands
// of small polygons use up the patches asked for.
constexpr double kLargestSize = 3.0;
constexpr double kMuchMore = 1.15;
// If polygons alone are this many times the patches asked for, their number no longer counts: cells
// are then this large, relative to an even division of all area, so that walls are still cut, and
// other patches grow by a tenth or two.
constexpr double kFarMore = 1.2;
constexpr double kSizeAmongMany = 1.5;
// The least distances of cuts opposite of vertices across narrow strips, in widths: angles of
// patches there are at least atan(1 / spacing). We take the first that is affordable.
constexpr double kSpacings[] = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0};
constexpr double kCoarser = 1.5;  // the most by which these cuts may enlarge other cells
// The background grid has one step across polygons of less than 1.5 sizes: the number of steps is
// the polygon's width over the size, rounded, and at least one. A little less allows for rounding.
constexpr double kPlainDiameter = 1.49;
// Cells lower than this, in coincidences, come of corners that noise has moved: no patch of its
// own.
constexpr double kThin = 4.0;
constexpr double kNoOpposites = std::numeric_limits<double>::infinity();

double areaOf(const CoarseComplex& complex, const CoarsePolygon& polygon) {
  Vec3 sum(0.0);
  for (const auto& loop : polygon.loops) {
    sum += vectorArea(loop.size(), [&](std::size_t k) { return complex.vertices[loop[k]]; });
  }
  return glm::dot(sum, polygon.normal);
}

double areaOf(const CoarseComplex& complex) {
  double area = 0;
  for (const CoarsePolygon& polygon : complex.polygons) area += areaOf(complex, polygon);
  return area;
}

/// The length of all loops.
double outlineOf(const CoarseComplex& complex) {
  double length = 0;
  for (const CoarsePolygon& polygon : complex.polygons) {
    for (const auto& loop : polygon.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        length +=
            glm::length(complex.vertices[loop[(k + 1) % loop.size()]] - complex.vertices[loop[k]]);
      }
    }
  }
  return length;
}

/// The diameter of the box around a polygon, an upper bound of the polygon's own.
double diameterOf(const CoarseComplex& complex, const CoarsePolygon& polygon) {
  Box3 box;
  for (const auto& loop : polygon.loops) {
    for (const Index v : loop) box.add(complex.vertices[v]);
  }
  return box.diagonal();
}

class Subdivision {
 public:
  Subdivision(const CoarseComplex& complex, Progress& progress)
      : complex_(complex), progress_(progress), cuts_(complex) {
    diameter_.reserve(complex.polygons.size());
    for (const CoarsePolygon& polygon : complex.polygons) {
      diameter_.push_back(diameterOf(complex, polygon));
    }
  }

  /// Makes the cells of every polygon; returns their number. Without `size.improve`, polygons with
  /// edges to cut or larger than the size are improved nevertheless.
  std::size_t run(const CellSize& size, Rounding rounding, double spacing) {
    for (;;) {
      cuts_.cut(std::isfinite(size.longest) ? size.longest : size.size, rounding, spacing);
      bool again = false;
      for (const Index p : cutPolygons(size)) {
        if (!whole_.insert(p).second) continue;
        cuts_.keepWhole(p);
        again = true;
      }
      if (!again) break;
    }
    return recount();
  }

  /// Joins cells to patches of up to size^2; returns the number of patches.
  std::size_t join(double size) {
    parallelFor(cells_.size(), 16, [&](std::size_t p) {
      if (!progress_.cancelled()) joinCellsOf(p, size);
    });
    progress_.check();
    return recount();
  }

  /// The polygons whose edges are not cut, since they are too near to each other.
  const std::set<Index>& whole() const { return whole_; }
  void findOpposites(double largest) { cuts_.findOpposites(largest); }
  bool hasOpposites() const { return cuts_.hasOpposites(); }
  double count() const { return double(count_); }
  const EdgeCuts& cuts() const { return cuts_; }
  const std::vector<PolygonCells>& cells() const { return cells_; }

 private:
  /// `size`: 0 to join thin cells alone.
  void joinCellsOf(std::size_t p, double size) {
    PolygonCells& polygon = cells_[p];
    polygon.groups.clear();
    if (polygon.cells.size() < 2) return;
    std::vector<Vec3> points;
    points.reserve(polygon.boundary.size() + polygon.interior.size());
    for (const Index id : polygon.boundary) points.push_back(cuts_.point(id));
    points.insert(points.end(), polygon.interior.begin(), polygon.interior.end());
    const JoinLimits limits{size, kThin * complex_.coincidenceOf(complex_.polygons[p])};
    if (size == 0 && !anyThin(polygon.cells, points, limits.thinnest)) return;
    polygon.groups = joinCells(polygon.cells, polygon.inner, points, limits);
  }

  /// How the cells of a polygon were made: those of plain ones suit any size (isPlain()).
  enum class Made : char { to_size, plain, plain_as_it_is };

  std::size_t recount() {
    count_ = 0;
    for (std::size_t p = 0; p < cells_.size(); ++p) {
      count_ += cells_[cellSource(complex_, p)].patches();
    }
    return count_;
  }

  /// Fills cells_; returns the polygons, ascending, that have no cells because their cut edges
  /// cross.
  std::vector<Index> cutPolygons(const CellSize& size) {
    progress_.check();
    progress_.begin("cutting into patches", complex_.polygons.size());
    cells_.resize(complex_.polygons.size());
    made_.resize(cells_.size(), Made::to_size);
    std::vector<char> crossed(cells_.size(), 0);
    parallelFor(cells_.size(), 16, [&](std::size_t p) {
      if (progress_.cancelled() || cellSource(complex_, p) != p) return;
      const bool plain = isPlain(p, size);
      CellSize here = size;
      here.improve = size.improve || !plain;
      const Made made = !plain ? Made::to_size : here.improve ? Made::plain : Made::plain_as_it_is;
      if (plain && made_[p] == made) {
        if (!cells_[p].groups.empty()) joinCellsOf(p, 0);
        progress_.advance();
        return;
      }
      made_[p] = Made::to_size;
      if (auto cells = cellsOf(complex_, cuts_, p, here)) {
        cells_[p] = std::move(*cells);
        joinCellsOf(p, 0);
        made_[p] = made;
      } else {
        cells_[p] = {};
        crossed[p] = 1;
      }
      progress_.advance();
    });
    progress_.check();
    progress_.end();
    std::vector<Index> out;
    for (Index p = 0; p < crossed.size(); ++p) {
      if (crossed[p]) out.push_back(p);
    }
    return out;
  }

  /// Whether no edge of the polygon is cut and no step of its background grid is shorter than the
  /// polygon: then its cells are the same for any such size.
  bool isPlain(std::size_t p, const CellSize& size) const {
    return std::isinf(size.longest) && diameter_[p] < kPlainDiameter * size.size &&
           cuts_.isUncut(p);
  }

  const CoarseComplex& complex_;
  Progress& progress_;
  EdgeCuts cuts_;
  std::set<Index> whole_;
  std::vector<double> diameter_;  ///< by polygon, an upper bound
  std::vector<PolygonCells> cells_;
  std::vector<Made> made_;  ///< by polygon
  std::size_t count_ = 0;
};

/// Subdivides to about `wanted` cells. Cuts opposite of vertices take cells: they must not raise
/// the count much above that without them, nor make cells elsewhere much coarser.
void meetCount(Subdivision& subdivision, double start, double wanted) {
  const double largest = kLargestSize * start;
  double spacing = kNoOpposites;
  double last = 0;
  const auto count = [&](double size) {
    last = size;
    const CellSize cells{size, std::numeric_limits<double>::infinity()};
    return double(subdivision.run(cells, Rounding::nearest, spacing));
  };
  const auto search = [&](double coarsest) {
    const double size = sizeForCount(std::min(start, coarsest), coarsest, wanted, count);
    if (size != last) count(size);
    return size;
  };
  const double plain = search(largest);
  subdivision.findOpposites(largest);
  if (!subdivision.hasOpposites()) return;
  const double coarsest = std::min(largest, kCoarser * plain);
  const double most = kMuchMore * std::max(wanted, subdivision.count());
  for (const double widths : kSpacings) {
    spacing = widths;
    const double fewest = count(coarsest);
    if (fewest > most) continue;
    if (fewest >= wanted) return;
    search(coarsest);
    if (subdivision.count() <= most) return;
  }
  spacing = kNoOpposites;
  count(plain);
}

/// The same by joining cells, for outlines that alone take more cells.
void meetCountJoined(Subdivision& subdivision, double start, double wanted) {
  const double largest = kLargestSize * start;
  double last = 0;
  const auto count = [&](double size) {
    last = size;
    subdivision.run({size, std::numeric_limits<double>::infinity()}, Rounding::nearest,
                    kNoOpposites);
    return double(subdivision.join(size));
  };
  if (count(largest) >= wanted) return;
  const double size = sizeForCount(start, largest, wanted, count);
  if (size != last) count(size);
}

/// Subdivides to a size, where small polygons are more than the patches asked for: points inside
/// these that improve the angles of their cells would be for nothing, and large polygons must not
/// be cut more coarsely because of small ones.
void cutAmongMany(Subdivision& subdivision, double size) {
  subdivision.run({size, std::numeric_limits<double>::infinity(), false}, Rounding::nearest,
                  kNoOpposites);
  subdivision.join(size);
}

/// Enters the area that patches lack compared with their polygons: cells without area in details as
/// small as rounding, and polygons that could not be cut at all.
void accountForCells(const CoarseComplex& complex, const PatchMesh& mesh, MeshReport& report) {
  std::vector<double> missing(complex.polygons.size());
  for (std::size_t p = 0; p < missing.size(); ++p)
    missing[p] = areaOf(complex, complex.polygons[p]);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.side[i] == 0) missing[mesh.polygon[i]] -= mesh.area[i];
  }
  std::vector<double> moved(report.surfaces.size(), 0.0);
  for (std::size_t p = 0; p < missing.size(); ++p) moved[complex.polygons[p].surface] += missing[p];
  for (std::size_t s = 0; s < moved.size(); ++s) addMovedArea(report.surfaces[s], moved[s]);
}

void noteWhole(const std::set<Index>& polygons, const CoarseComplex& complex, MeshReport& report) {
  std::map<Index, std::size_t> by_surface;
  for (const Index p : polygons) ++by_surface[complex.polygons[p].surface];
  for (const auto& [surface, count] : by_surface) {
    report.notes.push_back(
        {Severity::info, fmt::format("{}: the edges of {} polygons are not cut, for they lie too "
                                     "near to each other",
                                     report.surfaces[surface].name, count)});
  }
}

void noteMore(std::size_t wanted, std::size_t polygons, const PatchMesh& mesh, MeshReport& report) {
  if (double(polygons) <= kFarMore * double(wanted)) return;
  report.notes.push_back(
      {Severity::info, fmt::format("{} patches: {} were asked for, but there are {} planar pieces",
                                   mesh.size(), wanted, polygons)});
}

void refuseTooMany(double area, double size) {
  const double count = area / (size * size);
  if (!(count <= kMostPatches)) {
    throw InputError(
        fmt::format("patches of {:g} m on {:g} m^2 would be about {:.3g}; {:g} are the most: ask "
                    "for fewer patches or a longer edge",
                    size, area, count, kMostPatches));
  }
}

}  // namespace

PatchMesh subdivide(const CoarseComplex& complex, const Scene& scene, const MeshOptions& options,
                    MeshReport& report, Progress& progress) {
  options.validate();
  const double area = areaOf(complex);
  if (complex.polygons.empty() || !(area > 0)) {
    throw InputError(fmt::format("{}: no face has an area", scene.file));
  }
  Subdivision subdivision(complex, progress);
  if (options.max_edge > 0) {
    refuseTooMany(area, options.max_edge);
    subdivision.findOpposites(options.max_edge);
    subdivision.run({options.max_edge, options.max_edge}, Rounding::at_most, kSpacings[0]);
  } else {
    const double wanted = double(options.patches);
    // A wide polygon has area / size^2 cells, a thin one has half its outline / size. A quarter of
    // the outline suits a single square, too.
    const double start = std::max(std::sqrt(area / wanted), outlineOf(complex) / (4 * wanted));
    const double most = kFarMore * wanted;
    if (double(complex.polygons.size()) <= most) {
      meetCount(subdivision, start, wanted);
      if (subdivision.count() > kMuchMore * wanted) meetCountJoined(subdivision, start, wanted);
    }
    if (!(subdivision.count() > 0 && subdivision.count() <= most)) {
      cutAmongMany(subdivision, kSizeAmongMany * std::sqrt(area / wanted));
    }
  }
  PatchMesh mesh =
      assemblePatches(complex, scene, subdivision.cuts(), subdivision.cells(), progress);
  double least = complex.coincidence;
  for (const CoarsePolygon& polygon : complex.polygons) {
    least = std::min(least, complex.coincidenceOf(polygon));
  }
  keepCoincidence(mesh, least);
  fillFigures(mesh, report);
  noteTJunctions(mesh, complex.coincidence, report);
  accountForCells(complex, mesh, report);
  noteWhole(subdivision.whole(), complex, report);
  if (options.max_edge == 0) noteMore(options.patches, complex.polygons.size(), mesh, report);
  return mesh;
}

}  // namespace radiosity
