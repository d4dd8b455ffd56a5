// Draws a scalar field in false colour, with a legend below.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "base/srgb.h"
#include "render/colour_map.h"
#include "render/isolines.h"
#include "render/legend.h"
#include "render/percentile.h"
#include "render/samples.h"
#include "render/seen_points.h"

namespace radiosity {
namespace {

// Linear light of pixels without a value: greys, since the colour map has none.
constexpr double kMiss = 0.25;
constexpr double kBack = 0.06;

/// The values in view: their range over all samples, and one value a pixel.
struct InView {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  std::vector<double> values;
};

class InViewPixel {
 public:
  explicit InViewPixel(InView& view) : view_(view) {}
  void begin() { first_ = true; }
  void sample(Seen seen, const Shade& shade) {
    if (seen != Seen::front || std::isnan(shade.value[0])) return;
    view_.low = std::min(view_.low, shade.value[0]);
    view_.high = std::max(view_.high, shade.value[0]);
    if (first_) view_.values.push_back(shade.value[0]);
    first_ = false;
  }
  void end(int /*x*/, int /*y*/) {}

 private:
  InView& view_;
  bool first_ = true;
};

/// Averages colours as light, not as numbers: where two surfaces meet in a pixel, the mean of their
/// values would be a value that no surface has.
class ColourPixel {
 public:
  ColourPixel(Image& image, const ColourMap& map, const ColourRange& range)
      : image_(image), map_(map), range_(range) {}

  void begin() {
    count_ = 0;
    sum_ = Vec3(0.0);
  }
  void sample(Seen seen, const Shade& shade) {
    ++count_;
    const double value = shade.value[0];
    sum_ += seen == Seen::back                          ? Vec3(kBack)
            : seen == Seen::front && !std::isnan(value) ? map_.at(range_.position(value))
                                                        : Vec3(kMiss);
  }
  void end(int x, int y) {
    float* out = image_.rgba.data() + (std::size_t(y) * image_.width + x) * 4;
    for (int b = 0; b < 3; ++b) out[b] = float(srgbFromLinear(sum_[b] / count_));
    out[3] = 1;
  }

 private:
  Image& image_;
  const ColourMap& map_;
  const ColourRange& range_;
  int count_ = 0;
  Vec3 sum_{0.0};
};

/// The range of the colours: the one asked for, or that of the values in view. If the highest value
/// is more than twice the 99th percentile of the pixels, the range ends at the percentile.
/// Otherwise a lamp, or the patch next to the one whose form factors are shown, would leave all
/// else dark.
std::optional<ColourRange> rangeInView(const FalseColour& asked, const std::vector<InView>& tiles) {
  InView seen;
  for (const InView& tile : tiles) {
    seen.low = std::min(seen.low, tile.low);
    seen.high = std::max(seen.high, tile.high);
    seen.values.insert(seen.values.end(), tile.values.begin(), tile.values.end());
  }
  if (asked.low < asked.high) {
    return ColourRange{asked.low, asked.high, seen.low<asked.low, seen.high> asked.high};
  }
  if (seen.values.empty()) return std::nullopt;
  const double usual = percentile(seen.values, 0.99);
  if (seen.high > 2 * usual && usual > seen.low) return ColourRange{seen.low, usual, false, true};
  return ColourRange{seen.low, seen.high};
}

}  // namespace

Image renderFalseColour(const PatchMesh& mesh, std::span<const double> values,
                        const FalseColour& legend, const Camera& camera,
                        const RenderOptions& options, Progress& progress) {
  options.validate();
  const Legend strip(legend, options.width, options.height);
  const View view = makeView(camera, options.width, options.height - strip.height());
  const PatchField field = makeField(mesh, values, 1, options);
  const ItemBuffer items(mesh, view, options.samples, options.show_backs);

  std::vector<InView> tiles(items.tileCount());
  progress.begin("range", items.tileCount());
  forSamples(
      mesh, items, field, [&](std::size_t tile) { return InViewPixel(tiles[tile]); }, progress);
  progress.end();
  const std::optional<ColourRange> range = rangeInView(legend, tiles);

  const ColourMap map;
  Image image{options.width, options.height, {}};
  image.rgba.assign(std::size_t(image.width) * image.height * 4, 0.0f);
  const ColourRange shown = range.value_or(ColourRange{});
  progress.begin("picture", items.tileCount());
  forSamples(
      mesh, items, field, [&](std::size_t) { return ColourPixel(image, map, shown); }, progress);
  progress.end();
  strip.draw(image, map, range);
  return image;
}

namespace {

std::optional<ColourRange> rangeOfPixels(const FalseColour& asked, std::span<const double> values) {
  std::vector<InView> seen(1);
  InViewPixel pixel(seen[0]);
  for (const double value : values) {
    if (std::isnan(value)) continue;
    pixel.begin();
    pixel.sample(Seen::front, {.value = {value, 0, 0}});
  }
  return rangeInView(asked, seen);
}

/// `line_step`: 0: without lines.
Image drawPixels(const PixelValues& pixels, const FalseColour& text,
                 const std::optional<ColourRange>& range, double line_step) {
  const auto [width, height, values, joined] = pixels;
  // The strip is added below the picture and may be as high: Legend takes half of the height at
  // most.
  const Legend strip(text, width, 2 * height, line_step);
  Image image{width, height + strip.height(), {}};
  image.rgba.assign(std::size_t(image.width) * std::size_t(image.height) * 4, 1.0F);
  const ColourMap map;
  const ColourRange shown = range.value_or(ColourRange{});
  ColourPixel pixel(image, map, shown);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double value = values[pixels.index(x, y)];
      pixel.begin();
      pixel.sample(std::isnan(value) ? Seen::nothing : Seen::front, {.value = {value, 0, 0}});
      pixel.end(x, y);
    }
  }
  drawIsolines(image, 0, 0, pixels, shown, line_step, map, strip.scale(), true);
  strip.draw(image, map, range);
  return image;
}

}  // namespace

