#include "render/isolines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "render/bitmap_text.h"

namespace radiosity {
namespace {

constexpr double kMostLines = 10;
constexpr double kRounding = 1e-9;  // of a step

struct Segment {
  Vec2 from;
  Vec2 to;
};

/// Half-open, in pixels of the values.
struct Box {
  int left, top, right, bottom;
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

class Isolines {
 public:
  Isolines(Image& image, int left, int top, const PixelValues& pixels, const ColourRange& range,
           const ColourMap& map, int scale)
      : image_(image),
        left_(left),
        top_(top),
        pixels_(pixels),
        range_(range),
        map_(map),
        scale_(scale),
        cover_(pixels.values.size(), 0.0F) {}

  void draw(double level, double step, bool labelled) {
    const std::vector<Segment> line = lineAt(level);
    for (const Segment& segment : line) stroke(segment);
    if (labelled) addLabels(level, step, line);
    blend(inkAt(level));
  }
  void drawLabels() const {
    for (const Label& label : labels_) {
      drawText(image_, left_ + label.box.left + scale_, top_ + label.box.top + scale_, scale_,
               label.text, label.ink);
    }
  }

 private:
  struct Label {
    Box box;
    std::string text;
    float ink;
  };

  bool joined(std::size_t a, std::size_t b) const {
    return !pixels_.joined || pixels_.joined(a, b);
  }
  double value(int x, int y) const { return pixels_.values[pixels_.index(x, y)]; }
  float inkAt(double level) const { return inkOver(map_.at(range_.position(level))); }

  std::vector<Segment> lineAt(double level) const;
  void stroke(const Segment& segment);
  void blend(float ink);
  void addLabels(double level, double step, const std::vector<Segment>& line);
  bool fits(const Box& box, double level, double step) const;

  Image& image_;
  int left_;
  int top_;
  const PixelValues& pixels_;
  const ColourRange& range_;
  const ColourMap& map_;
  int scale_;
  std::vector<float> cover_;          ///< of the line that is being drawn, by pixels
  std::vector<std::size_t> touched_;  ///< pixels with cover
  std::vector<Label> labels_;
};

/// Marching squares (Lorensen & Cline 1987, in the plane) between the middles of four pixels. Where
/// opposite corners are on one side, the mean of all tells which of them are connected.
std::vector<Segment> Isolines::lineAt(double level) const {
  constexpr std::array<std::array<int, 2>, 4> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  std::vector<Segment> line;
  for (int y = 0; y + 1 < pixels_.height; ++y) {
    for (int x = 0; x + 1 < pixels_.width; ++x) {
      std::array<double, 4> v{};
      int above = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        v[k] = value(x + kCorner[k][0], y + kCorner[k][1]) - level;
        above += v[k] >= 0 ? 1 : 0;
      }
      if (above == 0 || above == 4 ||
          std::ranges::any_of(v, [](double d) { return std::isnan(d); }))
        continue;
      std::array<Vec2, 4> crossing{};
      std::size_t crossings = 0;
      bool whole = true;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::array<int, 2>& a = kCorner[k];
        const std::array<int, 2>& b = kCorner[(k + 1) % 4];
        whole =
            whole && joined(pixels_.index(x + a[0], y + a[1]), pixels_.index(x + b[0], y + b[1]));
        const double next = v[(k + 1) % 4];
        if ((v[k] >= 0) == (next >= 0)) continue;
        const double t = v[k] / (v[k] - next);
        crossing[crossings++] =
            Vec2(x + a[0] + t * (b[0] - a[0]) + 0.5, y + a[1] + t * (b[1] - a[1]) + 0.5);
      }
      if (!whole) continue;
      if (crossings == 2) {
        line.push_back({crossing[0], crossing[1]});
        continue;
      }
      const bool middle = v[0] + v[1] + v[2] + v[3] >= 0;
      const std::size_t shift = middle == (v[0] >= 0) ? 0 : 1;
      line.push_back({crossing[shift], crossing[1 + shift]});
      line.push_back({crossing[2 + shift], crossing[(3 + shift) % 4]});
    }
  }
  return line;
}

/// A pixel is covered by how far it reaches into the line's width.
void Isolines::stroke(const Segment& segment) {
  const double half = 0.5 * scale_;
  const Vec2 along = segment.to - segment.from;
  const double length_square = glm::dot(along, along);
  const auto first = [&](double a, double b) {
    return std::max(0, int(std::floor(std::min(a, b) - half - 1)));
  };
  const auto last = [&](double a, double b, int size) {
    return std::min(size - 1, int(std::ceil(std::max(a, b) + half + 1)));
  };
  for (int y = first(segment.from.y, segment.to.y);
       y <= last(segment.from.y, segment.to.y, pixels_.height); ++y) {
    for (int x = first(segment.from.x, segment.to.x);
         x <= last(segment.from.x, segment.to.x, pixels_.width); ++x) {
      const Vec2 off = Vec2(x + 0.5, y + 0.5) - segment.from;
      const double t =
          length_square > 0 ? std::clamp(glm::dot(off, along) / length_square, 0.0, 1.0) : 0;
      const double distance = glm::length(off - t * along);
      const auto covered = float(std::clamp(half + 0.5 - distance, 0.0, 1.0));
      float& cover = cover_[pixels_.index(x, y)];
      if (covered <= cover) continue;
      if (cover == 0) touched_.push_back(pixels_.index(x, y));
      cover = covered;
    }
  }
}

void Isolines::blend(float ink) {
  for (const std::size_t k : touched_) {
    const std::size_t x = std::size_t(left_) + k % std::size_t(pixels_.width);
    const std::size_t y = std::size_t(top_) + k / std::size_t(pixels_.width);
    float* p = image_.rgba.data() + (y * std::size_t(image_.width) + x) * 4;
    for (int b = 0; b < 3; ++b) p[b] += cover_[k] * (ink - p[b]);
    cover_[k] = 0;
  }
  touched_.clear();
}

/// Inside, over values that no other line crosses, on one surface, apart from other labels.
bool Isolines::fits(const Box& box, double level, double step) const {
  if (box.left < 0 || box.top < 0 || box.right > pixels_.width || box.bottom > pixels_.height) {
    return false;
  }
  if (std::ranges::any_of(labels_, [&](const Label& label) { return label.box.meets(box); })) {
    return false;
  }
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const std::size_t here = pixels_.index(x, y);
      if (!(std::abs(pixels_.values[here] - level) < step)) return false;  // NaN, too
      if (x + 1 < box.right && !joined(here, here + 1)) return false;
      if (y + 1 < box.bottom && !joined(here, pixels_.index(x, y + 1))) return false;
    }
  }
  return true;
}

