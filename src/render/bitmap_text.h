// Text in a picture, in a font of our own, since a bare machine has none.
#pragma once

#include <string>

#include "radiosity/render.h"

namespace radiosity {

inline constexpr int kGlyphWidth = 5;    ///< pixels, at scale 1
inline constexpr int kGlyphAdvance = 6;  ///< from one glyph to the next
inline constexpr int kCapHeight = 7;     ///< top of a capital to the base line
inline constexpr int kGlyphHeight = 8;   ///< with the descender

/// Fills [x, x + width) x [y, y + height), clipped to the picture, with an opaque grey.
void fillGrey(Image& image, int x, int y, int width, int height, float grey);

/// The width of `text` in pixels, without the gap after its last glyph. `text` is UTF-8.
int textWidth(const std::string& text, int scale);

/// Draws `text` with its top left at (x, y). The font has ASCII and the superscript two; other
/// characters are drawn as a box.
void drawText(Image& image, int x, int y, int scale, const std::string& text, float grey);

}  // namespace radiosity
