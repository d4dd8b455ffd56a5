// The plan of a grid: false colours, lines of equal illuminance, and values.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/srgb.h"
#include "radiosity/illuminance.h"
#include "render/bitmap_text.h"
#include "render/colour_map.h"
#include "render/isolines.h"
#include "render/legend.h"

namespace radiosity {
namespace {

// Pixels.
constexpr double kWidest = 1200;
constexpr double kHighest = 1000;
constexpr double kLargestCell = 120;
constexpr int kNarrowestPlan = 720;  // room for the heading
constexpr int kEdge = 16;
constexpr int kTextScale = 2;
constexpr int kLineHeight = (kGlyphHeight + 3) * kTextScale;

constexpr float kPaper = 1;
constexpr float kBody = 0.62F;
constexpr float kBlack = 0;

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

std::string valueText(double lux) {
  if (lux >= 100) return fmt::format("{:.0f}", lux);
  return lux >= 10 ? fmt::format("{:.1f}", lux) : fmt::format("{:.2f}", lux);
}

/// "+x", or the vector if it is along no axis.
std::string wayText(const Vec3& way) {
  constexpr double kAlong = 0.999;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(way[axis]) > kAlong) {
      return fmt::format("{}{}", way[axis] > 0 ? '+' : '-', "xyz"[axis]);
    }
  }
  return fmt::format("{:.2f},{:.2f},{:.2f}", way.x, way.y, way.z);
}

/// A grid's values on pixels of a plan.
class Plan {
 public:
  Plan(const MeasuringPoints& points, const MeasuringPoints::Grid& grid,
       const PointLightValues& light, std::size_t first, double low, double high)
      : grid_(grid), values_(grid_.columns * grid_.rows, kNoValue) {
    bodies_.assign(values_.size(), 0);
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (light.inside[first + k] != 0) {
        bodies_[points.cell[k]] = 1;
        continue;
      }
      const double value = light.lux(first + k, Measured::facing);
      values_[points.cell[k]] = value;
      low_ = std::min(low_, value);
      high_ = std::max(high_, value);
    }
    const double scale = std::min({kWidest / (double(grid_.columns) * grid_.step_u),
                                   kHighest / (double(grid_.rows) * grid_.step_v),
                                   kLargestCell / std::max(grid_.step_u, grid_.step_v)});
    cell_u_ = scale * grid_.step_u;
    cell_v_ = scale * grid_.step_v;
    width_ = std::max(1, int(std::lround(double(grid_.columns) * cell_u_)));
    height_ = std::max(1, int(std::lround(double(grid_.rows) * cell_v_)));
    if (!(high_ >= low_)) return;
    range_ = {low_, high_};
    if (low < high) {
      range_ = {low, high};
      range_.below = low_ < low;
      range_.above = high_ > high;
    }
    line_step_ = isolineStep(range_);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  double lineStep() const { return line_step_; }  ///< lx; 0: no lines
  std::optional<ColourRange> range() const {
    return high_ >= low_ ? std::optional(range_) : std::nullopt;
  }

  /// Draws it with its top left at a place of the picture.
  void draw(Image& image, int left, int top);

 private:
  double valueAt(int x, int y) const;
  bool isBody(int x, int y) const { return bodies_[cellAt(x, y)] != 0; }
  std::size_t cellAt(int x, int y) const {
    const auto column = std::min(std::size_t((x + 0.5) / cell_u_), grid_.columns - 1);
    const auto row = std::min(std::size_t((height_ - y - 0.5) / cell_v_), grid_.rows - 1);
    return row * grid_.columns + column;
  }
  struct Pixels {
    int left, top, right, bottom;
  };
  void drawColours(Image& image, const Pixels& part) const;
  void drawValues(Image& image) const;
  double shownAt(int x, int y) const {
    return shown_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
  }
  std::size_t everyOf(double cell, int needed) const {
    return std::size_t(std::max(1.0, std::ceil(double(needed) / cell)));
  }

  const MeasuringPoints::Grid& grid_;
  std::vector<double> values_;  ///< of cells, lx; NaN: no point, or one in a body
  std::vector<std::uint8_t> bodies_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  double cell_u_ = 1;  ///< pixels
  double cell_v_ = 1;
  int width_ = 1;
  int height_ = 1;
  ColourRange range_;
  double line_step_ = 0;
  std::vector<double> shown_;  ///< of pixels; NaN: none
  int left_ = 0;               ///< in the picture
  int top_ = 0;
  ColourMap map_;
};

/// Linear between points that have values; NaN in cells without one.
double Plan::valueAt(int x, int y) const {
  if (std::isnan(values_[cellAt(x, y)])) return kNoValue;
  const double column = (x + 0.5) / cell_u_ - 0.5;
  const double row = (height_ - y - 0.5) / cell_v_ - 0.5;
  const double left = std::floor(column);
  const double bottom = std::floor(row);
  double sum = 0;
  double weights = 0;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const double c = std::clamp(left + i, 0.0, double(grid_.columns) - 1);
      const double r = std::clamp(bottom + j, 0.0, double(grid_.rows) - 1);
      const double value = values_[std::size_t(r) * grid_.columns + std::size_t(c)];
      if (std::isnan(value)) continue;
      const double along = i == 1 ? column - left : 1 - (column - left);
      const double across = j == 1 ? row - bottom : 1 - (row - bottom);
      sum += along * across * value;
      weights += along * across;
    }
  }
  return weights > 0 ? sum / weights : values_[cellAt(x, y)];
}

