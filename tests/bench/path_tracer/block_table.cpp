#include "path_tracer/block_table.h"

#include <fmt/format.h>

#include <fstream>

namespace radiosity::bench {

void writeBlocks(const std::string& path, const std::vector<Block>& blocks) {
  std::ofstream out(path);
  out << "x,y,plain,red,green,blue,red_error,green_error,blue_error\n";
  for (const Block& b : blocks) {
    out << fmt::format("{},{},{},{},{},{},{},{},{}\n", b.x, b.y, b.plain ? 1 : 0, b.radiance.x,
                       b.radiance.y, b.radiance.z, b.error.x, b.error.y, b.error.z);
  }
  out.flush();
  if (!out) throw RunError(path + ": cannot be written");
}

std::vector<Block> blocksOf(const Image& image, int side) {
  std::vector<Block> blocks;
  for (int y = 0; y < image.height / side; ++y) {
    for (int x = 0; x < image.width / side; ++x) {
      Block block{x, y, {}, {}, true};
      double hit = 0;
      for (int k = 0; k < side * side; ++k) {
        const int row = y * side + k / side;
        const int column = x * side + k % side;
        const float* pixel =
            image.rgba.data() + 4 * (std::size_t(row) * std::size_t(image.width) + column);
        const double share = double(pixel[3]);
        hit += share;
        block.radiance += share * Vec3(pixel[0], pixel[1], pixel[2]);
        block.plain = block.plain && share == 1;
      }
      if (hit > 0) block.radiance /= hit;
      blocks.push_back(block);
    }
  }
  return blocks;
}

}  // namespace radiosity::bench
