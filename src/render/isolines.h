// Lines at round numbers over false colours.
#pragma once

#include <functional>
#include <span>

#include "render/legend.h"

namespace radiosity {

/// The step of about ten lines over a range: 1, 2 or 5 x 10^n; 0 if the range is empty.
double isolineStep(const ColourRange& range);

/// The range with its ends moved outward to multiples of the step.
ColourRange roundedOut(const ColourRange& range, double step);

/// Values of pixels, the top row first; NaN: none.
struct PixelValues {
  int width = 0;
  int height = 0;
  std::span<const double> values;
  /// Whether lines may pass between two pixels side by side; none: everywhere.
  std::function<bool(std::size_t, std::size_t)> joined;

  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(width) + std::size_t(x);
  }
};

/// Draws lines where values, linear between the middles of pixels, are multiples of the step within
/// the range, with the top left pixel at (left, top) of the picture; black, or white over dark
/// colours. `scale`: of the text, in pixels of the picture for each of the font; lines are as wide.
/// `labels`: writes the numbers of lines where there is room.
void drawIsolines(Image& image, int left, int top, const PixelValues& pixels,
                  const ColourRange& range, double step, const ColourMap& map, int scale,
                  bool labels);

}  // namespace radiosity
