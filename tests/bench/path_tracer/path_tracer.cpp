// path_tracer trace SCENE | blocks PICTURE: what pictures are held against. See --help.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <optional>

#include "base/parallel.h"
#include "clocks.h"
#include "path_tracer/block_table.h"
#include "path_tracer/paths.h"
#include "path_tracer/traced_scene.h"
#include "radiosity/results.h"
#include "radiosity/scene.h"
#include "render/view.h"

namespace radiosity::bench {
namespace {

struct Arguments {
  std::string input;
  std::string blocks;               ///< CSV
  std::string picture;              ///< EXR; empty: none
  std::string camera;               ///< as parseCamera() reads it; empty: the scene's first
  std::vector<std::string> lights;  ///< more of them, as lightOf() reads them
  int size = 256;
  int block = 8;
  std::uint32_t paths = 64;
  int replicates = 1;
  int every = 1;
  double crease = 30;
  PathOptions options;
  int threads = 1;
};

/// Blocks spread over the picture: each row starts elsewhere.
bool isTaken(int x, int y, int every) { return (x + 3 * y) % every == 0; }

/// What all paths through one block brought.
class BlockSum {
 public:
  explicit BlockSum(int replicates) : replicates_(replicates), sums_(std::size_t(replicates)) {}

  void add(int replicate, const PathLight& light) {
    sums_[std::size_t(replicate)] += light.radiance;
    plain_ = plain_ && !light.emits && !light.misses;
  }
  Block block(int x, int y, double paths) const {
    Block out{x, y, {}, {}, plain_};
    const double each = paths / replicates_;
    for (const Vec3& sum : sums_) out.radiance += sum / paths;
    if (replicates_ < 2) return out;
    Vec3 squares(0.0);
    for (const Vec3& sum : sums_) {
      const Vec3 off = sum / each - out.radiance;
      squares += off * off;
    }
    const double count = replicates_ * (replicates_ - 1.0);
    out.error = {std::sqrt(squares.x / count), std::sqrt(squares.y / count),
                 std::sqrt(squares.z / count)};
    return out;
  }

 private:
  int replicates_;
  std::vector<Vec3> sums_;
  bool plain_ = true;
};

class Tracing {
 public:
  Tracing(const TracedScene& scene, const Camera& camera, const Arguments& arguments)
      : scene_(scene),
        view_(makeView(camera, arguments.size, arguments.size)),
        arguments_(arguments) {
    image_.width = image_.height = arguments.size;
    image_.rgba.assign(std::size_t(image_.width) * std::size_t(image_.height) * 4, 0.0F);
  }

  std::vector<Block> run() {
    std::vector<Block> blocks;
    const int across = arguments_.size / arguments_.block;
    for (int y = 0; y < across; ++y) {
      for (int x = 0; x < across; ++x) {
        if (isTaken(x, y, arguments_.every)) blocks.push_back({x, y, {}, {}, false});
      }
    }
    parallelFor(blocks.size(), 1,
                [&](std::size_t k) { blocks[k] = trace(blocks[k].x, blocks[k].y); });
    return blocks;
  }
  const Image& image() const { return image_; }

 private:
  Block trace(int x, int y) {
    const int side = arguments_.block;
    BlockSum sum(arguments_.replicates);
    std::vector<Vec3> pixels(std::size_t(side) * std::size_t(side), Vec3(0.0));
    std::vector<double> counts(pixels.size(), 0.0);
    const std::uint32_t each = arguments_.paths / std::uint32_t(arguments_.replicates);
    for (int r = 0; r < arguments_.replicates; ++r) {
      const std::uint64_t seed = (std::uint64_t(y) << 40) + (std::uint64_t(x) << 20) + unsigned(r);
      for (std::uint32_t k = 0; k < each; ++k) {
        ScrambledPoints points(k, seed * 0x2545f4914f6cdd1dull);
        const Vec2 at = double(side) * points.next();
        const Vec3 ray = glm::normalize(view_.rayThrough(x * side + at.x, y * side + at.y));
        const PathLight light = tracePath(scene_, view_.eye, ray, arguments_.options, points);
        sum.add(r, light);
        if (light.misses && !scene_.hasSky()) continue;
        const std::size_t pixel = std::size_t(at.y) * std::size_t(side) + std::size_t(at.x);
        pixels[pixel] += light.radiance;
        counts[pixel] += 1;
      }
    }
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      if (counts[p] > 0) setPixel(x, y, int(p), pixels[p] / counts[p]);
    }
    return sum.block(x, y, double(each) * arguments_.replicates);
  }

