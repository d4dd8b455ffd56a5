#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/parallel.h"
#include "mesh/complex.h"
#include "mesh/mesh_figures.h"
#include "mesh/patch_arrays.h"
#include "mesh/plane_frame.h"
#include "mesh/polygon_cells.h"
#include "mesh/size_search.h"

namespace radiosity {

namespace {

// Where thousands of small polygons use up the patches asked for, walls are still cut: cells are at
// most this much larger than if all area were shared out evenly.
constexpr double kLargestSize = 3.0;
constexpr double kMuchMore = 1.15;

double areaOf(const CoarseComplex& complex) {
  double area = 0;
  for (const CoarsePolygon& polygon : complex.polygons) {
    Vec3 sum(0.0);
    for (const auto& loop : polygon.loops) {
      sum += vectorArea(loop.size(), [&](std::size_t k) { return complex.vertices[loop[k]]; });
    }
    area += glm::dot(sum, polygon.normal);
  }
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

class Subdivision {
 public:
  Subdivision(const CoarseComplex& complex, const Scene& scene, Progress& progress)
      : complex_(complex), scene_(scene), progress_(progress), cuts_(complex) {}

  /// Cells of every polygon; returns how many there are.
  std::size_t run(const CellSize& size, Rounding rounding) {
    progress_.check();
    progress_.begin("cutting into patches", complex_.polygons.size());
    cuts_.cut(std::isfinite(size.longest) ? size.longest : size.size, rounding);
    cells_.assign(complex_.polygons.size(), {});
    parallelFor(cells_.size(), 16, [&](std::size_t p) {
      if (cellSource(complex_, p) != p) return;
      try {
        cells_[p] = cellsOf(complex_, cuts_, p, size);
      } catch (const RunError& error) {
        throw RunError(fmt::format("surface {}: polygon {}: {}",
                                   scene_.surfaces[complex_.polygons[p].surface].name, p,
                                   error.what()));
      }
      progress_.advance();
    });
    progress_.end();
    count_ = 0;
    for (std::size_t p = 0; p < cells_.size(); ++p) {
      count_ += cells_[cellSource(complex_, p)].cells.size();
    }
    return count_;
  }

  double count() const { return double(count_); }
  const EdgeCuts& cuts() const { return cuts_; }
  const std::vector<PolygonCells>& cells() const { return cells_; }

 private:
  const CoarseComplex& complex_;
  const Scene& scene_;
  Progress& progress_;
  EdgeCuts cuts_;
  std::vector<PolygonCells> cells_;
  std::size_t count_ = 0;
};

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
  Subdivision subdivision(complex, scene, progress);
  if (options.max_edge > 0) {
    refuseTooMany(area, options.max_edge);
    subdivision.run({options.max_edge, options.max_edge}, Rounding::at_most);
  } else {
    const double none = std::numeric_limits<double>::infinity();
    double last = 0;
    const auto count = [&](double size) {
      last = size;
      return double(subdivision.run({size, none}, Rounding::nearest));
    };
    const double wanted = double(options.patches);
    // A wide polygon has area / size^2 cells, a thin one half its outline / size: as many as a
    // square at a quarter.
    const double start = std::max(std::sqrt(area / wanted), outlineOf(complex) / (4 * wanted));
    const double size = sizeForCount(start, kLargestSize * start, wanted, count);
    if (size != last) count(size);
    if (subdivision.count() > kMuchMore * wanted) {
      report.notes.push_back(
          {Severity::info,
           fmt::format("{} patches instead of {}: there are {} polygons, some with narrow details; "
                       "large ones are not cut coarser than {:.3g} m for it",
                       subdivision.count(), options.patches, complex.polygons.size(), size)});
    }
  }
  PatchMesh mesh =
      assemblePatches(complex, scene, subdivision.cuts(), subdivision.cells(), progress);
  fillFigures(mesh, complex.coincidence, report);
  return mesh;
}

}  // namespace radiosity
