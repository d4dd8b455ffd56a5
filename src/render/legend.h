// The strip under a false-colour picture that explains its colours.
#pragma once

#include <optional>

#include "radiosity/render.h"
#include "render/colour_map.h"

namespace radiosity {

/// The range of values that the colours of a picture stand for.
struct ColourRange {
  double low = 0;
  double high = 0;     ///< == low: one colour, the middle of the map
  bool below = false;  ///< values under `low` are in view and have its colour
  bool above = false;

  double position(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

/// Title (with the unit), colour bar and numbers, in a size that is legible in the picture.
class Legend {
 public:
  /// `line_step`: of the picture's isolines, which the bar shows, too; 0: it has none.
  Legend(const FalseColour& text, int width, int height, double line_step = 0);

  /// The rows of the strip at the bottom; 0 if the picture is too small for a legible one.
  int height() const { return height_; }
  int scale() const { return scale_; }
  /// Draws the strip into the bottom rows. No range: nothing is in view.
  void draw(Image& image, const ColourMap& map, const std::optional<ColourRange>& range) const;

 private:
  void drawBar(Image& image, int top, const ColourMap& map, const ColourRange& range) const;
  void drawTicks(Image& image, int top, const ColourRange& range) const;

  void drawBarLine(Image& image, int top, const ColourMap& map, const ColourRange& range,
                   double level) const;

  int width_;
  double line_step_;
  int scale_;  ///< picture pixels for each font pixel
  int margin_;
  std::vector<std::string> lines_;  ///< of the title
  int height_ = 0;
};

}  // namespace radiosity
