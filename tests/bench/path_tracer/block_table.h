// Means over square blocks of a picture, with their standard errors, as a table.
#pragma once

#include <string>
#include <vector>

#include "radiosity/render.h"

namespace radiosity::bench {

struct Block {
  int x = 0;  ///< in blocks, from the left
  int y = 0;  ///< from the top
  Vec3 radiance{0.0};
  Vec3 error{0.0};     ///< standard error
  bool plain = false;  ///< all of it shows something, nothing of it shines
};

/// CSV: x, y, plain, red, green, blue, red_error, green_error, blue_error. RunError where the file
/// cannot be written.
void writeBlocks(const std::string& path, const std::vector<Block>& blocks);

/// Blocks of a picture, in rows; those at its right and lower edge that are not whole are left out.
/// Plain where all pixels are hit; errors are 0.
std::vector<Block> blocksOf(const Image& image, int side);

}  // namespace radiosity::bench
