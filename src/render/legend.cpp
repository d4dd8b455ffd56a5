#include "render/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/srgb.h"
#include "render/bitmap_text.h"

namespace radiosity {
namespace {

// Display values of the strip: light on dark, which is legible on any page.
constexpr float kPanel = 0.10f;
constexpr float kInk = 0.93f;

// In font pixels.
constexpr int kBarHeight = 8;
constexpr int kTickHeight = 2;
constexpr int kGap = 3;
constexpr int kNarrowest = 96;  // two end numbers of five characters, side by side

/// Breaks at spaces so that no line is wider than `width`; a longer word gets a line of its own.
std::vector<std::string> wrapped(const std::string& text, int width, int scale) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t end = std::min(text.find(' ', k), text.size());
    std::string longer = line;
    if (!longer.empty()) longer += ' ';
    longer += text.substr(k, end - k);
    if (!line.empty() && textWidth(longer, scale) > width) {
      lines.push_back(line);
      line = text.substr(k, end - k);
    } else {
      line = longer;
    }
    k = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

std::string titleOf(const FalseColour& text, double line_step) {
  std::string title = text.title;
  if (!text.unit.empty()) title += (title.empty() ? "[" : " [") + text.unit + "]";
  return line_step > 0 ? fmt::format("{}, lines every {:g}", title, line_step) : title;
}

/// A number under the bar.
struct Tick {
  int x = 0;     ///< of the mark
  int left = 0;  ///< of the text
  int right = 0;
  std::string text;
};

Tick makeTick(int x, const std::string& text, int scale, int low, int high) {
  const int w = textWidth(text, scale);
  const int left = std::clamp(x - w / 2, low, std::max(low, high - w));
  return {x, left, left + w, text};
}

/// A number with enough digits to tell the ends of the range apart at any offset, as for row sums
/// from 0.99998 to 1.00001.
std::string number(double value, const ColourRange& range) {
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  const double lost = range.high > range.low ? std::log10(size / (range.high - range.low)) : 2;
  const int digits = std::clamp(4 + int(std::floor(lost)), 4, 17);
  const std::string text = fmt::format("{:.{}g}", value, digits);
  constexpr double kPowersFrom = 1e7;
  return std::abs(value) < kPowersFrom && text.find("e+") != text.npos
             ? fmt::format("{:.0f}", std::stod(text))
             : text;
}

/// The multiples of `step` strictly between the ends; those without room beside an end number that
/// is nearer than half a step are marks without a number. Empty if two numbers would touch, if one
/// would be missing in the row, or if none fits.
std::vector<Tick> innerTicks(double step, const ColourRange& range, const Tick& first,
                             const Tick& last, int scale) {
  std::vector<Tick> ticks;
  const int room = kGlyphAdvance * scale;
  int taken = first.right + room;
  bool numbers = false;
  const double start = std::floor(range.low / step);
  for (int k = 0; (start + k) * step < range.high; ++k) {
    const double value = start + k == 0 ? 0 : (start + k) * step;  // no "-0"
    if (!(value > range.low)) continue;
    const int x = first.x + int(std::lround(range.position(value) * (last.x - first.x)));
    Tick tick = makeTick(x, number(value, range), scale, first.left, last.right);
    if (tick.left < first.right + room || tick.right > last.left - room) {
      if (std::min(value - range.low, range.high - value) > step / 2) return {};
      tick.text.clear();
    } else {
      if (tick.left < taken) return {};
      taken = tick.right + room;
      numbers = true;
    }
    ticks.push_back(tick);
  }
  return numbers ? ticks : std::vector<Tick>();
}

/// The finest of the steps 1, 2, 5 x 10^n whose numbers fit.
std::vector<Tick> bestInnerTicks(const ColourRange& range, const Tick& first, const Tick& last,
                                 int scale) {
  const double decade = std::pow(10, std::floor(std::log10(range.high - range.low)) - 1);
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    const double step = factor * decade;
    if (!(step > 0) || range.low + step == range.low || range.high + step == range.high) continue;
    std::vector<Tick> ticks = innerTicks(step, range, first, last, scale);
    if (!ticks.empty()) return ticks;
  }
  return {};
}

}  // namespace

