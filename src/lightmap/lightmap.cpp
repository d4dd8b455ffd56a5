#include "radiosity/lightmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "base/geometry/box.h"
#include "base/option_list.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "lightmap/chart_texels.h"
#include "lightmap/surface_light.h"

namespace radiosity {

std::size_t LightmapOptions::bytes() const {
  // Four floats a texel: the map, the copy that is encoded, and the file at its largest.
  return std::size_t(size) * std::size_t(size) * 3 * 4 * sizeof(float);
}

void LightmapOptions::validate() const { requireRanges(*this); }

namespace {

/// The triangles of one side, with their charts.
struct Side {
  int side = 0;
  std::vector<FaceTriangle> triangles;
  std::vector<Chart> charts;
};

/// Share of the scene's diagonal: closer corners are one. It is the default of MeshOptions.
constexpr double kWeld = 1e-7;

/// The largest distance of a corner from the centre: a patch on the face's back is within it.
double reachOf(const FaceTriangle& t, const Vec3& centre) {
  double reach = 0;
  for (const Vec3& p : t.position) reach = std::max(reach, glm::distance(p, centre));
  return reach;
}

/// The backs that have patches. Backs of one-sided surfaces and backs that see nothing have none.
std::vector<FaceTriangle> backTriangles(const std::vector<FaceTriangle>& fronts,
                                        const LightOnSurfaces& light) {
  std::vector<FaceTriangle> backs = turnedOver(fronts);
  std::vector<std::uint8_t> seen(backs.size());
  parallelFor(backs.size(), 256, [&](std::size_t k) {
    const FaceTriangle& t = backs[k];
    const Vec3 centre = (t.position[0] + t.position[1] + t.position[2]) / 3.0;
    seen[k] = light.isNear(t.surface, 1, centre, t.normal, reachOf(t, centre)) ? 1 : 0;
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < backs.size(); ++k) {
    if (seen[k] != 0) backs[kept++] = backs[k];
  }
  backs.resize(kept);
  return backs;
}

class LightmapMaker {
 public:
  LightmapMaker(const Scene& scene, const PatchMesh& mesh, const SurfaceLight& light,
                const LightmapOptions& options, Progress& progress)
      : scene_(scene), light_(mesh, light, options.shows), options_(options), progress_(progress) {
    map_.shows = options.shows;
  }

  Lightmap run() {
    std::vector<FaceTriangle> fronts = frontTriangles(scene_);
    std::vector<FaceTriangle> backs = backTriangles(fronts, light_);
    addSide(0, std::move(fronts));
    addSide(1, std::move(backs));
    pack();
    for (const Side& side : sides_) addTriangles(side);
    draw();
    return std::move(map_);
  }

 private:
  void addSide(int number, std::vector<FaceTriangle> triangles);
  void pack();
  void addTriangles(const Side& side);
  void draw();
  void evaluate(const Side& side, std::vector<ChartTexel>& texels);

  const Scene& scene_;
  LightOnSurfaces light_;
  const LightmapOptions& options_;
  Progress& progress_;
  std::vector<Side> sides_;
  ChartPacking packing_;  ///< of the charts of all sides, in order
  Lightmap map_;
};

void LightmapMaker::addSide(int number, std::vector<FaceTriangle> triangles) {
  findNeighbours(triangles, kWeld * boxOf(scene_.vertices).diagonal());
  std::vector<Chart> charts = makeCharts(triangles, options_.crease, progress_);
  map_.report.charts += charts.size();
  map_.report.triangles += triangles.size();
  for (const Chart& chart : charts) {
    map_.report.least_density = std::min(map_.report.least_density, chart.least_cosine);
  }
  sides_.push_back({number, std::move(triangles), std::move(charts)});
}

void LightmapMaker::pack() {
  std::vector<Chart> all;
  for (const Side& side : sides_) all.insert(all.end(), side.charts.begin(), side.charts.end());
  if (all.empty()) throw InputError("a lightmap needs a face with area; the scene has none");
  std::optional<ChartPacking> packing = packCharts(all, options_.size);
  if (!packing) {
    const int least = leastMapSize(all.size());
    throw InputError(fmt::format(
        "a lightmap of {0} x {0} texels has no room for {1} charts; {2}", options_.size, all.size(),
        least <= LightmapOptions::kLargest
            ? fmt::format("{} would do", least)
            : fmt::format("nor has the largest, {}: split the scene", LightmapOptions::kLargest)));
  }
  packing_ = std::move(*packing);
  map_.report.texels_per_metre = packing_.texels_per_metre;
}

void LightmapMaker::addTriangles(const Side& side) {
  const std::size_t before = side.side == 0 ? 0 : sides_[0].charts.size();
  std::vector<Index> chart_of(side.triangles.size());
  for (std::size_t c = 0; c < side.charts.size(); ++c) {
    for (const Index t : side.charts[c].triangles) chart_of[t] = Index(c);
  }
  for (std::size_t t = 0; t < side.triangles.size(); ++t) {
    const FaceTriangle& from = side.triangles[t];
    const Index chart = chart_of[t];
    LightmapTriangle to;
    to.face = from.face;
    to.side = std::uint8_t(side.side);
    to.corner = from.corner;
    to.chart = Index(before) + chart;
    for (std::size_t k = 0; k < 3; ++k) {
      to.texcoord[k] = texelPlace(side.charts[chart], packing_.places[to.chart],
                                  packing_.texels_per_metre, from.position[k]) /
                       double(options_.size);
    }
    map_.triangles.push_back(to);
  }
}

/// Evaluates charts in batches: large enough for all threads, small enough to be stopped soon.
void LightmapMaker::draw() {
  constexpr std::size_t kBatch = 65536;
  const auto size = std::size_t(options_.size);
  map_.image = {options_.size, options_.size, std::vector<float>(4 * size * size)};
  progress_.begin("lightmap", map_.report.charts, "charts");
  std::size_t number = 0;
  for (const Side& side : sides_) {
    std::vector<ChartTexel> texels;
    for (const Chart& chart : side.charts) {
      progress_.check();
      appendTexels(side.triangles, chart, packing_.places[number++], packing_.texels_per_metre,
                   texels);
      if (texels.size() >= kBatch) evaluate(side, texels);
      progress_.advance();
    }
    evaluate(side, texels);
  }
  progress_.end();
  LightmapReport& report = map_.report;
  report.unused = size * size - report.inside - report.padding;
}

void LightmapMaker::evaluate(const Side& side, std::vector<ChartTexel>& texels) {
  constexpr std::size_t kGrain = 256;
  std::vector<std::uint8_t> lit(texels.size());
  parallelFor(texels.size(), kGrain, [&](std::size_t k) {
    if (progress_.cancelled()) return;
    const ChartTexel& texel = texels[k];
    const FaceTriangle& t = side.triangles[texel.triangle];
    Vec3 value;
    lit[k] = light_.at(t.surface, side.side, texel.position, t.normal, value) ? 1 : 0;
    float* out = map_.image.rgba.data() +
                 4 * (std::size_t(texel.y) * std::size_t(options_.size) + std::size_t(texel.x));
    for (int b = 0; b < 3; ++b) out[b] = float(value[b]);
    out[3] = 1;
  });
  progress_.check();
  for (std::size_t k = 0; k < texels.size(); ++k) {
    ++(texels[k].inside ? map_.report.inside : map_.report.padding);
    if (lit[k] == 0) ++map_.report.dark;
  }
  texels.clear();
}

}  // namespace

Lightmap makeLightmap(const Scene& scene, const PatchMesh& mesh, const SurfaceLight& light,
                      const LightmapOptions& options, Progress& progress) {
  options.validate();
  if (!light.elements || light.elements->empty()) {
    throw InputError("a lightmap shows light at elements, and there are none; evaluate them");
  }
  const int bands = light.elements->bands;
  if (bands != 1 && bands != 3) {
    throw InputError(fmt::format("a lightmap has three bands, or one in grey, not {}", bands));
  }
  const Stopwatch watch;
  Lightmap map = LightmapMaker(scene, mesh, light, options, progress).run();
  map.report.seconds = watch.seconds();
  return map;
}

}  // namespace radiosity