  void setPixel(int x, int y, int in_block, const Vec3& radiance) {
    const int side = arguments_.block;
    const int row = y * side + in_block / side;
    const int column = x * side + in_block % side;
    float* out = image_.rgba.data() +
                 4 * (std::size_t(row) * std::size_t(image_.width) + std::size_t(column));
    for (int b = 0; b < 3; ++b) out[b] = float(radiance[b]);
    out[3] = 1;
  }

  const TracedScene& scene_;
  View view_;
  const Arguments& arguments_;
  Image image_;
};

void trace(const Arguments& arguments) {
  const std::uint32_t replicates = std::uint32_t(arguments.replicates);
  if (!std::has_single_bit(arguments.paths) || !std::has_single_bit(replicates) ||
      replicates > arguments.paths) {
    throw InputError("--paths and --replicates must be powers of two, and paths at least as many");
  }
  setThreads(arguments.threads);
  Progress quiet;
  Scene scene = loadScene(arguments.input);
  SceneOverrides given;
  for (const std::string& light : arguments.lights) addLight(given.lights, lightOf(light));
  applyOverrides(scene, given);
  if (scene.cameras.empty() && arguments.camera.empty()) {
    throw InputError(arguments.input + ": the scene has no camera; give one with --camera");
  }
  if (!scene.textures.empty()) throw InputError(arguments.input + ": textures are not traced");
  const PatchMesh mesh = meshScene(scene, {.patches = 1}, quiet).mesh;
  const Stopwatch watch;
  const TracedScene traced(mesh, patchMaterials(scene, mesh), arguments.crease);
  Tracing tracing(traced,
                  arguments.camera.empty() ? scene.cameras.front() : parseCamera(arguments.camera),
                  arguments);
  const std::vector<Block> blocks = tracing.run();
  if (!arguments.picture.empty()) writeImage(arguments.picture, tracing.image(), false);
  fmt::print("{{\"processor_s\": {}}}\n", watch.elapsed().processor());
  if (!arguments.blocks.empty()) writeBlocks(arguments.blocks, blocks);
}

void addTrace(CLI::App& app, Arguments& a) {
  CLI::App* sub = app.add_subcommand("trace", "Traces blocks of the picture by the scene's camera");
  sub->add_option("SCENE", a.input)->required();
  sub->add_option("--blocks", a.blocks, "CSV of the blocks");
  sub->add_option("--picture", a.picture, "The picture, .exr");
  sub->add_option("--camera", a.camera, "eye=X,Y,Z;target=X,Y,Z; default: the scene's first");
  sub->add_option("--light", a.lights, "As the program takes it, e.g. cie-sky,10000lx")
      ->allow_extra_args(false);
  sub->add_option("--size", a.size, "Pixels a side")->check(CLI::Range(8, 4096));
  sub->add_option("--block", a.block, "Pixels a side of a block")->check(CLI::Range(1, 64));
  sub->add_option("--paths", a.paths, "Of a block; a power of two");
  sub->add_option("--replicates", a.replicates,
                  "Independent sets that these are, for the standard error; a power of two");
  sub->add_option("--every", a.every, "Of so many blocks one is traced")->check(CLI::Range(1, 64));
  sub->add_option("--bounces", a.options.most_bounces, "1: direct light alone; 0: no end");
  sub->add_option("--smooth", a.options.smooth,
                  "The first surface has the normals between its corners' (1) or its facets' (0)");
  sub->add_option("--threads", a.threads, "0: all cores");
  sub->callback([&a] { trace(a); });
}

void addBlocks(CLI::App& app, Arguments& a) {
  CLI::App* sub = app.add_subcommand("blocks", "Means over the blocks of a picture");
  sub->add_option("PICTURE", a.input)->required();
  sub->add_option("--blocks", a.blocks, "CSV of the blocks")->required();
  sub->add_option("--block", a.block, "Pixels a side of a block")->check(CLI::Range(1, 64));
  sub->callback([&a] { writeBlocks(a.blocks, blocksOf(readImage(a.input), a.block)); });
}

}  // namespace
}  // namespace radiosity::bench

int main(int count, char** values) try {
  using namespace radiosity::bench;
  Arguments arguments;
  CLI::App app("Traces diffuse light along random paths, by Embree");
  addTrace(app, arguments);
  addBlocks(app, arguments);
  app.require_subcommand(1);
  CLI11_PARSE(app, count, values);
  return EXIT_SUCCESS;
} catch (const radiosity::InputError& error) {
  fmt::print(stderr, "path_tracer: {}\n", error.what());
  return 2;
} catch (const std::exception& error) {
  fmt::print(stderr, "path_tracer: {}\n", error.what());
  return EXIT_FAILURE;
}