void Plan::drawColours(Image& image, const Pixels& part) const {
  for (int y = std::max(part.top, 0); y < std::min(part.bottom, height_); ++y) {
    for (int x = std::max(part.left, 0); x < std::min(part.right, width_); ++x) {
      const double value = shownAt(x, y);
      if (std::isnan(value)) {
        if (isBody(x, y)) fillGrey(image, left_ + x, top_ + y, 1, 1, kBody);
        continue;
      }
      float* p = image.rgba.data() +
                 (std::size_t(top_ + y) * std::size_t(image.width) + std::size_t(left_ + x)) * 4;
      const Vec3 colour = map_.at(range_.position(value));
      for (int b = 0; b < 3; ++b) p[b] = float(srgbFromLinear(colour[b]));
      p[3] = 1;
    }
  }
}

/// Values in the middle of cells, all or each so many across and up, in black or white; lines pass
/// behind them.
void Plan::drawValues(Image& image) const {
  if (!(high_ >= low_)) return;
  int widest = std::max(textWidth(valueText(low_), 1), textWidth(valueText(high_), 1));
  if (low_ < 100 && high_ >= 10) widest = std::max(widest, textWidth("99.9", 1));
  const int scale = cell_u_ >= (widest + 3) * kTextScale ? kTextScale : 1;
  const std::size_t across = everyOf(cell_u_, (widest + 4) * scale);
  const std::size_t up = everyOf(cell_v_, (kGlyphHeight + 4) * scale);
  for (std::size_t row = (up - 1) / 2; row < grid_.rows; row += up) {
    for (std::size_t column = (across - 1) / 2; column < grid_.columns; column += across) {
      const double value = values_[row * grid_.columns + column];
      if (std::isnan(value)) continue;
      const std::string text = valueText(value);
      const int x = int(std::lround((double(column) + 0.5) * cell_u_)) - textWidth(text, scale) / 2;
      const int y =
          int(std::lround(height_ - (double(row) + 0.5) * cell_v_)) - kCapHeight * scale / 2;
      drawColours(image, {x - scale, y - scale, x + textWidth(text, scale) + scale,
                          y + (kCapHeight + 1) * scale});
      drawText(image, left_ + x, top_ + y, scale, text, inkOver(map_.at(range_.position(value))));
    }
  }
}

void Plan::draw(Image& image, int left, int top) {
  left_ = left;
  top_ = top;
  shown_.clear();
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) shown_.push_back(valueAt(x, y));
  }
  drawColours(image, {0, 0, width_, height_});
  drawIsolines(image, left, top, {width_, height_, shown_, {}}, range_, line_step_, map_,
               kTextScale, false);
  drawValues(image);
}

std::vector<std::string> headingOf(const MeasuringPoints& points, const MeasuringPoints::Grid& grid,
                                   const PointLightValues& light, std::size_t first) {
  const IlluminanceSummary s = summaryOf(points, light, first);
  std::vector<std::string> lines{points.name};
  if (s.points > 0) {
    lines.push_back(fmt::format("mean {} lx, from {} to {}: U0 {:.2f}, Ud {:.2f}",
                                valueText(s.mean), valueText(s.lowest), valueText(s.highest),
                                s.overMean(), s.overHighest()));
  }
  if (s.daylight_factor > 0) {
    lines.push_back(fmt::format("daylight factor: mean {} %, from {} to {} %; outside {} lx",
                                valueText(s.daylight_factor), valueText(s.lowest_daylight_factor),
                                valueText(100 * s.highest / light.open_lux),
                                valueText(light.open_lux)));
  }
  lines.push_back(fmt::format("{} points, {:.3g} x {:.3g} m apart; right is {}, up {}",
                              points.size(), grid.step_u, grid.step_v, wayText(grid.u),
                              wayText(grid.v)));
  if (s.inside > 0) lines.push_back(fmt::format("grey: {} points in bodies", s.inside));
  return lines;
}

Image paper(int width, int height) {
  Image image{width, height, {}};
  image.rgba.assign(std::size_t(width) * std::size_t(height) * 4, kPaper);
  return image;
}

}  // namespace

Image illuminancePlan(const MeasuringPoints& points, const PointLightValues& light,
                      std::size_t first, double low, double high) {
  if (!points.grid) {
    throw InputError(points.name + ": its points are no grid, of which a plan could be drawn");
  }
  Plan plan(points, *points.grid, light, first, low, high);
  const std::vector<std::string> heading = headingOf(points, *points.grid, light, first);
  int width = std::max(plan.width(), kNarrowestPlan);
  for (const std::string& line : heading) width = std::max(width, textWidth(line, kTextScale));
  width += 2 * kEdge;
  const int top = kEdge + int(heading.size()) * kLineHeight + kEdge / 2;
  const int above_legend = top + plan.height() + kEdge;
  const Legend legend({.title = "illuminance", .unit = "lx"}, width, 2 * above_legend,
                      plan.lineStep());
  Image image = paper(width, above_legend + legend.height());
  for (std::size_t k = 0; k < heading.size(); ++k) {
    drawText(image, kEdge, kEdge + int(k) * kLineHeight, kTextScale, heading[k], kBlack);
  }
  plan.draw(image, (width - plan.width()) / 2, top);
  legend.draw(image, ColourMap(), plan.range());
  return image;
}

Image stacked(std::span<const Image> pictures) {
  int width = 0;
  int height = 0;
  for (const Image& picture : pictures) {
    width = std::max(width, picture.width);
    height += picture.height;
  }
  Image all = paper(width, height);
  std::size_t row = 0;
  for (const Image& picture : pictures) {
    for (int y = 0; y < picture.height; ++y, ++row) {
      const auto from = picture.rgba.begin() + std::ptrdiff_t(y) * picture.width * 4;
      std::copy(from, from + std::ptrdiff_t(picture.width) * 4,
                all.rgba.begin() + std::ptrdiff_t(row) * width * 4);
    }
  }
  return all;
}

}  // namespace radiosity
