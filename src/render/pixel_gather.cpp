// Light gathered at the samples of every pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/option_list.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "render/draw.h"

namespace radiosity {
namespace {

constexpr int kFewestRays = 64;
/// A forecast draws only each pixel of this number, across and down.
constexpr int kForecastStep = 16;

/// One picture, or the pixels of its forecast.
class Gathering {
 public:
  Gathering(const PatchMesh& mesh, const SurfaceLight& light, const Camera& camera,
            const RenderOptions& options, const PixelGatherOptions& gather)
      : mesh_(mesh), light_(light), camera_(camera), options_(options) {
    options.validate();
    gather.validate();
    if (!light.points) throw InputError("render: there is no light at points to gather");
    if (!light.sky.empty()) options_.background = light.sky;
    report_.rays_a_pixel = raysOf(gather);
  }

  Image draw(int every, Progress& progress, PictureParts* parts = nullptr) {
    const Stopwatch watch;
    const std::vector<double> radiance = radianceOf(light_.patches);
    PatchField field = makeField(mesh_, radiance, 3, options_);
    const View view = makeView(camera_, options_.width, options_.height);
    const ItemBuffer items(mesh_, view, options_.samples, options_.show_backs);
    std::vector<PointSums> tiles(std::size_t(items.tileCount()));
    ShadedRoots shaded{light_.points->roots(), light_.points->bands(), light_.reflectance,
                       light_.emission, std::numbers::inv_pi};
    shaded.points = light_.points.get();
    shaded.materials = light_.materials.get();
    shaded.rays = report_.rays_a_pixel;
    shaded.every = every;
    shaded.tiles = tiles;
    field.roots = &shaded;
    Image image = drawField(mesh_, field, items, options_,
                            every > 1 ? "time of the picture" : "picture", progress, parts);
    sumUp(tiles);
    if (every == 1) report_.seconds = watch.seconds();
    return image;
  }

  const PixelGatherReport& report() const { return report_; }

 private:
  int raysOf(const PixelGatherOptions& gather) const {
    const double pixels = double(options_.width) * double(options_.height);
    return int(std::clamp(gather.most_rays / pixels, double(kFewestRays), double(gather.rays)));
  }

  /// Adds in the order of tiles, so that no sum depends on threads.
  void sumUp(const std::vector<PointSums>& tiles) {
    double noise = 0;
    double light = 0;
    for (const PointSums& tile : tiles) {
      report_.points += tile.points;
      report_.rays += tile.rays;
      report_.seconds += tile.seconds;
      noise += tile.noise_square;
      light += tile.light_square;
    }
    report_.ray_error = light > 0 ? std::sqrt(noise / light) : 0;
  }

  const PatchMesh& mesh_;
  const SurfaceLight& light_;
  const Camera& camera_;
  RenderOptions options_;
  PixelGatherReport report_;
};

}  // namespace

void PixelGatherOptions::validate() const { requireRanges(*this); }

PixelGather gatherRadiance(const PatchMesh& mesh, const SurfaceLight& light, const Camera& camera,
                           const RenderOptions& options, const PixelGatherOptions& gather,
                           Progress& progress, PictureParts* parts) {
  Gathering gathering(mesh, light, camera, options, gather);
  PixelGather out;
  out.radiance = gathering.draw(1, progress, parts);
  out.report = gathering.report();
  return out;
}

PixelGatherReport foreseeGather(const PatchMesh& mesh, const SurfaceLight& light,
                                const Camera& camera, const RenderOptions& options,
                                const PixelGatherOptions& gather, Progress& progress) {
  Gathering gathering(mesh, light, camera, options, gather);
  gathering.draw(kForecastStep, progress);
  PixelGatherReport report = gathering.report();
  const double all = double(options.width) * double(options.height);
  const auto looked = [](int pixels) { return (pixels + kForecastStep - 1) / kForecastStep; };
  const double share = all / (double(looked(options.width)) * double(looked(options.height)));
  report.points = std::size_t(std::lround(double(report.points) * share));
  report.rays *= share;
  report.seconds *= share / double(allowedThreads());
  return report;
}

}  // namespace radiosity