Image falseColourPixels(int width, int height, std::span<const double> values,
                        const FalseColour& legend) {
  if (width < 1 || height < 1 || values.size() != std::size_t(width) * std::size_t(height)) {
    throw InputError("falseColourPixels: as many values as pixels are needed");
  }
  return drawPixels({width, height, values, {}}, legend, rangeOfPixels(legend, values), 0);
}

namespace {

/// Pixels of one smooth piece of a surface. Those that an edge may pass through are of none: what
/// they show is a mean of both sides.
class SmoothPixels {
 public:
  SmoothPixels(const PatchMesh& mesh, const Camera& camera, const RenderOptions& options)
      : mesh_(mesh),
        bend_(std::cos(options.crease * std::numbers::pi / 180)),
        seen_(middlesOfPixels(mesh, camera, options)),
        inner_(seen_.size(), 1) {
    const auto width = std::size_t(options.width);
    const auto compare = [&](std::size_t a, std::size_t b) {
      if (!areSmooth(a, b)) inner_[a] = inner_[b] = 0;
    };
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      if ((k + 1) % width != 0) compare(k, k + 1);
      if (k + width < seen_.size()) compare(k, k + width);
    }
  }
  std::size_t size() const { return seen_.size(); }
  bool joined(std::size_t a, std::size_t b) const {
    return inner_[a] != 0 && inner_[b] != 0 && areSmooth(a, b);
  }

 private:
  bool areSmooth(std::size_t a, std::size_t b) const {
    const Index i = seen_[a].patch;
    const Index j = seen_[b].patch;
    return i == j || (i != kNone && j != kNone && mesh_.surface[i] == mesh_.surface[j] &&
                      glm::dot(mesh_.normal[i], mesh_.normal[j]) >= bend_);
  }

  const PatchMesh& mesh_;
  double bend_;
  std::vector<SeenPoint> seen_;
  std::vector<std::uint8_t> inner_;
};

}  // namespace

Image falseColourPicture(const PatchMesh& mesh, std::span<const double> values,
                         const FalseColour& legend, const Camera& camera,
                         const RenderOptions& options) {
  const SmoothPixels smooth(mesh, camera, options);
  if (values.size() != smooth.size()) {
    throw InputError("falseColourPicture: as many values as pixels are needed");
  }
  const auto joined = [&](std::size_t a, std::size_t b) { return smooth.joined(a, b); };
  std::optional<ColourRange> range = rangeOfPixels(legend, values);
  const double step = range ? isolineStep(*range) : 0;
  if (range && step > 0 && !(legend.low < legend.high)) range = roundedOut(*range, step);
  return drawPixels({options.width, options.height, values, joined}, legend, range, step);
}

}  // namespace radiosity
