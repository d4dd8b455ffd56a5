// The rasteriser's kernels on every instruction set, against their definition, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "base/aligned_buffer.h"
#include "formfactor/hemicube/raster_kernels.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

template <class Check>
void forEveryRasterTarget(const Check& check) {
  test::onEveryTarget([] { return rasterKernels(true); }, check);
}

void expectSameBits(const float* a, const float* b, std::size_t count) {
  for (std::size_t x = 0; x < count; ++x) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a[x]), std::bit_cast<std::uint32_t>(b[x])) << x;
  }
}

constexpr int kWidth = 50;  // not a multiple of any vector
constexpr int kStride = 64;
constexpr int kRows = 20;
constexpr std::size_t kPixels = std::size_t(kStride) * kRows;

struct Picture {
  Picture() {
    depth.reserve(kPixels);
    items.reserve(kPixels + kRowAlignment);
  }
  FillTarget target() { return {depth.data(), items.data(), kStride, 0.5F - kWidth / 2.0F}; }
  AlignedBuffer<float> depth;
  AlignedBuffer<std::uint32_t> items;
};

/// Calls fill(spans, slope, item) for many polygons.
template <class Fill>
void drawRandomSpans(const Fill& fill) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<float> slope(-1, 1);
  for (std::uint32_t item = 0; item < 40; ++item) {
    std::vector<Span> spans;
    for (int y = 0; y < kRows; ++y) {
      int begin = int(random() % (kWidth + 1));
      int end = int(random() % (kWidth + 1));
      if (begin > end) std::swap(begin, end);
      if (begin < end) spans.push_back({y, begin, end, 3 * slope(random)});
    }
    fill(spans, slope(random), item);
  }
}

/// A span by the definition.
void fillPixels(const FillTarget& target, const Span& span, float slope, std::uint32_t item) {
  for (int x = span.begin; x < span.end; ++x) {
    const std::size_t pixel = std::size_t(span.y) * kStride + std::size_t(x);
    const float depth = slope * (float(x) + target.first_centre) + span.inverse_depth;
    if (depth > target.depth[pixel]) {
      target.depth[pixel] = depth;
      target.items[pixel] = item;
    }
  }
}

TEST(Kernels, FillAndClearAgreeToTheBit) {
  Picture expected;
  std::fill_n(expected.depth.data(), kPixels, -std::numeric_limits<float>::infinity());
  std::fill_n(expected.items.data(), kPixels, kSky);
  drawRandomSpans([&](const std::vector<Span>& spans, float slope, std::uint32_t item) {
    for (const Span& span : spans) fillPixels(expected.target(), span, slope, item);
  });
  forEveryRasterTarget([&](const RasterKernels& kernels) {
    Picture picture;
    kernels.clear(picture.depth.data(), picture.items.data(), kPixels);
    drawRandomSpans([&](const std::vector<Span>& spans, float slope, std::uint32_t item) {
      kernels.fill(picture.target(), spans.data(), spans.size(), slope, item);
    });
    expectSameBits(expected.depth.data(), picture.depth.data(), kPixels);
    for (std::size_t x = 0; x < kPixels; ++x) {
      ASSERT_EQ(expected.items.data()[x], picture.items.data()[x]);
    }
  });
}

TEST(Kernels, FillTouchesOnlyItsSpanAndKeepsTheFirstOfEquals) {
  forEveryRasterTarget([&](const RasterKernels& kernels) {
    Picture picture;
    kernels.clear(picture.depth.data(), picture.items.data(), kPixels);
    const Span span{3, 5, 37, 1.0F};
    kernels.fill(picture.target(), &span, 1, 0.0F, 1);
    kernels.fill(picture.target(), &span, 1, 0.0F, 2);  // as deep: stays hidden
    const Span nearer{3, 20, 21, 2.0F};
    kernels.fill(picture.target(), &nearer, 1, 0.0F, 3);
    const Span farther{3, 10, 15, 0.5F};
    kernels.fill(picture.target(), &farther, 1, 0.0F, 4);
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kStride; ++x) {
        std::uint32_t item = kSky;
        if (y == 3 && x >= 5 && x < 37) item = x == 20 ? 3 : 1;
        ASSERT_EQ(picture.items.data()[y * kStride + x], item) << x << " " << y;
      }
    }
  });
}

TEST(Kernels, FillTakesEveryDepthAboveMinusInfinity) {
  // Inverse depths may round to 0 or below near the horizon; such pixels are not sky.
  forEveryRasterTarget([&](const RasterKernels& kernels) {
    Picture picture;
    kernels.clear(picture.depth.data(), picture.items.data(), kPixels);
    const Span span{0, 0, kWidth, -1e30F};
    kernels.fill(picture.target(), &span, 1, 0.0F, 1);
    for (int x = 0; x < kWidth; ++x) ASSERT_EQ(picture.items.data()[x], 1u);
  });
}

TEST(Kernels, RunsAgreeWithTheDefinition) {
  std::mt19937_64 random(5);
  AlignedBuffer<std::uint32_t> values;
  values.reserve(kStride);
  std::int32_t starts[kStride + kRowAlignment];
  for (const int changes : {1, 2, 5, 50}) {
    for (int count = 1; count <= kWidth; ++count) {
      for (int x = 0; x < kStride; ++x) {
        values.data()[x] = std::uint32_t(random() % std::uint64_t(changes));
      }
      std::vector<std::int32_t> expected;
      for (int x = 0; x < count; ++x) {
        if (x == 0 || values.data()[x] != values.data()[x - 1]) expected.push_back(x);
      }
      expected.push_back(count);
      forEveryRasterTarget([&](const RasterKernels& kernels) {
        ASSERT_EQ(expected.size() - 1, kernels.findRuns(values.data(), count, starts));
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), starts));
      });
    }
  }
}