/// Numbers that break the line, a third of the picture apart.
void Isolines::addLabels(double level, double step, const std::vector<Segment>& line) {
  const std::string text = fmt::format("{:.7g}", level);
  const int width = textWidth(text, scale_) + 2 * scale_;
  const int height = (kCapHeight + 2) * scale_;
  const double apart = std::max(pixels_.width, pixels_.height) / 3.0;
  std::vector<Vec2> placed;
  for (const Segment& segment : line) {
    const Vec2 at = 0.5 * (segment.from + segment.to);
    const auto near = [&](const Vec2& other) { return glm::length(other - at) < apart; };
    if (std::ranges::any_of(placed, near)) continue;
    const int left = int(std::lround(at.x)) - width / 2;
    const int top = int(std::lround(at.y)) - height / 2;
    const Box box{left, top, left + width, top + height};
    if (!fits(box, level, step)) continue;
    labels_.push_back({box, text, inkAt(level)});
    placed.push_back(at);
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) cover_[pixels_.index(x, y)] = 0;
    }
  }
}

/// The smallest of 1, 2, 5 x 10^n that is `least` or more.
double roundStep(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least * (1 - kRounding)) return factor * decade;
  }
  return 10 * decade;
}

}  // namespace

double isolineStep(const ColourRange& range) {
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  // Values that differ by what rounds off have no lines.
  if (!(range.high - range.low > kRounding * size)) return 0;
  return roundStep((range.high - range.low) / kMostLines);
}

ColourRange roundedOut(const ColourRange& range, double step) {
  ColourRange out = range;
  out.low = step * std::floor(range.low / step + kRounding);
  out.high = step * std::ceil(range.high / step - kRounding);
  return out;
}

void drawIsolines(Image& image, int left, int top, const PixelValues& pixels,
                  const ColourRange& range, double step, const ColourMap& map, int scale,
                  bool labels) {
  if (!(step > 0)) return;
  Isolines lines(image, left, top, pixels, range, map, scale);
  const double first = std::ceil(range.low / step - kRounding);
  const double last = std::floor(range.high / step + kRounding);
  for (double k = first; k <= last; ++k) lines.draw(k * step, step, labels);
  if (labels) lines.drawLabels();
}

}  // namespace radiosity