Legend::Legend(const FalseColour& text, int width, int height, double line_step)
    // The font grows with the root of the picture: 1 at 200 pixels, 2 at 512, 4 at 1920.
    : width_(width),
      line_step_(line_step),
      scale_(std::max(1, int(std::lround(std::sqrt(width / 128.0))))),
      margin_(4 * scale_),
      lines_(wrapped(titleOf(text, line_step), width - 2 * margin_, scale_)) {
  const int rows =
      int(lines_.size()) * (kGlyphHeight + kGap) + kBarHeight + kTickHeight + kGap + kGlyphHeight;
  const int needed = rows * scale_ + 2 * margin_;
  if (width >= kNarrowest && needed <= height / 2) height_ = needed;
}

void Legend::draw(Image& image, const ColourMap& map,
                  const std::optional<ColourRange>& range) const {
  if (height_ == 0) return;
  int y = image.height - height_;
  fillGrey(image, 0, y, width_, height_, kPanel);
  y += margin_;
  for (const std::string& line : lines_) {
    drawText(image, margin_, y, scale_, line, kInk);
    y += (kGlyphHeight + kGap) * scale_;
  }
  if (!range) {
    drawText(image, margin_, y, scale_, "nothing in view", kInk);
    return;
  }
  drawBar(image, y, map, *range);
  drawTicks(image, y + kBarHeight * scale_, *range);
}

void Legend::drawBar(Image& image, int top, const ColourMap& map, const ColourRange& range) const {
  const int length = width_ - 2 * margin_;
  for (int x = 0; x < length; ++x) {
    const double t = range.high > range.low ? x / double(length - 1) : 0.5;
    const Vec3 colour = map.at(t);
    for (int y = top; y < top + kBarHeight * scale_; ++y) {
      float* p = image.rgba.data() + (std::size_t(y) * width_ + margin_ + x) * 4;
      for (int b = 0; b < 3; ++b) p[b] = float(srgbFromLinear(colour[b]));
    }
  }
  if (!(line_step_ > 0)) return;
  for (double k = std::ceil(range.low / line_step_); k * line_step_ <= range.high; ++k) {
    drawBarLine(image, top, map, range, k * line_step_);
  }
}

/// The line in the picture at that value, at the place of its colour.
void Legend::drawBarLine(Image& image, int top, const ColourMap& map, const ColourRange& range,
                         double level) const {
  const double t = range.position(level);
  const int x = margin_ + int(std::lround(t * (width_ - 2 * margin_ - 1))) - scale_ / 2;
  if (x <= margin_ || x + scale_ >= width_ - margin_) return;
  fillGrey(image, x, top, scale_, kBarHeight * scale_, inkOver(map.at(t)));
}

void Legend::drawTicks(Image& image, int top, const ColourRange& range) const {
  const int left = margin_;
  const int right = width_ - margin_;
  std::vector<Tick> ticks;
  if (range.high > range.low) {
    const std::string low = (range.below ? "<=" : "") + number(range.low, range);
    const std::string high = (range.above ? ">=" : "") + number(range.high, range);
    const Tick first = makeTick(left, low, scale_, left, right);
    const Tick last = makeTick(right - 1, high, scale_, left, right);
    ticks = bestInnerTicks(range, first, last, scale_);
    ticks.push_back(first);
    ticks.push_back(last);
  } else {
    ticks.push_back(makeTick((left + right) / 2, number(range.low, range), scale_, left, right));
  }
  for (const Tick& tick : ticks) {
    const int x = std::clamp(tick.x - scale_ / 2, left, right - scale_);
    fillGrey(image, x, top, scale_, kTickHeight * scale_, kInk);
    drawText(image, tick.left, top + (kTickHeight + kGap) * scale_, scale_, tick.text, kInk);
  }
}

}  // namespace radiosity