struct CellRuns {
  std::int32_t starts[kStride + kRowAlignment];
  std::int32_t cells[kStride + kRowAlignment];
};

/// The cell of a pixel by the definition, in the kernels' arithmetic.
std::int32_t cellAt(const RowMap& map, int x) {
  const float centre = float(x) + map.first_centre;
  const float scale = 1.0F / std::max(map.w_slope * centre + map.w, kLeastW);
  const auto whole = [&](float slope, float base, float last) {
    return std::nearbyint(std::clamp((slope * centre + base) * scale, 0.0F, last));
  };
  const float row = whole(map.v_slope, map.v, map.last_row);
  const float column = whole(map.u_slope, map.u, map.last_column);
  return map.first_cell + std::int32_t(row * map.columns + column);
}

TEST(Kernels, CellsAgreeAlsoOutsideTheGrid) {
  std::mt19937_64 random(9);
  std::normal_distribution<float> normal;
  for (int k = 0; k < 400; ++k) {
    RowMap map{normal(random),
               10 * normal(random),
               normal(random),
               10 * normal(random),
               k % 3 ? 0.0F : normal(random),
               5 * normal(random),
               0.5F - kWidth / 2.0F,
               2,
               1,
               3,
               7};
    if (k == 8) map.w_slope = map.w = 0;
    if (k == 9) map.last_column = map.last_row = 0;
    std::vector<std::int32_t> starts;
    std::vector<std::int32_t> cells;
    for (int x = 3; x < kWidth; ++x) {
      const std::int32_t cell = cellAt(map, x);
      ASSERT_GE(cell, 7);
      ASSERT_LE(cell, 12);
      if (!cells.empty() && cell == cells.back()) continue;
      starts.push_back(x);
      cells.push_back(cell);
    }
    CellRuns found;
    forEveryRasterTarget([&](const RasterKernels& kernels) {
      ASSERT_EQ(starts.size(), kernels.locate(map, 3, kWidth, found.starts, found.cells)) << k;
      ASSERT_TRUE(std::equal(starts.begin(), starts.end(), found.starts));
      ASSERT_TRUE(std::equal(cells.begin(), cells.end(), found.cells));
    });
  }
}

TEST(Kernels, EdgesCrossRowsByTheDefinition) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> unit(-10, 60);
  for (int k = 0; k < 300; ++k) {
    const int first = int(random() % 20);
    const EdgeRows edge{
        unit(random), unit(random), unit(random) / 20, first, first + int(random() % 20), kWidth};
    std::int32_t expected[20];
    rasterKernels(false).cross(edge, expected);
    for (int y = edge.first; y < edge.end; ++y) {
      // The definition: all centres left of the edge are left out, no other.
      const double x = edge.low_x + ((y + 0.5) - edge.low_y) * edge.slope;
      const int pixel = expected[y - first];
      ASSERT_TRUE(pixel == 0 || pixel - 0.5 < x);
      ASSERT_TRUE(pixel == kWidth || pixel + 0.5 >= x);
    }
    forEveryRasterTarget([&](const RasterKernels& kernels) {
      std::int32_t found[21];
      found[edge.end - first] = -7;
      kernels.cross(edge, found);
      EXPECT_EQ(found[edge.end - first], -7);  // nothing written past the last row
      for (int y = 0; y < edge.end - first; ++y) ASSERT_EQ(expected[y], found[y]);
    });
  }
}

TEST(Kernels, CellsAreTheOnesTheCoordinatesFallInto) {
  // u = x + 0.5 (pixel centres), v = 1.25: column x, row 1 of a grid of 50 x 2.
  RowMap map{1, kWidth / 2.0F - 0.5F, 0, 0.75F, 0, 1, 0.5F - kWidth / 2.0F, 49, 1, 50, 3};
  forEveryRasterTarget([&](const RasterKernels& kernels) {
    CellRuns runs;
    ASSERT_EQ(50u, kernels.locate(map, 0, kWidth, runs.starts, runs.cells));
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_EQ(runs.starts[x], x);
      EXPECT_EQ(runs.cells[x], 3 + 50 + x);
    }
  });
}

TEST(Kernels, WholeRowsAgreeOnEveryInstructionSet) {
  // Triangular patches: the trees of lines are used, too.
  test::MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 3, true);
  builder.polygon("plate", {{{0.2, 0.2, 0.5}, {0.8, 0.2, 0.5}, {0.8, 0.8, 0.5}, {0.2, 0.8, 0.5}}},
                  {{{0.2, 0.2, 0.5}, {0.8, 0.2, 0.5}, {0.5, 0.4, 0.5}},
                   {{0.8, 0.2, 0.5}, {0.8, 0.8, 0.5}, {0.5, 0.4, 0.5}},
                   {{0.8, 0.8, 0.5}, {0.2, 0.8, 0.5}, {0.5, 0.4, 0.5}},
                   {{0.2, 0.8, 0.5}, {0.2, 0.2, 0.5}, {0.5, 0.4, 0.5}}});
  const PatchMesh mesh = builder.build();
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = 50;
  options.precision = Precision::double_precision;
  options.simd = false;
  Progress silent;
  const FormFactors expected = computeFormFactors(mesh, options, silent);
  options.simd = true;
  forEveryRasterTarget([&](const RasterKernels& kernels) {
    const FormFactors f = computeFormFactors(mesh, options, silent);
    EXPECT_EQ(f.report.simd_target, kernels.target);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      for (std::size_t j = 0; j < mesh.size(); ++j) {
        ASSERT_EQ(expected.matrix->at(i, j), f.matrix->at(i, j));
      }
    }
  });
}

}  // namespace
}  // namespace radiosity
